// B20: samples follow their density. Pearson's chi-square test with a million samples per case, at level .01 for all
// cases together (Sidak).
#include <cmath>
#include <numeric>

#include "bench/light_bars/light_bars.h"
#include "runtime/light/environment.h"
#include "runtime/sampling/camera.h"
#include "runtime/sampling/filter.h"
#include "tests/support/area_light_patches.h"
#include "tests/support/chi_square.h"
#include "tests/support/environments.h"
#include "tests/support/materials.h"

namespace fathom::bench {
namespace {

using runtime::Sampler;
using test::ChiSquare;

struct Pair {
  std::string name;
  std::function<ChiSquare()> test;
};
struct Group {
  const char* name;
  std::vector<Pair> pairs;
};

test::ChiSquareSetup setup_of(int samples, glm::vec3 pole, std::size_t seed) {
  test::ChiSquareSetup setup;
  setup.samples = samples;
  setup.pole = pole;
  setup.seed = seed + 1;
  return setup;
}

Group materials(int samples) {
  Group group{"materials from 5 directions, alpha 0.02 to 1", {}};
  std::vector<test::MaterialCase> cases = test::materials();
  for (const float alpha : {0.02f, 1.0f}) {
    cases.push_back({fmt::format("glass {}", alpha), test::glass(alpha)});
    cases.push_back({fmt::format("glass from inside {}", alpha), test::glass(alpha), true});
  }
  for (const test::MaterialCase& c : cases) {
    for (const float cos : test::kCosines) {
      const std::size_t seed = group.pairs.size();
      group.pairs.push_back({fmt::format("{}, cos {}", c.name, cos), [=] {
                               const runtime::Bsdf bsdf = c.bsdf(test::towards(cos, 0.2f));
                               const auto sample = [&](Sampler& sampler) -> std::optional<glm::vec3> {
                                 const float lobe = sampler.next();
                                 const runtime::BsdfSample s = bsdf.sample(lobe, sampler.next2());
                                 if (!(s.pdf > 0)) return std::nullopt;
                                 return s.wi;
                               };
                               const auto pdf = [&](glm::vec3 wi) {
                                 return static_cast<double>(bsdf.evaluate(wi).pdf);
                               };
                               return test::chi_square(sample, pdf, setup_of(samples, test::kNormal, seed));
                             }});
    }
  }
  return group;
}

Group visible_normals(int samples) {
  Group group{"visible normals of GGX, alpha 0.02 to 1", {}};
  for (const float alpha : {0.02f, 0.1f, 0.3f, 0.5f, 1.0f}) {
    for (const float cos : test::kCosines) {
      const std::size_t seed = 1000 + group.pairs.size();
      group.pairs.push_back({fmt::format("alpha {}, cos {}", alpha, cos), [=] {
                               const runtime::Ggx ggx(alpha);
                               const glm::vec3 wo(std::sqrt(1 - cos * cos), 0, cos);
                               const auto sample = [&](Sampler& s) {
                                 return ggx.sample_visible_normal(wo, s.next2());
                               };
                               const auto pdf = [&](glm::vec3 m) {
                                 return m.z > 0 ? static_cast<double>(ggx.visible_normal_pdf(wo, m)) : 0.0;
                               };
                               return test::chi_square(sample, pdf, setup_of(samples, {0, 0, 1}, seed));
                             }});
    }
  }
  return group;
}

Group hemisphere(int samples) {
  const auto test = [=] {
    const auto sample = [](Sampler& s) { return runtime::square_to_cosine_hemisphere(s.next2()); };
    const auto pdf = [](glm::vec3 w) { return static_cast<double>(runtime::square_to_cosine_hemisphere_pdf(w)); };
    return test::chi_square(sample, pdf, setup_of(samples, {0, 0, 1}, 2000));
  };
  return {"hemisphere by cosine", {{"hemisphere", test}}};
}

Group area_lights(int samples) {
  Group group{"lamps of every shape from 4 places", {}};
  for (const test::NamedAreaLight& area_light : test::kAreaLights) {
    for (const glm::dvec3 from : test::kShadingPoints) {
      group.pairs.push_back({fmt::format("{} from ({}, {}, {})", area_light.name, from.x, from.y, from.z),
                             [&area_light, from, samples] {
                               return test::area_light_chi_square(runtime::AreaLightShape(area_light.area_light),
                                                                  from, samples, 96);
                             }});
    }
  }
  return group;
}

struct Beyond {
  const char* name;
  std::string json;
  glm::vec3 pole;
  int rows;
};

Group environments(int samples) {
  const std::string ball = R"(, "objects": [{"type": "sphere", "radius": 1}])";
  // The pole points at the disc's centre and the rows span 5 degrees: the disc's rim is a cell border, not a step
  // inside cells.
  const glm::vec3 to_disc = glm::normalize(glm::vec3(1, 2, 1));
  const Beyond cases[] = {{"disc", R"("lights": {"far": {"type": "directional", "direction": [-1, -2, -1],
                               "irradiance": [2, 2, 2], "angle": 10}})",
                           to_disc, 36},
                          {"sky", test::kSky, {0, 1, 0}, 40},
                          {"picture", test::kPicture, {0, 1, 0}, 40}};
  const runtime::LightSampleContext queries[] = {
      {{0, 0, 0}, {0, 1, 0}}, {{0, 0, 0}, {0.6f, -0.48f, 0.64f}}, {{0, 0, 0}, {0, 0, 1}, true}};
  Group group{"what lies beyond the scene, for 3 surfaces", {}};
  for (const Beyond& c : cases) {
    const auto environment =
        std::make_shared<runtime::Environment>(compile_scene(c.json + ball), test::random_map(12, 6));
    for (const runtime::LightSampleContext& query : queries) {
      if (!(environment->importance(query) > 0)) continue;  // the disc is behind the surface
      test::ChiSquareSetup setup = setup_of(samples, c.pole, 3000 + group.pairs.size());
      setup.rows = c.rows;
      setup.columns = 2 * c.rows;
      group.pairs.push_back({fmt::format("{} for normal y {}", c.name, query.normal.y), [=] {
                               const auto sample = [&](Sampler& s) {
                                 const float choice = s.next();
                                 return test::sample_of(*environment, query, choice, s.next2()).direction;
                               };
                               const auto pdf = [&](glm::vec3 w) {
                                 return static_cast<double>(test::pdf_of(*environment, query, w));
                               };
                               return test::chi_square(sample, pdf, setup);
                             }});
    }
  }
  return group;
}

