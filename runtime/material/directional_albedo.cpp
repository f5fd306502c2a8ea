#include "runtime/material/directional_albedo.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <mutex>

#include "runtime/material/fresnel.h"
#include "runtime/material/microfacet.h"

namespace fathom::runtime {
namespace {

constexpr int kNodes = DirectionalAlbedo::kNodes;
// Lattices for the tables, whose integrals err by less than 1e-3. From the denser side total reflection breaks the
// integrand, and more points are needed.
constexpr Lattice kFromOutside{377, 233}, kFromInside{2584, 1597};
constexpr float kTableLeastAlpha = 1e-4f;

// Four neighbouring nodes of a position among the nodes 0, 1 ..., and their weights: Lagrange's cubic.
struct Stencil {
  int first;
  std::array<float, 4> weight;
};

Stencil stencil_at(float place) {
  const int first = std::clamp(static_cast<int>(place) - 1, 0, kNodes - 4);
  const float t = place - static_cast<float>(first);
  const float a = t, b = t - 1, c = t - 2, d = t - 3;
  return {first, {b * c * d / -6, a * c * d / 2, a * b * d / -2, a * b * c / 6}};
}

float node_place(float cos) { return (std::sqrt(std::sqrt(cos)) + cos) * (0.5f * (kNodes - 1)); }

// Returns the cosines at the nodes: the fourth powers of the roots of x + x^4 = 2 i / (kNodes - 1), by bisection.
std::array<float, kNodes> node_cosines() {
  std::array<float, kNodes> cosines;
  for (int i = 0; i < kNodes; ++i) {
    double low = 0, high = 1;
    for (int step = 0; step < 60; ++step) {
      const double x = (low + high) / 2;
      (x + x * x * (x * x) < 2.0 * i / (kNodes - 1) ? low : high) = x;
    }
    cosines[static_cast<std::size_t>(i)] = static_cast<float>(i == 0 ? 0 : high * high * (high * high));
  }
  return cosines;
}

// Returns the weight of each node in the average: int w(x) 8 x^7 dx, x = cos^(1/4).
std::array<float, kNodes> average_weights() {
  constexpr int kParts = 8192;
  std::array<double, kNodes> sums{};
  for (int i = 0; i < kParts; ++i) {
    const double x = (i + 0.5) / kParts, x2 = x * x;
    const Stencil s = stencil_at(node_place(static_cast<float>(x2 * x2)));
    for (std::size_t k = 0; k < 4; ++k) {
      sums[static_cast<std::size_t>(s.first) + k] += 8 * x2 * x2 * x2 * x / kParts * static_cast<double>(s.weight[k]);
    }
  }
  std::array<float, kNodes> weights;
  for (std::size_t k = 0; k < kNodes; ++k) weights[k] = static_cast<float>(sums[k]);
  return weights;
}

// Roughnesses have the same nodes as cosines.
float node_alpha(int i) { return std::max(DirectionalAlbedo::node_cos(i), kTableLeastAlpha); }

// A table with a row per roughness, made when the row is first asked for.
template <typename Row>
class AlbedoTable {
 public:
  template <typename Make>
  const Row& row(int i, Make&& make) {
    Entry& entry = entries_[static_cast<std::size_t>(i)];
    std::call_once(entry.made, [&] {
      for (int k = 0; k < kNodes; ++k) make(DirectionalAlbedo::node_cos(k), static_cast<std::size_t>(k), entry.row);
    });
    return entry.row;
  }

