// Compiles emitted C++ over the machine's lanes and compares it bit for bit with the machine, on every instruction
// set.
#include <string>
#include <vector>

#include "tests/support/compiled.h"
#include "tests/support/random/random_scene.h"
#include "tests/vm/number/float_bits.h"

#ifndef HWY_DISABLED_TARGETS
#define HWY_DISABLED_TARGETS HWY_SSSE3
#endif
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/compiler/emit/emitted_lanes_test.cpp"
// clang-format off
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "bench/emitted_lanes.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace fathom::test::HWY_NAMESPACE {

#undef SCENE_C_DISTANCE_H
#undef SCENE_E_DISTANCE_H
#undef HI_DISTANCE_H
#include "hi.h"
#include "scene_c.h"
#include "scene_e.h"
#include "tests/support/catch.h"

using vm::HWY_NAMESPACE::Batch;

template <class Field>
void for_each_batch(vm::Points points, std::size_t count, float* distance, const Field& field) {
  for (std::size_t i = 0; i + vm::HWY_NAMESPACE::kLanes <= count; i += vm::HWY_NAMESPACE::kLanes) {
    field(Batch::load(points.x + i), Batch::load(points.y + i), Batch::load(points.z + i)).store(distance + i);
  }
}
void emitted_hi(vm::Points points, std::size_t count, float* distance) {
  for_each_batch(points, count, distance, [](Batch x, Batch y, Batch z) HWY_ATTR { return hi::distance(x, y, z); });
}
void emitted_bulb(vm::Points points, std::size_t count, float* distance) {
  for_each_batch(points, count, distance,
                 [](Batch x, Batch y, Batch z) HWY_ATTR { return scene_c::distance(x, y, z); });
}
void emitted_gyroid(vm::Points points, std::size_t count, float* distance) {
  for_each_batch(points, count, distance,
                 [](Batch x, Batch y, Batch z) HWY_ATTR { return scene_e::distance(x, y, z); });
}

}  // namespace fathom::test::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <fstream>
#include <functional>
#include <sstream>

namespace fathom::test::emitted_lanes_test {
namespace {

HWY_EXPORT(emitted_hi);
HWY_EXPORT(emitted_bulb);
HWY_EXPORT(emitted_gyroid);

void check_bits(const char* path, const std::function<void(vm::Points, std::size_t, float*)>& field) {
  std::stringstream text;
  text << std::ifstream(std::string(FATHOM_SOURCE_DIR "/") + path).rdbuf();
  const compiler::CompiledScene scene = test::compiled(text.str());
  constexpr std::size_t kPoints = 2048;
  Random random(5);
  Cloud cloud;
  for (std::size_t i = 0; i < kPoints; ++i) {
    const glm::dvec3 p = random.in_box(1.5);
    cloud.add(static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z));
  }
  vm::Workspace workspace;
  std::vector<float> distance(kPoints);
  field(cloud.from(0), kPoints, distance.data());
  const auto machine = distance_bits(scene.distance, cloud.from(0), kPoints, workspace);
  std::size_t differing = 0;
  for (std::size_t i = 0; i < kPoints; ++i) differing += bits_of(distance[i]) != machine[i];
  CAPTURE(path, vm::isa_name());
  CHECK(differing == 0);
}

}  // namespace

TEST_CASE("emitted C++ over the machine's lanes gives its bits on every instruction set", "[emit]") {
  const IsaGuard guard;
  for (const std::string_view isa : vm::available_isas()) {
    REQUIRE(vm::force_isa(isa));
    check_bits("tests/data/hi.vm", [](auto... arguments) { HWY_DYNAMIC_DISPATCH(emitted_hi)(arguments...); });
    check_bits("scenes/bench/c-mandelbulb.json", [](auto... arguments) {
      HWY_DYNAMIC_DISPATCH(emitted_bulb)(arguments...);
    });
    check_bits("scenes/bench/e-gyroid.json", [](auto... arguments) {
      HWY_DYNAMIC_DISPATCH(emitted_gyroid)(arguments...);
    });
  }
}

}  // namespace fathom::test::emitted_lanes_test
#endif
