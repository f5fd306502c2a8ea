// Compares Fathom with a renderer written by hand, on workloads S and P (workload.h): Fathom's whole march-and-shade
// time, at its own accuracy, against the usual hand-written renderer around the scene compiled ahead of time
// (packets-inl.h). The note below each row has the ray counts and mean values of both images, for comparison.
//
//     build/release/bench_workloads
#include <limits>

#include "bench/clouds.h"
#include "bench/comparison.h"
#include "bench/compiled_scenes/compiled_scenes.h"
#include "bench/fathom_workloads.h"

namespace {

using namespace fathom;
using namespace fathom::bench;

struct Row {
  const char* scene;
  double shadow_bar, path_bar;  // max ratios
  int rounds;
  // Limits of the hand-written renderer's work where it would take minutes: fewer paths per pixel, and an image
  // `smaller` times smaller in each dimension. Its time is scaled up by the ratio of the samples.
  int their_spp = 64, smaller = 1;
};
constexpr double kNone = std::numeric_limits<double>::infinity();
constexpr Row kRows[] = {{"A", 1, 0.8, 5},
                         {"B", 1, 1, 5},
                         {"C", 1, 1, 3},
                         {"E", 1, 1, 5},
                         {"D1000", 0.1, 0.1, 3, 2},
                         {"D10000", 1 / 60.0, 1 / 60.0, 1, 1},
                         {"D100000", kNone, kNone, 1, 1, 8}};

Frame reduced(Frame frame, int spp, int smaller) { return {frame.width / smaller, frame.height / smaller, spp}; }

double samples(const Frame& frame) { return static_cast<double>(frame.width) * frame.height * frame.spp; }

struct Scene {
  explicit Scene(const CompiledAhead& compiled) : ahead(compiled), scene(compile_file(compiled.path)) {
    scene.background.bottom = scene.background.top = glm::dvec3(1);  // for P; S does not use the background
  }
  const CompiledAhead& ahead;
  compiler::CompiledScene scene;
  Picture ours, theirs;
};

void compare(const std::string& name, Scene& s, const Frame& frame, const Frame& theirs, Render render, double bar,
             int rounds, Picture (*fathom)(const compiler::CompiledScene&, const Frame&)) {
  add({name, "ms", 1e3, bar, 0, rounds, [&s, frame, fathom] { s.ours = fathom(s.scene, frame); },
       [&s, theirs, render] { render(s.ahead.view, theirs, s.theirs); },
       [&s] {
         return fmt::format("rays {} / {}, camera hits {} / {}, mean {:.5f} / {:.5f}", s.ours.rays, s.theirs.rays,
                            s.ours.camera_hits, s.theirs.camera_hits, s.ours.mean(), s.theirs.mean());
       },
       false, samples(frame) / samples(theirs)});
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::unique_ptr<Scene>> scenes;
  for (const Row& row : kRows) {
    Scene& scene = *scenes.emplace_back(std::make_unique<Scene>(find(compiled_scenes(), row.scene)));
    compare(fmt::format("{}: S, Fathom / by hand", row.scene), scene, kShadowFrame,
            reduced(kShadowFrame, kShadowFrame.spp, row.smaller), scene.ahead.shadow, row.shadow_bar, row.rounds,
            fathom_shadow);
    compare(fmt::format("{}: P, Fathom / by hand", row.scene), scene, kPathFrame,
            reduced(kPathFrame, row.their_spp, row.smaller), scene.ahead.paths, row.path_bar, row.rounds,
            fathom_paths);
  }
  return run_benches(argc, argv, "Workloads S (640 x 360, a shadow ray) and P (320 x 180 paths, 4 bounces)");
}
