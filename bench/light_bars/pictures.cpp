// B21: images with the default light sampling against images of paths that find lights only by hits (BSDF sampling),
// with independent samples.
//
// Both are rendered many times with different seeds. Welch's test over the seeds compares cells of a few pixels, as
// in Jung, Hanika, Dachsbacher, "Detecting Bias in Monte Carlo Renderers using Welch's t-test", JCGT 9(2) 2020. When
// both have the same mean, the cells' p-values are uniform in [0,1], and none is below Sidak's level for all cells.
#include <cmath>

#include "bench/light_bars/light_bars.h"
#include "runtime/render.h"
#include "tests/support/chi_square.h"
#include "tests/support/light_scenes.h"

namespace fathom::bench {
namespace {

constexpr int kWidth = 48, kHeight = 32, kCell = 2;  // pixels
constexpr int kCells = kWidth * kHeight / (kCell * kCell);

// A box with white, red and green walls, a rough block and a glossy ball inside, and a square lamp a fifth as wide as
// the box.
const char* const kBox = R"("camera": {"position": [0, 1, 3.4], "target": [0, 1, 0], "fov": 50},
    "render": {"rr_depth": 3},
    "materials": {"white": {"type": "diffuse", "color": [0.75, 0.75, 0.75]},
      "red": {"type": "diffuse", "color": [0.6, 0.06, 0.05]}, "green": {"type": "diffuse", "color": [0.1, 0.5, 0.1]},
      "gloss": {"type": "principled", "color": [0.3, 0.4, 0.8], "roughness": 0.35, "coat": 0.5},
      "lamp": {"type": "emissive", "emission": [40, 36, 30]}},
    "objects": [{"type": "box", "half_size": [1, 0.05, 1], "translate": [0, -0.05, 0], "material": "white"},
      {"type": "box", "half_size": [1, 0.05, 1], "translate": [0, 2.05, 0], "material": "white"},
      {"type": "box", "half_size": [1.1, 1.1, 0.05], "translate": [0, 1, -1.05], "material": "white"},
      {"type": "box", "half_size": [0.05, 1.1, 1], "translate": [-1.05, 1, 0], "material": "red"},
      {"type": "box", "half_size": [0.05, 1.1, 1], "translate": [1.05, 1, 0], "material": "green"},
      {"type": "box", "half_size": [0.2, 0.01, 0.2], "translate": [0, 1.98, 0], "material": "lamp"},
      {"type": "box", "half_size": [0.3, 0.6, 0.3], "rotate": [0, 20, 0], "translate": [-0.4, 0.6, -0.3], "material": "white"},
      {"type": "sphere", "radius": 0.35, "translate": [0.4, 0.35, 0.2], "material": "gloss"}])";

// An evening sky and a wide sun; BSDF samples can hit both.
const char* const kOutside = R"("camera": {"position": [0, 1.6, 4.5], "target": [0, 0.6, 0], "fov": 45},
    "background": {"type": "sky", "elevation": 25, "azimuth": 60, "turbidity": 3, "sun_disc": false},
    "lights": {"sun": {"type": "directional", "direction": [-1, -1, -0.5], "irradiance": [3, 2.6, 2], "angle": 12}},
    "render": {"rr_depth": 3},
    "materials": {"clay": {"type": "diffuse", "color": [0.7, 0.35, 0.2]},
      "gold": {"type": "principled", "preset": "gold", "roughness": 0.4},
      "varnish": {"type": "principled", "color": [0.1, 0.3, 0.1], "roughness": 0.6, "coat": 1, "coat_roughness": 0.3}},
    "objects": [{"type": "plane", "normal": [0, 1, 0], "material": "clay"},
      {"type": "torus", "major_radius": 0.6, "minor_radius": 0.22, "translate": [-0.8, 0.25, 0], "material": "gold"},
      {"type": "box", "half_size": [0.4, 0.5, 0.4], "rotate": [0, 30, 0], "translate": [0.8, 0.5, 0], "material": "varnish"},
      {"type": "sphere", "radius": 0.3, "translate": [0, 0.3, 0.9], "material": "clay"}])";

struct Cell {
  double sum = 0, squares = 0;  // sums over the images' means
  void add(double value) { sum += value, squares += value * value; }
};

std::vector<Cell> draw(const compiler::CompiledScene& scene, runtime::RenderOptions options, std::uint64_t first_seed,
                       int pictures) {
  options.width = kWidth;
  options.height = kHeight;
  std::vector<Cell> cells(kCells);
  for (int i = 0; i < pictures; ++i) {
    options.seed = first_seed + static_cast<std::uint64_t>(i);
    const runtime::Film film = runtime::render(scene, options).film;
    for (int c = 0; c < kCells; ++c) {
      const int x = c % (kWidth / kCell) * kCell, y = c / (kWidth / kCell) * kCell;
      double sum = 0;
      for (int p = 0; p < kCell * kCell; ++p) {
        const glm::dvec3 radiance = film.means(x + p % kCell, y + p / kCell).radiance;
        sum += radiance.x + radiance.y + radiance.z;
      }
      cells[static_cast<std::size_t>(c)].add(sum);
    }
  }
  return cells;
}