// Shares of |filter| in bins along one axis, by Simpson's rule.
std::vector<double> filter_shares(runtime::FilterKind kind, int bins) {
  constexpr int kSteps = 400;
  std::vector<double> shares;
  for (int bin = 0; bin < bins; ++bin) {
    double sum = 0;
    for (int i = 0; i <= kSteps; ++i) {
      const double t = std::abs(2 * (bin + static_cast<double>(i) / kSteps) / bins - 1);
      sum += (i == 0 || i == kSteps ? 1
              : i % 2 == 1          ? 4
                                    : 2) *
             std::abs(runtime::filter_value(kind, std::min(t, 1.0)));
    }
    shares.push_back(sum);
  }
  const double all = std::accumulate(shares.begin(), shares.end(), 0.0);
  for (double& share : shares) share /= all;
  return shares;
}

// Draws samples with `cell`, which returns the index of a sample's cell, and tests the counts per cell.
ChiSquare test_cells(std::vector<double> expected, int samples, std::uint64_t seed,
                     const std::function<std::size_t(glm::vec2 u)>& cell) {
  std::vector<double> counts(expected.size());
  for (double& share : expected) share *= samples;
  for (int i = 0; i < samples; ++i) {
    Sampler sampler(seed, static_cast<std::uint32_t>(i), 0, 0);
    ++counts[cell(sampler.next2())];
  }
  return test::pearson(counts, expected);
}

