// Measures how whole renders scale, for every benchmark scene that takes a second: two threads against one, and four
// times the samples against four renders. Also measures the memory of a large image, which must not depend on the
// samples.
//
//     build/release/bench_renders
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>

#include "bench/clouds.h"
#include "bench/comparison.h"
#include "runtime/render.h"

namespace {

using namespace fathom;
using namespace fathom::bench;

struct Row {
  const char* scene;
  int spp;  // enough that one thread takes more than a second
};
constexpr Row kRows[] = {{"a-primitives", 16}, {"b-csg", 8},     {"c-mandelbulb", 3}, {"d1000", 12},
                         {"e-gyroid", 12},     {"f-formula", 8}, {"h-composite", 24}};
constexpr int kRounds = 5;

void render(const compiler::CompiledScene& scene, int threads, int spp) {
  runtime::RenderOptions options;
  options.threads = threads;
  options.spp = spp;
  options.layers = {.first_hit = false};
  runtime::render(scene, options);
}

// Returns the peak memory of `fathom render`, in megabytes.
double peak_memory(const std::string& scene, int spp) {
  const std::string path = std::string(FATHOM_SOURCE_DIR) + "/scenes/bench/" + scene + ".json";
  const std::string samples = std::to_string(spp);
  const std::string picture = std::filesystem::temp_directory_path() / fmt::format("bench_renders-{}.png", getpid());
  const pid_t child = fork();
  if (child == 0) {
    execl(FATHOM_PROGRAM, FATHOM_PROGRAM, "render", path.c_str(), "-q", "-s", samples.c_str(), "--size", "1920x1080",
          "-o", picture.c_str(), static_cast<char*>(nullptr));
    _exit(127);
  }
  int status = 0;
  rusage usage{};
  wait4(child, &status, 0, &usage);
  std::filesystem::remove(picture);
  if (status != 0) {
    fmt::print(stderr, "{} failed\n", FATHOM_PROGRAM);
    std::exit(1);
  }
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::unique_ptr<compiler::CompiledScene>> scenes;
  for (const Row& row : kRows) {
    const compiler::CompiledScene& scene = *scenes.emplace_back(
        std::make_unique<compiler::CompiledScene>(compile_file(fmt::format("scenes/bench/{}.json", row.scene))));
    const int spp = row.spp;
    Comparison threads{fmt::format("{}: two threads / one", row.scene),
                       "s",
                       1,
                       1 / 1.9,
                       0,
                       kRounds,
                       [&scene, spp] { render(scene, 2, spp); },
                       [&scene, spp] { render(scene, 1, spp); }};
    threads.wall = true;
    add(threads);
    add({fmt::format("{}: {} spp / four times {}", row.scene, 4 * spp, spp), "s", 1, 1.05, 0.95, kRounds,
         [&scene, spp] { render(scene, 1, 4 * spp); },
         [&scene, spp] {
           for (int i = 0; i < 4; ++i) render(scene, 1, spp);
         }});
  }
  for (const char* scene : {"a-primitives", "d10000"}) {
    add_number(fmt::format("{}: memory at 1920 x 1080, 1 spp", scene), "MB", 200,
               [=] { return peak_memory(scene, 1); });
    add_number(fmt::format("{}: memory at 1920 x 1080, 4 spp", scene), "MB", 200,
               [=] { return peak_memory(scene, 4); });
  }
  return run_benches(argc, argv, "Whole renders, 640 x 360");
}
