// The acceptance bars of light, B17 to B22: images against closed forms, energy and reciprocity of materials,
// densities of everything that is sampled, light sampling strategies against each other, convergence rates. The
// limits stand where the rows are made.
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "bench/bars/bars.h"
#include "compiler/compile.h"

namespace fathom::bench {

// Numbers of cases. The default is what the bars ask for, except for the number of compared images.
struct LightCounts {
  double relative_sigma = 1e-3;  // of an image's mean against a closed form
  int reciprocal_pairs = 20000;  // pairs of directions per material
  int random_materials = 300;
  int chi_square_samples = 1000000;
  int pictures = 256;  // images per strategy and scene
  int slope_repeats = 400;
};
inline constexpr LightCounts kFullLight{.relative_sigma = 5e-4,
                                        .reciprocal_pairs = 1000000,
                                        .random_materials = 3000,
                                        .chi_square_samples = 4000000,
                                        .pictures = 512,
                                        .slope_repeats = 4000};

void furnace_bars(BarTable& table, const LightCounts& counts);   // B17 and the closed forms P1 to P10
void material_bars(BarTable& table, const LightCounts& counts);  // B18, B19
void density_bars(BarTable& table, const LightCounts& counts);   // B20
void picture_bars(BarTable& table, const LightCounts& counts);   // B21
void slope_bars(BarTable& table, const LightCounts& counts);     // B22

// Compiles the scene `json`, to which "version" is added. Ends the program when the scene has errors.
compiler::CompiledScene compile_scene(const std::string& json);

// Calls f(0) to f(n - 1), on all processors.
inline void for_each_index(std::size_t n, const std::function<void(std::size_t)>& f) {
  std::atomic<std::size_t> next = 0;
  std::vector<std::jthread> threads;
  for (unsigned t = 0; t < std::max(1u, std::thread::hardware_concurrency()); ++t) {
    threads.emplace_back([&] {
      for (std::size_t i; (i = next++) < n;) f(i);
    });
  }
}

}  // namespace fathom::bench
