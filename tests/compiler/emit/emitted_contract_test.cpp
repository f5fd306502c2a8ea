// A lane type with exactly the operations that the head of emitted C++ requires.
#include <cmath>
#include <string>

#include "hi.h"
#include "scene_c.h"
#include "showcase.h"
#include "tests/support/catch.h"
#include "tests/support/random/random_scene.h"
#include "tests/vm/number/float_bits.h"

namespace pairs {

template <class Float>
struct Pair {
  Float first, second;

  Pair(Float value) : first(value), second(value) {}
  Pair(Float a, Float b) : first(a), second(b) {}
};
struct Mask {
  bool first, second;
};

#define PAIR_OPERATOR(sign)                                   \
  template <class F>                                          \
  Pair<F> operator sign(const Pair<F>& a, const Pair<F>& b) { \
    return {a.first sign b.first, a.second sign b.second};    \
  }
PAIR_OPERATOR(+)
PAIR_OPERATOR(-)
PAIR_OPERATOR(*)
PAIR_OPERATOR(/)
#undef PAIR_OPERATOR
#define PAIR_FUNCTION(name, of)               \
  template <class F>                          \
  Pair<F> name(const Pair<F>& a) {            \
    return {F(of(a.first)), F(of(a.second))}; \
  }
PAIR_FUNCTION(operator-, -)
PAIR_FUNCTION(abs, std::fabs)
PAIR_FUNCTION(sqrt, std::sqrt)
PAIR_FUNCTION(floor, 0 + std::floor)
PAIR_FUNCTION(ceil, 0 + std::ceil)
PAIR_FUNCTION(round_nearest, 0 + std::nearbyint)
PAIR_FUNCTION(power_of_two, showcase::power_of_two)
PAIR_FUNCTION(mantissa, showcase::mantissa)
PAIR_FUNCTION(exponent, showcase::exponent)
#undef PAIR_FUNCTION

template <class F>
Mask operator<(const Pair<F>& a, const Pair<F>& b) {
  return {a.first < b.first, a.second < b.second};
}
template <class F>
Mask is_nan(const Pair<F>& a) {
  return {a.first != a.first, a.second != a.second};
}
bool any(Mask mask) { return mask.first || mask.second; }
template <class F>
Pair<F> select(Mask mask, const Pair<F>& yes, const Pair<F>& no) {
  return {mask.first ? yes.first : no.first, mask.second ? yes.second : no.second};
}
template <class F>
Pair<F> min(const Pair<F>& a, const Pair<F>& b) {
  return select(a < b, a, b);
}
template <class F>
Pair<F> max(const Pair<F>& a, const Pair<F>& b) {
  return select(b < a, a, b);
}

}  // namespace pairs

// Lanes of doubles must declare their scalar type.
template <>
struct showcase::lanes<pairs::Pair<double>> {
  using scalar = double;
  static pairs::Pair<double> broadcast(double value) { return value; }
};

namespace fathom::test::emitted_contract_test {

TEST_CASE("emitted C++ asks of a lane type what its head says", "[emit]") {
  Random random(3);
  std::size_t differing = 0;
  for (int i = 0; i < 500; ++i) {
    const glm::dvec3 p = random.in_box(1.5), q = random.in_box(1.5);
    const auto pair = [&](int axis) {
      return pairs::Pair<float>(static_cast<float>(p[axis]), static_cast<float>(q[axis]));
    };
    const auto count = [&](auto both, auto one) {
      differing +=
          bits_of(both(pair(0), pair(1), pair(2)).first) != bits_of(one(pair(0).first, pair(1).first, pair(2).first));
      differing += bits_of(both(pair(0), pair(1), pair(2)).second) !=
                   bits_of(one(pair(0).second, pair(1).second, pair(2).second));
    };
    using F = pairs::Pair<float>;
    count(showcase::distance<F>, showcase::distance<float>);
    count(scene_c::distance<F>, scene_c::distance<float>);
    count(hi::distance<F>, hi::distance<float>);
    const auto doubles = showcase::distance<pairs::Pair<double>>({p.x, q.x}, {p.y, q.y}, {p.z, q.z});
    differing +=
        doubles.first != showcase::distance(p.x, p.y, p.z) || doubles.second != showcase::distance(q.x, q.y, q.z);
  }
  CHECK(differing == 0);
}

}  // namespace fathom::test::emitted_contract_test
