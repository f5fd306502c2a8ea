// The evaluator of skeletons, compiled once for each instruction set (Highway's foreach_target).
#include <algorithm>
#include <numeric>

#include "vm/skeleton.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vm/evaluate_skeleton.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "vm/interpret-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::vm::HWY_NAMESPACE {

// The first lane's number, of those that are left.
HWY_INLINE float first_of(Batch numbers, BatchMask left) {
  alignas(64) float lanes[kLanes];
  numbers.store(lanes);
  return lanes[hn::FindFirstTrue(FloatLanes(), left.m)];
}

// A shape that is another one in every lane (vm/skeleton.h): each is asked once, for the lanes that are it.
Batch any_shape(const Vec3<Batch>& p, const Batch* k, Batch which) {
  Batch result = which;
  float opcode = hn::GetLane(which.v);
  for (BatchMask left = which == which;;) {
    Batch value = which;
    switch (static_cast<Opcode>(opcode)) {
// clang-format off
#define OP_Point(Name, ...)
#define OP_Outline(Name, ...)
#define OP_Unary(Name, ...)
#define OP_Binary(Name, ...)
#define OP_Machine(Name, ...)
#define OP_Shape(Name, immediates, cost)                                           \
  case Opcode::Name:                                                               \
    if constexpr (can_be_any_shape(Opcode::Name, immediates, cost)) {              \
      value = Name##Op::apply(p, k, static_cast<const std::uint32_t*>(nullptr));   \
    }                                                                              \
    break;
#define OP(Name, mnemonic, form, immediates, choice, cost, meaning) OP_##form(Name, immediates, cost)
#include "vm/opcodes.def"
#include "vm/opcodes_end.def"
      // clang-format on
      default:
        break;
    }
    const BatchMask mine = which == Batch::broadcast(opcode);
    result = select(mine, value, result);
    left = left & !mine;
    if (!any(left)) return result;
    opcode = first_of(which, left);
  }
}

#if HWY_TARGET == HWY_SCALAR
HWY_INLINE void turn_quad(const float* const* from, std::size_t q, float* to) {
  std::copy_n(from[0] + q * kQuad, kQuad, to);
}
#else
// Quads of lanes first, first + 4, ..., side by side.
template <class D>
HWY_INLINE hn::Vec<D> load_quads(D d, const float* const* from, std::size_t first, std::size_t q) {
  if constexpr (hn::MaxLanes(D()) == kQuad) {
    return hn::LoadU(d, from[first] + q * kQuad);
  } else {
    const hn::Half<D> half;
    const auto low = load_quads(half, from, first, q);
    return hn::Combine(d, load_quads(half, from, first + hn::MaxLanes(half), q), low);
  }
}

// Loads quad `q` of every lane and turns it: to[0], to[kLanes] ... are its four floats, of all lanes.
HWY_INLINE void turn_quad(const float* const* from, std::size_t q, float* to) {
  const FloatLanes d;
  const hn::RepartitionToWide<FloatLanes> wide;
  const auto pairs = [&](auto v) HWY_ATTR { return hn::BitCast(wide, v); };
  const auto put = [&](auto v, std::size_t i) HWY_ATTR { hn::StoreU(hn::BitCast(d, v), d, to + i * kLanes); };
  const auto q0 = load_quads(d, from, 0, q), q1 = load_quads(d, from, 1, q);
  const auto q2 = load_quads(d, from, 2, q), q3 = load_quads(d, from, 3, q);
  const auto low01 = pairs(hn::InterleaveLower(d, q0, q1)), high01 = pairs(hn::InterleaveUpper(d, q0, q1));
  const auto low23 = pairs(hn::InterleaveLower(d, q2, q3)), high23 = pairs(hn::InterleaveUpper(d, q2, q3));
  put(hn::InterleaveLower(wide, low01, low23), 0), put(hn::InterleaveUpper(wide, low01, low23), 1);
  put(hn::InterleaveLower(wide, high01, high23), 2), put(hn::InterleaveUpper(wide, high01, high23), 3);
}

#endif

// A register of points, each with the program it is in.
class LanePrograms {
 public:
  LanePrograms(const std::uint32_t* pool, std::span<const SkeletonJob> jobs, Points points) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const SkeletonJob& job = jobs[std::min(lane, jobs.size() - 1)];  // lanes past the end repeat the last
      entry_[lane] = pool + job.at + 2;
      x_[lane] = points.x[job.point], y_[lane] = points.y[job.point], z_[lane] = points.z[job.point];
    }
  }
  Vec3<Batch> points() const { return {Batch::load(x_), Batch::load(y_), Batch::load(z_)}; }

  // Constants as the machine takes them, [constant][lane].
  void put_constants(const Skeleton& skeleton, const float* constants, float* to) const {
    const float* rows[kLanes];
    for (std::size_t place = 0; place < skeleton.quads.size(); ++place) {
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        rows[lane] = constants + std::size_t{entry_[lane][place]} * kQuad;
      }
      for (std::size_t q = 0; q < skeleton.quads[place]; ++q, to += kQuad * kLanes) turn_quad(rows, q, to);
    }
  }

 private:
  const std::uint32_t* entry_[kLanes];
  alignas(64) float x_[kLanes], y_[kLanes], z_[kLanes];
};

void skeleton_batch(const Skeleton& skeleton, const Constants& constants, const std::uint32_t* pool,
                    std::span<const SkeletonJob> jobs, Points points, float* distance, Workspace& workspace) {
  const std::size_t quads = std::accumulate(skeleton.quads.begin(), skeleton.quads.end(), std::size_t{0});
  Machine<Batch, Immediate::PerLane> machine(skeleton, workspace, 1, quads * kQuad * kLanes * sizeof(float));
  for (std::size_t first = 0; first < jobs.size(); first += kLanes) {
    const std::span<const SkeletonJob> some = jobs.subspan(first, std::min(kLanes, jobs.size() - first));
    const LanePrograms lanes(pool, some, points);
    lanes.put_constants(skeleton, constants.values(), machine.immediate_table());
    *machine.first_point() = lanes.points();
    machine.interpret();
    alignas(64) float values[kLanes];
    machine.result()->store(values);
    for (std::size_t lane = 0; lane < some.size(); ++lane) {
      distance[some[lane].point] = std::min(values[lane], some[lane].most);
    }
  }
}

}  // namespace fathom::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fathom::vm {

HWY_EXPORT(skeleton_batch);

void evaluate_skeleton(const Skeleton& skeleton, const Constants& constants, const std::uint32_t* pool,
                       std::span<const SkeletonJob> jobs, Points points, float* distance, Workspace& workspace) {
  HWY_DYNAMIC_DISPATCH(skeleton_batch)(skeleton, constants, pool, jobs, points, distance, workspace);
}

}  // namespace fathom::vm
#endif  // HWY_ONCE