 private:
  struct Entry {
    std::once_flag made;
    Row row;
  };
  std::array<Entry, kNodes> entries_;
};

// Adds `share` times the row at alpha, interpolated between the rows that `row_at(node)` gives.
template <typename RowAt>
void add_rows(float alpha, float share, DirectionalAlbedo& sum, RowAt&& row_at) {
  const Stencil s = stencil_at(node_place(alpha));
  for (int k = 0; k < 4; ++k) {
    const DirectionalAlbedo& row = row_at(s.first + k);
    const float weight = share * s.weight[static_cast<std::size_t>(k)];
    for (std::size_t i = 0; i < kNodes; ++i) sum.node[i] += weight * row.node[i];
  }
}

// Rows of dielectrics seen from their thinner side.
struct OutsideAlbedo {
  DirectionalAlbedo reflected, lost;
};

// Slices are spaced by s = (eta - 1) / (eta + 1), the root of the reflectance at normal incidence. Slices lie close
// near s = 0, where the reflectance at the horizon goes from 0 to 1.
constexpr int kSlices = 48;
constexpr float kMaxS = (kMaxEta - 1) / (kMaxEta + 1);
constexpr float slice_s(int slice) {
  return kMaxS * static_cast<float>(slice * slice) / ((kSlices - 1) * (kSlices - 1));
}
float slice_eta(int slice) { return (1 + slice_s(slice)) / (1 - slice_s(slice)); }

const OutsideAlbedo& outside_albedo(int slice, int roughness) {
  static std::array<AlbedoTable<OutsideAlbedo>, kSlices> tables;
  const auto make = [&](float cos, std::size_t k, OutsideAlbedo& row) {
    const InterfaceAlbedo albedo = integrate_dielectric(cos, node_alpha(roughness), slice_eta(slice), kFromOutside);
    row.reflected.node[k] = albedo.reflected;
    row.lost.node[k] = albedo.lost;
  };
  return tables[static_cast<std::size_t>(slice)].row(roughness, make);
}

const DirectionalAlbedo& inside_loss(int slice, int roughness) {
  static std::array<AlbedoTable<DirectionalAlbedo>, kSlices> tables;
  const auto make = [&](float cos, std::size_t k, DirectionalAlbedo& row) {
    row.node[k] = integrate_dielectric(cos, node_alpha(roughness), 1 / slice_eta(slice), kFromInside).lost;
  };
  return tables[static_cast<std::size_t>(slice)].row(roughness, make);
}

// The variable in which rows are interpolated linearly between two slices: s, or the reflectance s^2, in which
// Fresnel's reflectance is nearly linear (Schlick, "An Inexpensive BRDF Model for Physically-Based Rendering", 1994).
enum class Between { Indices, Reflectances };

// Interpolates the rows `row_at(slice, node)`. Requires eta >= 1.
template <typename RowAt>
DirectionalAlbedo interpolate(float alpha, float eta, Between between, RowAt&& row_at) {
  const float s = std::min((eta - 1) / (eta + 1), kMaxS);
  const int slice = std::clamp(static_cast<int>(std::sqrt(s / kMaxS) * (kSlices - 1)), 0, kSlices - 2);
  const float low = slice_s(slice), high = slice_s(slice + 1);
  const float way = (s - low) / (high - low) * (between == Between::Indices ? 1 : (s + low) / (high + low));
  const float share = std::clamp(way, 0.0f, 1.0f);
  DirectionalAlbedo row = DirectionalAlbedo::constant(0);
  const auto add = [&](int at, float part) {
    if (part > 0) add_rows(alpha, part, row, [&](int node) -> decltype(auto) { return row_at(at, node); });
  };
  add(slice, 1 - share);
  add(slice + 1, share);
  return row;
}

// Visits the points of a Fibonacci lattice as visible normals for `cos`, with their weights. The points lie denser
// where few normals are, u = 1 - v^2, because most light is lost there. (Sloan and Joe, "Lattice Methods for Multiple
// Integration", 1994, section 4.)
template <typename Visit>
void for_visible_normals(float cos, const Ggx& ggx, Lattice lattice, Visit&& visit) {
  const glm::vec3 wo(std::sqrt(std::max(1 - cos * cos, 0.0f)), 0, cos);
  const float n = static_cast<float>(lattice.points);
  int turn = 0;
  for (int i = 0; i < lattice.points; ++i) {
    const float v = (static_cast<float>(i) + 0.5f) / n;
    visit(wo, ggx.sample_visible_normal(wo, {1 - v * v, static_cast<float>(turn) / n}), 2 * v / n);
    turn = (turn + lattice.step) % lattice.points;
  }
}

// A linear map from functions of the cosine to functions of the cosine, by values at the nodes.
struct AlbedoMatrix {
  std::array<DirectionalAlbedo, kNodes> row{};

