// Measures the cost of interpretation: time per point of the block machine against three others. The first is the
// same scene as C++, compiled ahead of time with the same lanes and floating-point flags (`fathom emit cpp`). The
// second is that C++ with -O3 -march=native -ffast-math. The third is the machine's own scalar interpreter: the same
// loop over registers of one float, one point at a time.
//
//     build/release/bench_interpreter
#include <chrono>
#include <cmath>
#include <initializer_list>
#include <string>
#include <utility>
#include <variant>

#include "bench/clouds.h"
#include "bench/comparison.h"
#include "bench/compiled_scenes/compiled_scenes.h"
#include "vm/native/native_program.h"

namespace {

using namespace fathom;
using namespace fathom::bench;

constexpr std::size_t kPoints = 4096;
constexpr int kRounds = 41;

// A scene's programs and a cloud of points, alive while the benches run.
class Scene {
 public:
  explicit Scene(const CompiledAhead& ahead)
      : scene_(compile_file(ahead.path)),
        cloud_(make_cloud(kPoints, scene_.bound)),
        out_(kPoints),
        convex_(kPoints),
        native_(vm::NativeProgram::compile(scene_.distance, vm::RecordedResults::Distance)),
        native_convex_(vm::NativeProgram::compile(scene_.distance, vm::RecordedResults::DistanceAndConvexity)) {}

  // Number of repeats per round, so that a round takes a millisecond or more.
  int repeats() const { return std::max(1, 4000 / static_cast<int>(scene_.distance.instructions() + 50)); }

  void interpret(int repeats) {
    for (int i = 0; i < repeats; ++i) {
      vm::evaluate_distance(scene_.distance, cloud_.points(), kPoints, out_.data(), workspace_);
    }
  }
  void interpret_convex(int repeats) {
    for (int i = 0; i < repeats; ++i) {
      vm::evaluate_convex(scene_.distance, cloud_.points(), kPoints, out_.data(), convex_.data(), workspace_);
    }
  }
  void interpret_scalar() {
    const std::string_view before = vm::isa_name();
    vm::force_isa("scalar");
    const vm::Points points = cloud_.points();
    for (std::size_t i = 0; i < kPoints; ++i) {
      vm::evaluate_distance(scene_.distance, {points.x + i, points.y + i, points.z + i}, 1, &out_[i], workspace_);
    }
    vm::force_isa(before);
  }
  bool has_native() const { return native_ && native_convex_; }
  // Returns the time to compile the distance program and the size of its code.
  std::string describe_native() const {
    const auto begin = std::chrono::steady_clock::now();
    const auto native = vm::NativeProgram::compile(scene_.distance, vm::RecordedResults::Distance);
    const std::chrono::duration<double, std::milli> spent = std::chrono::steady_clock::now() - begin;
    return fmt::format("compiled in {:.2f} ms to {} bytes", spent.count(), native->code_bytes());
  }
  void run_native(int repeats) {
    for (int i = 0; i < repeats; ++i) native_->evaluate(cloud_.points(), kPoints, out_.data());
  }
  void run_native_convex(int repeats) {
    for (int i = 0; i < repeats; ++i) native_convex_->evaluate(cloud_.points(), kPoints, out_.data(), convex_.data());
  }
  void run(DistanceOf distance, int repeats) {
    for (int i = 0; i < repeats; ++i) distance(cloud_.points(), kPoints, out_.data());
  }

 private:
  compiler::CompiledScene scene_;
  Cloud cloud_;
  std::vector<float> out_, convex_;
  std::shared_ptr<const vm::NativeProgram> native_, native_convex_;
  vm::Workspace workspace_;
};

// A program of one function's instructions: one value at each point of a cloud 8 units wide.
class Function {
 public:
  explicit Function(std::initializer_list<vm::Opcode> opcodes)
      : program_(program_of(opcodes)), cloud_(make_cloud(kPoints, {{-4, -4, -4}, {4, 4, 4}})), out_(kPoints) {}

  void run(int repeats) {
    for (int i = 0; i < repeats; ++i) {
      vm::evaluate_distance(program_, cloud_.points(), kPoints, out_.data(), workspace_);
    }
  }

 private:
  static vm::VerifiedProgram program_of(std::initializer_list<vm::Opcode> opcodes) {
    vm::Program program;
    for (const vm::Opcode opcode : opcodes) program.append(opcode, 0, {}, {});
    return std::get<vm::VerifiedProgram>(vm::verify(std::move(program)));
  }

  vm::VerifiedProgram program_;
  Cloud cloud_;
  std::vector<float> out_;
  vm::Workspace workspace_;
};

struct Bars {
  const char* scene;
  double ahead, scalar;  // max ratios to the C++ compiled ahead of time and to the scalar interpreter
  double native;         // max ratio of native code to the C++ compiled ahead of time
};
constexpr Bars kBars[] = {{"A", 1.15, 0.1, 1.1},          {"B", 1.15, 0.1, 1}, {"D1000", 1.15, 0.1, 1},
                          {"C", 1.25, 1 / 7.0, INFINITY}, {"E", 1.25, 0.1, 1}, {"F", 4, 0.1, 1.5}};

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::unique_ptr<Scene>> scenes;
  for (const Bars& bars : kBars) {
    const CompiledAhead &ahead = find(compiled_scenes(), bars.scene), &fast = find(fast_scenes(), bars.scene);
    Scene& scene = *scenes.emplace_back(std::make_unique<Scene>(ahead));
    const std::string name = bars.scene;
    const int repeats = scene.repeats();
    const double nanoseconds = 1e9 / kPoints / repeats;
    const auto interpret = [&scene, repeats] { scene.interpret(repeats); };
    const auto against = [&scene, repeats](DistanceOf run) {
      return [&scene, repeats, run] { scene.run(run, repeats); };
    };
    add({name + ": machine / emitted C++", "ns a point", nanoseconds, bars.ahead, 0, kRounds, interpret,
         against(ahead.distance)});
    add({name + ": machine / emitted C++ with -ffast-math", "ns a point", nanoseconds, INFINITY, 0, kRounds,
         interpret, against(fast.distance)});
    add({name + ": telling what is convex / distances alone", "ns a point", nanoseconds, INFINITY, 0, kRounds,
         [&scene, repeats] { scene.interpret_convex(repeats); }, interpret});
    if (scene.has_native()) {
      add({name + ": native code / emitted C++", "ns a point", nanoseconds, bars.native, 0, kRounds,
           [&scene, repeats] { scene.run_native(repeats); }, against(ahead.distance),
           [&scene] { return scene.describe_native(); }});
      add({name + ": native code / machine, telling what is convex", "ns a point", nanoseconds, INFINITY, 0, kRounds,
           [&scene, repeats] { scene.run_native_convex(repeats); },
           [&scene, repeats] { scene.interpret_convex(repeats); }});
    }
    add({name + ": machine / its scalar interpreter", "ns a point", 1e9 / kPoints, bars.scalar, 0, kRounds,
         [&scene] { scene.interpret(1); }, [&scene] { scene.interpret_scalar(); }});
  }
  using vm::Opcode;
  Function noise{Opcode::X, Opcode::Y, Opcode::Z, Opcode::Noise}, sine{Opcode::X, Opcode::Sin};
  constexpr int kRepeats = 50;
  add({"noise(x, y, z) / sin(x)", "ns a point", 1e9 / kPoints / kRepeats, INFINITY, 0, kRounds,
       [&noise] { noise.run(kRepeats); }, [&sine] { sine.run(kRepeats); }});
  return run_benches(argc, argv, fmt::format("Interpreter, {} points at random", kPoints));
}
