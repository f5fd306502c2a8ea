// The bars of light: pictures against closed forms, what materials do to light, densities of everything that is
// sampled, ways to find light against each other, how fast errors fall. B17 to B22; limits stand where rows are made.
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "bench/bars.h"
#include "compiler/compile.h"

namespace fathom::bench {

// How much is tried. The default is what the bars ask for, but for how many pictures are compared.
struct LightCounts {
  double relative_sigma = 1e-3;  // of a picture's mean against a closed form
  int reciprocal_pairs = 20000;  // of directions, for each material
  int random_materials = 300;
  int chi_square_samples = 1000000;
  int pictures = 256;  // of each way and scene
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

// What `json` says, "version" supplied. Ends the program when it has errors.
compiler::CompiledScene compile_scene(const std::string& json);

// f(0) to f(n - 1), on all processors.
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
