// The evaluator of templates. FATHOM_TARGET as in vm/interpret/evaluate.cpp.
#include <algorithm>
#include <numeric>

#include "vm/prune/program_template.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vm/prune/evaluate_template.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::vm::HWY_NAMESPACE {
void skeleton_batch(const ProgramTemplate& program_template, const Constants& constants, const std::uint32_t* pool,
                    std::span<const TemplateJob> jobs, float* distance, Workspace& workspace);
void row_batch(const ProgramTemplate& program_template, const Points& points, std::size_t count,
               const float* constants, float* distance, Workspace& workspace);
}  // namespace fathom::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_TARGET == FATHOM_TARGET
#include "vm/interpret/interpret-inl.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::vm::HWY_NAMESPACE {

// Returns the number in the first lane of `left`.
HWY_INLINE float first_of(Batch numbers, BatchMask left) {
  alignas(64) float lanes[kLanes];
  numbers.store(lanes);
  return lanes[hn::FindFirstTrue(FloatLanes(), left.m)];
}

// Evaluates a shape that differs per lane (vm/prune/program_template.h): each opcode once, for the lanes that have the
// opcode.
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
#define OP_Ternary(Name, ...)
#define OP_Machine(Name, ...)
#define OP_Shape(Name, immediates, cost)                                           \
  case Opcode::Name:                                                               \
    if constexpr (can_be_polymorphic(immediates, cost)) {                            \
      value = Name##Op::apply(p, k, static_cast<const std::uint32_t*>(nullptr));   \
    }                                                                              \
    break;
#define OP(Name, mnemonic, form, immediates, choice, cost, ...) OP_##form(Name, immediates, cost)
#include "vm/program/opcodes.def"
#include "vm/program/opcodes_end.def"
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

// Transposes rows of floats, one row per lane: copies the kQuad floats of row(lane) from q * kQuad on to
// to[float][lane].
#if HWY_TARGET == HWY_SCALAR
template <class Row>
HWY_INLINE void turn_quad(const Row& row, std::size_t q, float* to) {
  std::copy_n(row(0) + q * kQuad, kQuad, to);
}
#else
// Transposes four registers as 4x4 matrices, one matrix per 128-bit block.
HWY_INLINE void turn_blocks(hn::Vec<FloatLanes> (&v)[kQuad]) {
  const FloatLanes d;
  const hn::RepartitionToWide<FloatLanes> doubles;
  const auto pairs = [&](auto a) HWY_ATTR { return hn::BitCast(doubles, a); };
  const auto low01 = pairs(hn::InterleaveLower(d, v[0], v[1])), high01 = pairs(hn::InterleaveUpper(d, v[0], v[1]));
  const auto low23 = pairs(hn::InterleaveLower(d, v[2], v[3])), high23 = pairs(hn::InterleaveUpper(d, v[2], v[3]));
  v[0] = hn::BitCast(d, hn::InterleaveLower(doubles, low01, low23));
  v[1] = hn::BitCast(d, hn::InterleaveUpper(doubles, low01, low23));
  v[2] = hn::BitCast(d, hn::InterleaveLower(doubles, high01, high23));
  v[3] = hn::BitCast(d, hn::InterleaveUpper(doubles, high01, high23));
}

// Loads `length` floats from quad q on of each of the lanes first, first + stride, ..., side by side into one
// register.
template <std::size_t length, class D, class Row>
HWY_INLINE hn::Vec<D> load_rows(D d, const Row& row, std::size_t first, std::size_t stride, std::size_t q) {
  if constexpr (hn::MaxLanes(D()) == length) {
    return hn::LoadU(d, row(first) + q * kQuad);
  } else {
    const hn::Half<D> half;
    const std::size_t second = first + stride * (hn::MaxLanes(half) / length);
    return hn::Combine(d, load_rows<length>(half, row, second, stride, q),
                       load_rows<length>(half, row, first, stride, q));
  }
}

template <class Row>
HWY_INLINE void turn_quad(const Row& row, std::size_t q, float* to) {
  const FloatLanes d;
  hn::Vec<FloatLanes> v[kQuad];
  for (std::size_t i = 0; i < kQuad; ++i) v[i] = load_rows<kQuad>(d, row, i, kQuad, q);
  turn_blocks(v);
  for (std::size_t i = 0; i < kQuad; ++i) hn::Store(v[i], d, to + i * kLanes);
}

// Transposes quads q and q + 1, which together take fewer loads.
template <class Row>
HWY_INLINE void turn_two_quads(const Row& row, std::size_t q, float* to) {
  const FloatLanes d;
  // a and b hold alternate groups of four lanes. Their 128-bit blocks alternate between quads q and q + 1.
  hn::Vec<FloatLanes> a[kQuad], b[kQuad];
  for (std::size_t i = 0; i < kQuad; ++i) {
    a[i] = load_rows<2 * kQuad>(d, row, i, 2 * kQuad, q);
    b[i] = load_rows<2 * kQuad>(d, row, i + kQuad, 2 * kQuad, q);
  }
  turn_blocks(a), turn_blocks(b);
  for (std::size_t i = 0; i < kQuad; ++i) {
    hn::Store(hn::OddEvenBlocks(hn::SwapAdjacentBlocks(b[i]), a[i]), d, to + i * kLanes);
    hn::Store(hn::OddEvenBlocks(b[i], hn::SwapAdjacentBlocks(a[i])), d, to + (kQuad + i) * kLanes);
  }
}
#endif