// The regularised incomplete beta function by its continued fraction (Press et al., "Numerical Recipes", 3rd ed.
// 2007, section 6.4).
double beta_share(double a, double b, double x) {
  if (x <= 0) return 0;
  if (x > (a + 1) / (a + b + 2)) return 1 - beta_share(b, a, 1 - x);
  double c = 1, d = 1 / (1 - (a + b) * x / (a + 1)), h = d;
  for (int m = 1; m < 1000; ++m) {
    const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
    const double before = h;
    for (const double term : {even, odd}) {
      d = 1 / (1 + term * d);
      c = 1 + term / c;
      h *= c * d;
    }
    if (std::abs(h - before) < 1e-15 * h) break;
  }
  return std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log1p(-x)) * h /
         a;
}

// Returns the probability that two samples of n and m numbers with equal means differ at least as much as a and b:
// Welch, "The Generalization of 'Student's' Problem when Several Different Population Variances are Involved", 1947.
double welch_p(const Cell& a, int n, const Cell& b, int m) {
  const double mean_a = a.sum / n, mean_b = b.sum / m;
  const double va = std::max(0.0, a.squares / n - mean_a * mean_a) / (n - 1);
  const double vb = std::max(0.0, b.squares / m - mean_b * mean_b) / (m - 1);
  // Cells that see only one constant lamp differ by rounding alone.
  const double v = va + vb + 1e-14 * (mean_a * mean_a + 1e-14);
  const double t2 = (mean_a - mean_b) * (mean_a - mean_b) / v;
  const double freedom = v * v / (va * va / (n - 1) + vb * vb / (m - 1) + 1e-300);
  return beta_share(std::min(freedom, 1e6) / 2, 0.5, std::min(freedom, 1e6) / (std::min(freedom, 1e6) + t2));
}

// Returns the probability that uniform numbers in [0,1] are at least as uneven as `values`: the Kolmogorov-Smirnov
// test with Stephens' correction for the number of values, "Use of the Kolmogorov-Smirnov, Cramer-von Mises and
// Related Statistics Without Extensive Tables", 1970.
double evenness_p(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const double n = static_cast<double>(values.size());
  double most = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double below = static_cast<double>(i) / n;
    most = std::max({most, values[i] - below, below + 1 / n - values[i]});
  }
  const double lambda = (std::sqrt(n) + 0.12 + 0.11 / std::sqrt(n)) * most;
  double sum = 0;
  for (int k = 1; k < 100; ++k) sum += (k % 2 == 1 ? 2 : -2) * std::exp(-2 * k * k * lambda * lambda);
  return std::clamp(sum, 0.0, 1.0);
}

struct Comparison {
  const char* name;
  const char* json;
  int spp_default, spp_hits;
};

void compare(BarTable& table, const Comparison& comparison, int pictures) {
  const compiler::CompiledScene scene = compile_scene(comparison.json);
  runtime::RenderOptions by_default, by_chance;
  by_default.spp = comparison.spp_default;
  by_chance.spp = comparison.spp_hits;
  by_chance.sampler = compiler::SamplerKind::Independent;
  by_chance.light_sampling = runtime::LightSampling::Bsdf;
  const std::vector<Cell> a = draw(scene, by_default, 1, pictures), b = draw(scene, by_chance, 1u << 20, pictures);
  std::vector<double> p, random;
  double difference = 0, mean = 0, variance = 0;
  for (std::size_t c = 0; c < kCells; ++c) {
    p.push_back(welch_p(a[c], pictures, b[c], pictures));
    // A cell that sees only one lamp is the same in every image and has no meaningful p-value.
    const double mean_b = b[c].sum / pictures, variance_b = b[c].squares / pictures - mean_b * mean_b;
    if (variance_b > 1e-10 * mean_b * mean_b) random.push_back(p.back());
    difference += (a[c].sum - b[c].sum) / pictures / kCells;
    mean += mean_b / kCells;
    variance += variance_b / (pictures - 1) / kCells / kCells;
  }
  const double level = test::sidak(0.01, kCells);
  const auto passed =
      static_cast<double>(std::count_if(p.begin(), p.end(), [&](double each) { return each > level; }));
  table.row("B21",
            fmt::format("{}: default {} spp, hits {} spp, {} pictures each: cells that Welch's test passes",
                        comparison.name, comparison.spp_default, comparison.spp_hits, pictures),
            ">= 99.75 %",
            fmt::format("{:.2f} % of {}, least p {:.1e}", 100 * passed / kCells, kCells,
                        *std::min_element(p.begin(), p.end())),
            passed >= 0.9975 * kCells);
  const double even = evenness_p(random);
  table.row("B21",
            fmt::format("{}: p-values of the {} cells that vary lie evenly, Kolmogorov-Smirnov p; means differ",
                        comparison.name, random.size()),
            "> 0.01", fmt::format("{:.3f}; {:+.1e} +- {:.0e}", even, difference / mean, std::sqrt(variance) / mean),
            even > 0.01);
}

}  // namespace

void picture_bars(BarTable& table, const LightCounts& counts) {
  const Comparison comparisons[] = {{"room with lamps of every kind", test::kAreaLightRoom, 16, 96},
                                    {"box with a small lamp", kBox, 16, 96},
                                    {"outside under sky and sun", kOutside, 16, 96}};
  for (const Comparison& comparison : comparisons) compare(table, comparison, counts.pictures);
}

}  // namespace fathom::bench