  DirectionalAlbedo operator*(const DirectionalAlbedo& function) const {
    DirectionalAlbedo product;
    for (std::size_t i = 0; i < kNodes; ++i) {
      float sum = 0;
      for (std::size_t k = 0; k < kNodes; ++k) sum += row[i].node[k] * function.node[k];
      product.node[i] = sum;
    }
    return product;
  }
};

// Adds node `o` of the matrix that maps a function g to the mean of g(cos_i) - g(cos_o) over the light of wo that
// leaves lower than wo. The facets reflect share(cos_m) of that light.
template <typename Share>
void add_lowered(std::size_t o, float alpha, DirectionalAlbedo& row, Share&& share) {
  const Ggx ggx(alpha);
  const float cos = DirectionalAlbedo::node_cos(static_cast<int>(o));
  for_visible_normals(cos, ggx, kFromOutside, [&](glm::vec3 wo, glm::vec3 m, float weight) {
    const float cos_m = std::min(glm::dot(wo, m), 1.0f), cos_i = 2 * cos_m * m.z - wo.z;
    if (!(cos_i > 0 && cos_i < cos)) return;
    const float part = weight * share(cos_m) * ggx.g2_over_g1(cos, cos_i);
    const Stencil s = stencil_at(node_place(cos_i));
    for (std::size_t k = 0; k < 4; ++k) row.node[static_cast<std::size_t>(s.first) + k] += part * s.weight[k];
    row.node[o] -= part;
  });
}

const AlbedoMatrix& lowered_by_conductor(int roughness) {
  static AlbedoTable<AlbedoMatrix> table;
  return table.row(roughness, [&](float, std::size_t k, AlbedoMatrix& matrix) {
    add_lowered(k, node_alpha(roughness), matrix.row[k], [](float) { return 1.0f; });
  });
}

const AlbedoMatrix& lowered_by_reflection(int slice, int roughness) {
  static std::array<AlbedoTable<AlbedoMatrix>, kSlices> tables;
  return tables[static_cast<std::size_t>(slice)].row(roughness, [&](float, std::size_t k, AlbedoMatrix& matrix) {
    const float eta = slice_eta(slice);
    add_lowered(k, node_alpha(roughness), matrix.row[k], [&](float cos_m) { return fresnel(cos_m, eta); });
  });
}

// A cache of a thread's last results, because a material asks for the same row at every hit. The product of matrices
// takes longer than everything else for a coat.
class CoatLosses {
 public:
  template <typename Make>
  const DirectionalAlbedo& get(float alpha, float eta, const DirectionalAlbedo& coat, Make&& make) {
    Entry& entry = entries_[place(alpha, eta, coat)];
    if (entry.alpha != alpha || entry.eta != eta || entry.coat.node != coat.node) {
      entry = {alpha, eta, coat, make()};
      for (float& value : entry.loss.node) value = std::max(value, 0.0f);
    }
    return entry.loss;
  }