std::size_t bin(double t, int bins) {
  return static_cast<std::size_t>(std::clamp(static_cast<int>(t * bins), 0, bins - 1));
}

Group filters(int samples) {
  Group group{"pixel filters", {}};
  for (std::size_t kind = 0; kind < compiler::kFilterNames.size(); ++kind) {
    group.pairs.push_back({std::string(compiler::kFilterNames[kind]), [=] {
                             constexpr int kBins = 24;
                             const runtime::Filter filter(static_cast<runtime::FilterKind>(kind));
                             const std::vector<double> axis =
                                 filter_shares(static_cast<runtime::FilterKind>(kind), kBins);
                             std::vector<double> expected;
                             for (const double y : axis) {
                               for (const double x : axis) expected.push_back(x * y);
                             }
                             return test_cells(expected, samples, 4000 + kind, [&](glm::vec2 u) {
                               const glm::dvec2 t = glm::dvec2(filter.sample(u).offset) / filter.radius() / 2.0 + 0.5;
                               return bin(t.y, kBins) * kBins + bin(t.x, kBins);
                             });
                           }});
  }
  return group;
}

// The round lens is divided into rings and sectors of equal area, a lens with blades into shells and sectors.
Group lenses(int samples) {
  Group group{"places on the lens, round and with blades", {}};
  for (const int blades : {0, 3, 5, 6, 9}) {
    group.pairs.push_back(
        {fmt::format("{} blades", blades), [=] {
           compiler::Camera spec;
           spec.position = {0, 0, 5};
           spec.lens_radius = 1;
           spec.focus_distance = 5;
           spec.blades = blades;
           const runtime::Camera camera(spec, 10, 10);
           constexpr int kShells = 16, kPieces = 30;
           std::vector<double> expected(kShells * kPieces, 1.0 / (kShells * kPieces));
           return test_cells(expected, samples, 5000 + static_cast<std::uint64_t>(blades), [&](glm::vec2 u) {
             const glm::dvec2 p = camera.lens_point(u);
             const double turn = std::atan2(-p.x, p.y) / (2 * M_PI), around = turn < 0 ? turn + 1 : turn;
             if (blades == 0) return bin(glm::dot(p, p), kShells) * kPieces + bin(around, kPieces);
             // A sector between two corners is a triangle: its cells divide its height and its base.
             const double within = (around * blades - std::floor(around * blades) - 0.5) * 2 * M_PI / blades;
             const double height = glm::length(p) * std::cos(within) / std::cos(M_PI / blades);
             const double along =
                 (std::floor(around * blades) + 0.5 + std::tan(within) / std::tan(M_PI / blades) / 2) / blades;
             return bin(height * height, kShells) * kPieces + bin(along, kPieces);
           });
         }});
  }
  return group;
}

}  // namespace

void density_bars(BarTable& table, const LightCounts& counts) {
  const int n = counts.chi_square_samples;
  const Group groups[] = {materials(n),    visible_normals(n), hemisphere(n), area_lights(n),
                          environments(n), filters(n),         lenses(n)};
  int tests = 0;
  for (const Group& group : groups) tests += static_cast<int>(group.pairs.size());
  const double level = test::sidak(0.01, tests);
  for (const Group& group : groups) {
    std::vector<ChiSquare> results(group.pairs.size());
    for_each_index(results.size(), [&](std::size_t i) { results[i] = group.pairs[i].test(); });
    std::size_t least = 0, below = 0;
    for (std::size_t i = 0; i < results.size(); ++i) {
      if (!(results[i].p >= results[least].p)) least = i;
      if (results[i].p > level) continue;
      ++below;
      fmt::print("     {}: {}\n", group.pairs[i].name, results[i].describe());
    }
    table.row("B20", fmt::format("{}: {} chi-square tests of {} samples, least p", group.name, results.size(), n),
              fmt::format("> {:.2g}", level), fmt::format("{:.2g} ({})", results[least].p, group.pairs[least].name),
              below == 0);
  }
}

}  // namespace fathom::bench