// One register of points, each with the constants of its own program.
class LanePrograms {
 public:
  HWY_INLINE LanePrograms(std::span<const TemplateJob> jobs)
      : jobs_(jobs.data()), count_(std::min(jobs.size(), kLanes)) {
    if (count_ == kLanes) return;
    std::copy_n(jobs_, count_, some_);
    std::fill(some_ + count_, some_ + kLanes, some_[count_ - 1]);  // lanes past the end repeat the last job
    jobs_ = some_;
  }

  HWY_INLINE Vec3<Batch> points() {
    turn_quad([this](std::size_t lane) HWY_ATTR { return &jobs_[lane].x; }, 0, rows_);
    return {Batch::load(rows_), Batch::load(rows_ + kLanes), Batch::load(rows_ + 2 * kLanes)};
  }

  // Writes the constants in the order in which the interpreter reads them, [constant][lane].
  HWY_INLINE void put_constants(const ProgramTemplate& program_template, const float* constants,
                                const std::uint32_t* pool, float* to) const {
    for (std::size_t place = 0; place < program_template.quads.size(); ++place) {
      const std::uint32_t* const places = pool + 2 + place;
      const auto row = [&](std::size_t lane)
                           HWY_ATTR { return constants + std::size_t{places[jobs_[lane].at]} * kQuad; };
      std::size_t q = 0;
#if HWY_TARGET != HWY_SCALAR
      if constexpr (kLanes > kQuad) {
        for (; q + 2 <= program_template.quads[place]; q += 2, to += 2 * kQuad * kLanes) turn_two_quads(row, q, to);
      }
#endif
      for (; q < program_template.quads[place]; ++q, to += kQuad * kLanes) turn_quad(row, q, to);
    }
  }

  // Writes the distances, limited to each job's `most`. Call after points(), which loads the limits.
  HWY_INLINE void put_distances(Batch values, float* distance) {
    // A NaN distance stays NaN, because min() returns its second operand then.
    min(Batch::load(rows_ + 3 * kLanes), values).store(rows_);
    for (std::size_t lane = 0; lane < count_; ++lane) distance[jobs_[lane].point] = rows_[lane];
  }

 private:
  const TemplateJob* jobs_;
  std::size_t count_;
  TemplateJob some_[kLanes];
  alignas(64) float rows_[kQuad * kLanes];  // x, y, z, most
};

void skeleton_batch(const ProgramTemplate& program_template, const Constants& constants, const std::uint32_t* pool,
                    std::span<const TemplateJob> jobs, float* distance, Workspace& workspace) {
  const std::size_t quads =
      std::accumulate(program_template.quads.begin(), program_template.quads.end(), std::size_t{0});
  Interpreter<Batch, Immediate::PerLane> machine(program_template, workspace, 1,
                                                 quads * kQuad * kLanes * sizeof(float));
  for (std::size_t first = 0; first < jobs.size(); first += kLanes) {
    LanePrograms lanes(jobs.subspan(first));
    lanes.put_constants(program_template, constants.values(), pool, machine.immediate_table());
    *machine.first_point() = lanes.points();
    machine.interpret();
    lanes.put_distances(*machine.result(), distance);
  }
}

void row_batch(const ProgramTemplate& program_template, const Points& points, std::size_t count,
               const float* constants, float* distance, Workspace& workspace) {
  Interpreter<Batch, Immediate::PerLane> machine(program_template, workspace, 1);
  for (std::size_t first = 0; first < count; first += kLanes) {
    machine.read_immediates(constants + first, kRowStride);
    *machine.first_point() = {Batch::load(points.x + first), Batch::load(points.y + first),
                              Batch::load(points.z + first)};
    machine.interpret();
    machine.result()->store(distance + first);
  }
}

}  // namespace fathom::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif

#if HWY_ONCE && FATHOM_TARGET == 0
namespace fathom::vm {

HWY_EXPORT(skeleton_batch);
HWY_EXPORT(row_batch);

void evaluate_template(const ProgramTemplate& program_template, const Constants& constants, const std::uint32_t* pool,
                       std::span<const TemplateJob> jobs, float* distance, Workspace& workspace) {
  HWY_DYNAMIC_DISPATCH(skeleton_batch)(program_template, constants, pool, jobs, distance, workspace);
}

void evaluate_rows(const ProgramTemplate& program_template, Points points, std::size_t count, const float* constants,
                   float* distance, Workspace& workspace) {
  HWY_DYNAMIC_DISPATCH(row_batch)(program_template, points, count, constants, distance, workspace);
}

}  // namespace fathom::vm
#endif