 private:
  struct Entry {
    float alpha = -1, eta = 0;
    DirectionalAlbedo coat = {}, loss = {};
  };
  static constexpr std::size_t kEntries = 32;
  static std::size_t place(float alpha, float eta, const DirectionalAlbedo& coat) {
    std::uint32_t hash = 0;
    for (const float value : {alpha, eta, coat.node[kNodes / 2], coat.node[kNodes - 1]}) {
      hash = (hash ^ std::bit_cast<std::uint32_t>(value)) * 0x9e3779b1u;
      hash ^= hash >> 15;
    }
    return hash % kEntries;
  }
  std::array<Entry, kEntries> entries_;
};
thread_local CoatLosses coat_losses;

}  // namespace

float DirectionalAlbedo::node_cos(int i) {
  static const std::array<float, kNodes> cosines = node_cosines();
  return cosines[static_cast<std::size_t>(i)];
}

float DirectionalAlbedo::at(float cos) const {
  const Stencil s = stencil_at(node_place(cos));
  float sum = 0;
  for (std::size_t k = 0; k < 4; ++k) sum += s.weight[k] * node[static_cast<std::size_t>(s.first) + k];
  return std::clamp(sum, 0.0f, 1.0f);
}

DirectionalAlbedo DirectionalAlbedo::constant(float value) {
  DirectionalAlbedo row;
  row.node.fill(value);
  return row;
}

float DirectionalAlbedo::average() const {
  static const std::array<float, kNodes> weights = average_weights();
  float sum = 0;
  for (std::size_t i = 0; i < kNodes; ++i) sum += weights[i] * node[i];
  return std::clamp(sum, 0.0f, 1.0f);
}

float DirectionalAlbedo::max_value() const { return *std::max_element(node.begin(), node.end()); }

DirectionalAlbedo conductor_loss(float alpha) {
  static AlbedoTable<DirectionalAlbedo> table;
  DirectionalAlbedo row = DirectionalAlbedo::constant(0);
  add_rows(alpha, 1, row, [](int node) -> const DirectionalAlbedo& {
    return table.row(node, [&](float cos, std::size_t k, DirectionalAlbedo& made) {
      made.node[k] = integrate_conductor_loss(cos, node_alpha(node), kFromOutside);
    });
  });
  return row;
}

DirectionalAlbedo reflection_albedo(float alpha, float eta) {
  const auto row_at = [](int slice, int node) -> const DirectionalAlbedo& {
    return outside_albedo(slice, node).reflected;
  };
  return interpolate(alpha, eta, Between::Reflectances, row_at);
}

DirectionalAlbedo dielectric_loss(float alpha, float eta) {
  if (eta < 1) return interpolate(alpha, 1 / eta, Between::Indices, inside_loss);
  const auto row_at = [](int slice, int node) -> const DirectionalAlbedo& {
    return outside_albedo(slice, node).lost;
  };
  return interpolate(alpha, eta, Between::Indices, row_at);
}

DirectionalAlbedo smooth_albedo(float eta) {
  DirectionalAlbedo row;
  for (int i = 0; i < kNodes; ++i)
    row.node[static_cast<std::size_t>(i)] = fresnel(DirectionalAlbedo::node_cos(i), eta);
  return row;
}

DirectionalAlbedo coat_loss_of_conductor(float alpha, const DirectionalAlbedo& coat) {
  return coat_losses.get(alpha, 0, coat, [&] {
    DirectionalAlbedo row = DirectionalAlbedo::constant(0);
    add_rows(alpha, 1, row, [&](int node) { return lowered_by_conductor(node) * coat; });
    return row;
  });
}

DirectionalAlbedo coat_loss_of_reflection(float alpha, float eta, const DirectionalAlbedo& coat) {
  return coat_losses.get(alpha, eta, coat, [&] {
    const auto row_at = [&](int slice, int node) { return lowered_by_reflection(slice, node) * coat; };
    return interpolate(alpha, eta, Between::Reflectances, row_at);
  });
}

// At a visible normal, G2 / G1(wo) of the reflected light gets away, and G1(wi) of the light that passes.
float integrate_conductor_loss(float cos, float alpha, Lattice lattice) {
  const Ggx ggx(alpha);
  double sum = 0;
  for_visible_normals(cos, ggx, lattice, [&](glm::vec3 wo, glm::vec3 m, float weight) {
    const float cos_i = 2 * glm::dot(wo, m) * m.z - wo.z;
    sum += static_cast<double>(weight * (1 - ggx.g2_over_g1(cos, cos_i)));
  });
  return static_cast<float>(sum);
}

InterfaceAlbedo integrate_dielectric(float cos, float alpha, float eta, Lattice lattice) {
  const Ggx ggx(alpha);
  double reflected = 0, lost = 0;
  for_visible_normals(cos, ggx, lattice, [&](glm::vec3 wo, glm::vec3 m, float weight) {
    const float cos_m = std::min(glm::dot(wo, m), 1.0f);
    const float share = fresnel(cos_m, eta);
    const float seen = ggx.g2_over_g1(cos, 2 * cos_m * m.z - wo.z);
    reflected += static_cast<double>(weight * share * seen);
    lost += static_cast<double>(weight * share * (1 - seen));
    if (share >= 1) return;
    const float cos_t = -refract_through(wo, m, eta).z;
    lost += static_cast<double>(weight * (1 - share) * (cos_t > 0 ? 1 - ggx.g1(cos_t) : 1));
  });
  return {static_cast<float>(reflected), static_cast<float>(lost)};
}

}  // namespace fathom::runtime
