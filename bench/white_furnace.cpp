// Measures the light that white materials lose: a ball of each material under uniform light of radiance 1. The table
// has the smallest, mean and largest returned fraction, by kind of material.
//
//     build/release/bench_white_furnace                500 random materials of specular_weight 1, and some named ones
//     build/release/bench_white_furnace --count 50     fewer random materials
//     build/release/bench_white_furnace --spp 256      less noise; 64 samples of 32 x 32 pixels err by some 1e-3
#include "tests/support/white_furnace.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <functional>
#include <numeric>
#include <string_view>
#include <vector>

#include "compiler/compile.h"

namespace fathom::bench {
namespace {

constexpr int kSide = 32;

compiler::CompiledScene compile_furnace(const std::string& material) {
  compiler::Diagnostics diagnostics;
  const compiler::Source source("furnace", "{\"version\": 1, " + test::furnace(material) + "}");
  auto scene = compiler::compile(source, diagnostics);
  if (!scene) {
    fmt::print(stderr, "{}", diagnostics.print(source, compiler::ErrorFormat::Text));
    std::exit(65);
  }
  return *std::move(scene);
}

struct Named {
  const char* name;
  const char* rest;  // the material's other JSON members
};
constexpr Named kNamed[] = {
    {"metal of roughness 0.3 under a smooth coat", R"("metalness": 1, "roughness": 0.3, "coat": 1)"},
    {"metal of roughness 0.8 under a smooth coat", R"("metalness": 1, "roughness": 0.8, "coat": 1)"},
    {"plastic of roughness 0.3 under a smooth coat", R"("roughness": 0.3, "coat": 1)"},
    {"metal of roughness 0.3 under a coat of 0.3",
     R"("metalness": 1, "roughness": 0.3, "coat": 1, "coat_roughness": 0.3)"},
    {"plastic of roughness 0.3", R"("roughness": 0.3)"},
    {"plastic with diffuse_roughness 1", R"("roughness": 0.3, "diffuse_roughness": 1)"},
    {"glass of roughness 0.15, ior 2.4", R"("transmission": 1, "roughness": 0.15, "ior": 2.4)"},
    {"glass of roughness 0.15, ior 1.5", R"("transmission": 1, "roughness": 0.15, "ior": 1.5)"},
    {"smooth glass under a smooth coat", R"("transmission": 1, "roughness": 0, "coat": 1)"},
    {"glass of roughness 0.3 under a smooth coat", R"("transmission": 1, "roughness": 0.3, "coat": 1)"},
};

struct Furnace {
  test::WhiteMaterial material;
  double returned;
};

void print_row(const char* what, const std::vector<Furnace>& all,
               const std::function<bool(const test::WhiteMaterial&)>& wanted) {
  std::vector<double> values;
  for (const Furnace& furnace : all) {
    if (wanted(furnace.material)) values.push_back(furnace.returned);
  }
  if (values.empty()) return;
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  fmt::print("{:<48}{:>8}{:>9.4f}{:>9.4f}{:>9.4f}\n", what, values.size(),
             *std::min_element(values.begin(), values.end()), mean, *std::max_element(values.begin(), values.end()));
}

void print_table(int count, int spp) {
  fmt::print("{:<48}{:>17}\n", "material", "returned");
  for (const Named& named : kNamed) {
    const std::string json = fmt::format(R"({{"type": "principled", "color": [1, 1, 1], {}}})", named.rest);
    fmt::print("{:<48}{:>17.4f}\n", named.name, test::returned(compile_furnace(json), kSide, 16 * spp));
  }
  std::vector<Furnace> all;
  for (int i = 0; i < count; ++i) {
    test::WhiteMaterial material = test::random_white(static_cast<std::uint32_t>(i));
    const double returned = test::returned(compile_furnace(material.json), kSide, spp);
    all.push_back({std::move(material), returned});
  }
  fmt::print("\n{:<48}{:>8}{:>9}{:>9}{:>9}\n", "random materials", "count", "least", "mean", "most");
  using test::WhiteMaterial;
  print_row("all", all, [](const WhiteMaterial&) { return true; });
  print_row("no coat, diffuse_roughness 0", all, [](const WhiteMaterial& m) { return !m.coat && !m.rough_pigment; });
  print_row("no coat, diffuse_roughness above 0", all,
            [](const WhiteMaterial& m) { return !m.coat && m.rough_pigment; });
  print_row("coat over what is opaque, diffuse_roughness 0", all,
            [](const WhiteMaterial& m) { return m.coat && !m.glass && !m.rough_pigment; });
  print_row("coat over glass", all, [](const WhiteMaterial& m) { return m.coat && m.glass; });
  std::sort(all.begin(), all.end(), [](const Furnace& a, const Furnace& b) { return a.returned < b.returned; });
  for (std::size_t i = 0; i < std::min<std::size_t>(3, all.size()); ++i) {
    fmt::print("{:.4f} {}\n", all[i].returned, all[i].material.json);
  }
}

}  // namespace
}  // namespace fathom::bench

int main(int argc, char** argv) {
  int count = 500, spp = 64;
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i], value = i + 1 < argc ? argv[i + 1] : "";
    int* const number = word == "--count" ? &count : word == "--spp" ? &spp : nullptr;
    if (number == nullptr || std::from_chars(value.data(), value.data() + value.size(), *number).ec != std::errc() ||
        *number < 1) {
      fmt::print(stderr, "usage: bench_white_furnace [--count N] [--spp N]\n");
      return 2;
    }
    ++i;
  }
  fathom::bench::print_table(count, spp);
  return 0;
}
