// Runs the interpreter over many points: divides the points into blocks, loads their coordinates and stores the
// results.
#if defined(FATHOM_VM_BLOCKS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef FATHOM_VM_BLOCKS_INL
#undef FATHOM_VM_BLOCKS_INL
#else
#define FATHOM_VM_BLOCKS_INL
#endif

#include <algorithm>
#include <cstddef>

#include "vm/interpret/interpret-inl.h"
#include "vm/interpret/points.h"

HWY_BEFORE_NAMESPACE();
namespace fathom::vm::HWY_NAMESPACE {

template <class N>
HWY_INLINE void set_point(Vec3<N>& p, N x, N y, N z) {
  p = {x, y, z};
}
template <class N>
HWY_INLINE void set_point(Vec3<Dual<N>>& p, N x, N y, N z) {
  const N zero = N::broadcast(0.0), one = N::broadcast(1.0);
  p = {{x, one, zero, zero}, {y, zero, one, zero}, {z, zero, zero, one}};
}

// Runs the program on each block of points and calls body(first point, number of points, number of registers,
// results). Lanes past the end repeat the last point. S: type of a coordinate.
template <class T, class S, class Body>
HWY_INLINE void for_each_block(const Code& program, const PointsOf<S>& points, std::size_t count,
                               Workspace& workspace, const Body& body) {
  constexpr std::size_t kWidth = kLanesOf<S>, kBlockPoints = kSlot<T> * kWidth;
  for (std::size_t begin = 0; begin < count; begin += kBlockPoints) {
    const std::size_t size = std::min(kBlockPoints, count - begin);
    const std::size_t used = (size + kWidth - 1) / kWidth;
    Interpreter<T> machine(program, workspace, used);
    auto* p = machine.first_point();
    for (std::size_t i = 0; i < used; ++i) {
      const std::size_t at = begin + i * kWidth;
      alignas(64) S padded[3][kWidth];
      const S* x = points.x + at;
      const S* y = points.y + at;
      const S* z = points.z + at;
      if (at + kWidth > count) {
        for (std::size_t lane = 0; lane < kWidth; ++lane) {
          const std::size_t from = std::min(lane, count - 1 - at);
          padded[0][lane] = x[from], padded[1][lane] = y[from], padded[2][lane] = z[from];
        }
        x = padded[0], y = padded[1], z = padded[2];
      }
      set_point(p[i], BatchOf<S>::load(x), BatchOf<S>::load(y), BatchOf<S>::load(z));
    }
    machine.interpret();
    body(begin, size, used, machine.result());
  }
}

// Stores the first `size` lanes of the registers value(0) to value(used - 1).
template <class S, class Value>
HWY_INLINE void store(std::size_t size, std::size_t used, S* to, const Value& value) {
  constexpr std::size_t kWidth = kLanesOf<S>;
  for (std::size_t i = 0; i < used; ++i) {
    const std::size_t at = i * kWidth;
    if (kWidth == 1 || at + kWidth <= size) {  // one lane is always whole: g++ 14 warns of its copy below
      value(i).store(to + at);
    } else {
      alignas(64) S padded[kWidth];
      value(i).store(padded);
      std::copy_n(padded, size - at, to + at);
    }
  }
}

}  // namespace fathom::vm::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
