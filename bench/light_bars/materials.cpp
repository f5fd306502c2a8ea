// B18: albedo of rough mirrors. B19: reciprocity and energy conservation.
#include <cmath>

#include "bench/light_bars/light_bars.h"
#include "runtime/material/directional_albedo.h"
#include "tests/support/chi_square.h"
#include "tests/support/materials.h"

namespace fathom::bench {
namespace {

using test::MaterialCase;

// Albedo of GGX with height-correlated masking and fully reflecting facets: two quadratures agree to 2e-5.
struct GgxRow {
  float alpha;
  double albedo[4];
};
constexpr float kGgxCosines[] = {1, 0.8f, 0.5f, 0.2f};
constexpr GgxRow kGgx[] = {{0.1f, {0.98830, 0.98456, 0.96921, 0.9046}},
                           {0.25f, {0.91581, 0.89727, 0.85726, 0.84816}},
                           {0.5f, {0.68785, 0.68205, 0.69825, 0.78993}},
                           {0.75f, {0.46392, 0.49232, 0.56462, 0.71553}},
                           {1, {0.30685, 0.35126, 0.45069, 0.64165}}};

// Returns an upper bound of the light that the material reflects and transmits under uniform illumination: the
// integral over directions of the largest channel of f, plus the largest channels of specular reflection and
// transmission.
double albedo(const MaterialCase& c, float cos, int rows) {
  const runtime::Bsdf bsdf = c.bsdf(test::towards(cos, 0.2f));
  const double index = static_cast<double>(c.bending());
  const auto greatest = [](glm::vec3 v) { return static_cast<double>(std::max({v.x, v.y, v.z})); };
  constexpr int kLobes = 1 << 13, kLobesPerGuide = 8;
  double sum = 0;
  std::vector<glm::vec3> guides;
  for (int i = 0; i < kLobes; ++i) {
    runtime::Sampler sampler(13, static_cast<std::uint32_t>(i), 0, 0);
    const float lobe = (static_cast<float>(i) + 0.5f) / kLobes;
    const runtime::BsdfSample s = bsdf.sample(lobe, sampler.next2());
    if (s.pdf == 0) sum += greatest(s.weight) * static_cast<double>(s.eta_scale) / kLobes;
    if (s.pdf > 0 && i % kLobesPerGuide == 0) guides.push_back(s.wi);
  }
  const auto f = [&](glm::vec3 wi) {
    return greatest(bsdf.evaluate(wi).f) * (glm::dot(wi, test::kNormal) < 0 ? index * index : 1);
  };
  // f has a step where the normal of refracting facets, wo + eta wi, crosses the horizon: GGX has facets at the
  // horizon.
  const double step = std::acos(-std::min(static_cast<double>(cos) / index, 1.0));
  return sum + test::sphere_integral(f, {test::kNormal, rows, 1e-6, step, guides});
}

void ggx_table(BarTable& table) {
  double worst = 0, compensated = 0;
  for (const GgxRow& row : kGgx) {
    const runtime::DirectionalAlbedo lost = runtime::conductor_loss(row.alpha);
    for (std::size_t i = 0; i < 4; ++i) {
      const double found = 1 - static_cast<double>(lost.at(kGgxCosines[i]));
      worst = std::max(worst, std::abs(found - row.albedo[i]));
      compensated =
          std::max(compensated, std::abs(albedo({"metal", test::metal(row.alpha)}, kGgxCosines[i], 20) - 1));
    }
  }
  table.at_most("B18", "P9: the table of a GGX mirror's albedo against two other quadratures, largest error", 2e-3,
                worst);
  const double at_one = static_cast<double>(runtime::conductor_loss(1).at(1));
  table.at_most("B18", "P9: single scattering, E(1, 1) against 1 - ln 2", 1e-3, std::abs(at_one - std::log(2.0)));
  table.at_most("B18", "P9: with what is lost given back, |E - 1| of the 20 places of the table", 2e-3, compensated);
}

// A layered material whose parameters are all random.
MaterialCase random_material(std::uint64_t number) {
  runtime::Sampler s(17, static_cast<std::uint32_t>(number), 0, 0);
  const auto color = [&] {
    const glm::vec2 rg = s.next2();
    return glm::vec3(rg, s.next());
  };
  // Returns 0 or 1 in a quarter of the cases each, otherwise a number in between.
  const auto part = [&] { return std::clamp(2 * s.next() - 0.5f, 0.0f, 1.0f); };
  runtime::MaterialPoint m = test::principled(s.next());
  m.base_color = color();
  m.diffuse_roughness = part();
  m.metalness = part();
  m.specular_weight = part();
  m.specular_color = color();
  m.ior = 1 + 1.5f * s.next();
  m.transmission = part();
  m.transmission_color = color();
  m.coat_weight = part();
  m.coat_roughness = part();
  m.coat_color = color();
  m.coat_ior = 1 + s.next();
  m.thin_walled = s.next() < 0.25f;
  m.opacity = part();
  m.coat_darkening = part();
  return {fmt::format("random {}", number), m, s.next() < 0.3f && !m.thin_walled};
}

void reciprocity(BarTable& table, const LightCounts& counts) {
  std::vector<MaterialCase> cases = test::materials();
  for (const MaterialCase& c : test::layered_materials()) cases.push_back(c);
  const std::size_t named = cases.size();
  for (int i = 0; i < counts.random_materials; ++i) cases.push_back(random_material(static_cast<std::uint64_t>(i)));
  std::vector<double> worst(cases.size());
  for_each_index(cases.size(), [&](std::size_t i) {
    worst[i] = test::worst_asymmetry(cases[i], i < named ? counts.reciprocal_pairs : counts.reciprocal_pairs / 10, 7);
  });
  const auto at = static_cast<std::size_t>(std::max_element(worst.begin(), worst.end()) - worst.begin());
  table.at_most("B19",
                fmt::format("reciprocity: {} materials of the tests and {} at random, {} pairs each, the worst ({})",
                            named, counts.random_materials, counts.reciprocal_pairs, cases[at].name),
                1e-5, worst[at]);
}

void energy(BarTable& table, const LightCounts& counts) {
  std::vector<MaterialCase> cases = test::layered_materials();
  for (const MaterialCase& c : test::white_materials()) cases.push_back(c);
  for (int i = 0; i < counts.random_materials / 10; ++i) {
    MaterialCase c = random_material(static_cast<std::uint64_t>(i));
    // White: the most light that the material can return.
    c.material.base_color = c.material.specular_color = c.material.transmission_color = c.material.coat_color =
        glm::vec3(1);
    cases.push_back(c);
  }
  const std::size_t cosines = std::size(test::kCosines);
  std::vector<double> found(cases.size() * cosines), apart(found.size());
  for_each_index(found.size(), [&](std::size_t i) {
    const double coarse = albedo(cases[i / cosines], test::kCosines[i % cosines], 20);
    found[i] = albedo(cases[i / cosines], test::kCosines[i % cosines], 30);
    apart[i] = std::abs(found[i] - coarse);
  });
  const auto at = static_cast<std::size_t>(std::max_element(found.begin(), found.end()) - found.begin());
  const double unsure = *std::max_element(apart.begin(), apart.end());
  table.row("B19",
            fmt::format("energy: {} materials from {} directions, the most that is given back of 1 ({}, cos {})",
                        cases.size(), cosines, cases[at / cosines].name, test::kCosines[at % cosines]),
            "<= 1.001", fmt::format("{:.5f}", found[at]), found[at] <= 1 + 1e-3);
  table.at_most("B19", "energy: two grids of the quadrature differ by at most", 1e-4, unsure);
}

}  // namespace

void material_bars(BarTable& table, const LightCounts& counts) {
  ggx_table(table);
  reciprocity(table, counts);
  energy(table, counts);
}

}  // namespace fathom::bench
