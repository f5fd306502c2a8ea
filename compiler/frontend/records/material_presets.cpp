#include "compiler/frontend/records/material_presets.h"

#include <algorithm>
#include <cmath>

namespace fathom::compiler {
namespace {

// n and k for red, green and blue, at 650, 550 and 450 nm. Sources: measurements collected by Polyanskiy,
// "Refractiveindex.info database of optical constants", Scientific Data 11, 2024 (CC0), selected for three colours by
// Palmqvist, "Physically Based", physicallybased.info (CC0).
struct Metal {
  std::string_view name, other_name;
  glm::dvec3 n, k;
};
constexpr Metal kMetals[] = {
    {"aluminium", "aluminum", {1.3456, 0.96521, 0.61722}, {7.4746, 6.3995, 5.3031}},
    {"brass", "", {0.444, 0.527, 1.094}, {3.695, 2.765, 1.829}},
    {"chromium", "chrome", {3.4256, 2.7891, 2.0246}, {4.273, 4.1976, 3.8586}},
    {"cobalt", "", {3.5681, 2.7408, 2.0192}, {5.0469, 4.7897, 3.9523}},
    {"copper", "", {0.27105, 0.67693, 1.3164}, {3.6092, 2.6248, 2.2921}},
    {"gold", "", {0.18299, 0.42108, 1.3734}, {3.4242, 2.3459, 1.7704}},
    {"iron", "", {2.9114, 2.9497, 2.5845}, {3.0893, 2.9318, 2.767}},
    {"lead", "", {1.91, 1.83, 1.44}, {3.51, 3.4, 3.18}},
    {"mercury", "", {2.0733, 1.5523, 1.0606}, {5.3383, 4.651, 3.8628}},
    {"nickel", "", {2.0592, 1.8179, 1.621}, {3.7574, 3.2741, 2.6933}},
    {"platinum", "", {2.3757, 2.0847, 1.8453}, {4.2655, 3.7153, 3.1365}},
    {"silver", "", {0.15943, 0.14512, 0.13547}, {3.9291, 3.19, 2.3808}},
    {"titanium", "", {2.7407, 2.5418, 2.267}, {3.8143, 3.4345, 3.0385}},
    {"tungsten", "", {3.6518, 3.5064, 3.313}, {2.7955, 2.7585, 2.6051}},
    {"zinc", "", {3.4161, 1.9286, 1.0424}, {7.0325, 6.3963, 5.125}},
};

// Refractive indices at 589 nm, from the same collections.
struct Dielectric {
  std::string_view name;
  double ior;
  double transmission, roughness;
};
constexpr Dielectric kDielectrics[] = {
    {"acrylic", 1.49, 1, 0},   {"diamond", 2.417, 1, 0},  {"glass", 1.52, 1, 0},  {"ice", 1.31, 1, 0},
    {"plastic", 1.46, 0, 0.3}, {"sapphire", 1.768, 1, 0}, {"water", 1.333, 1, 0},
};

// OpenPBR's F82-tint: reflectance at normal incidence, and the ratio to Schlick's approximation at the angle with
// cosine 1/7.
// Source: Kutz, Hasan, Edmondson, "Novel aspects of the Adobe Standard Material", 2021.
MaterialPreset metal_preset(const Metal& metal, std::string_view name) {
  constexpr double kEdge = 1.0 / 7, kGrazing = (6 * 6 * 6 * 6 * 6) / (7.0 * 7 * 7 * 7 * 7);  // (1 - kEdge)^5
  glm::dvec3 head_on, tint;
  for (int i = 0; i < 3; ++i) {
    head_on[i] = conductor_reflectance(1, metal.n[i], metal.k[i]);
    const double schlick = head_on[i] + (1 - head_on[i]) * kGrazing;
    tint[i] = std::min(conductor_reflectance(kEdge, metal.n[i], metal.k[i]) / schlick, 1.0);
  }
  return {name, {{"base_metalness", glm::dvec3(1)}, {"base_color", head_on}, {"specular_color", tint}}};
}

MaterialPreset dielectric_preset(const Dielectric& row) {
  return {row.name,
          {{"specular_ior", glm::dvec3(row.ior)},
           {"transmission_weight", glm::dvec3(row.transmission)},
           {"specular_roughness", glm::dvec3(row.roughness)}}};
}

}  // namespace

double conductor_reflectance(double cosine, double n, double k) {
  const double cos2 = cosine * cosine, sin2 = 1 - cos2;
  const double real = n * n - k * k - sin2;
  const double a2_plus_b2 = std::sqrt(real * real + 4 * n * n * k * k);
  const double a = std::sqrt(std::max(0.0, (a2_plus_b2 + real) / 2));
  const double sum = a2_plus_b2 + cos2, twice = 2 * a * cosine;
  const double perpendicular = (sum - twice) / (sum + twice);
  const double sum_p = cos2 * a2_plus_b2 + sin2 * sin2, twice_p = twice * sin2;
  const double parallel = perpendicular * (sum_p - twice_p) / (sum_p + twice_p);
  return (perpendicular + parallel) / 2;
}

std::span<const MaterialPreset> material_presets() {
  static const std::vector<MaterialPreset> presets = [] {
    std::vector<MaterialPreset> made;
    for (const Metal& metal : kMetals) {
      made.push_back(metal_preset(metal, metal.name));
      if (!metal.other_name.empty()) made.push_back(metal_preset(metal, metal.other_name));
    }
    for (const Dielectric& row : kDielectrics) made.push_back(dielectric_preset(row));
    return made;
  }();
  return presets;
}

}  // namespace fathom::compiler
