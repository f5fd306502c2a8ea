// Fixed text of every emitted C++ header, around the scene's own functions: the requirements on lane types, and the
// definitions with which float and double meet them. The texts are fmt patterns.
#pragma once

#include <string_view>

namespace fathom::compiler {

// {0}: the scene, {1}: namespace, {2}: name of the include guard.
inline constexpr std::string_view kCppHead = R"(// {0}
//
//     T {1}::distance(T x, T y, T z)
//
// The signed distance of the place (x, y, z), in the units of the scene. T is float, double, or as many of either as a
// register holds. C++17; with -ffp-contract=off and without -ffast-math float gives the bits that fathom computes with.
//
// A lane type supplies, found by its namespace:
//
//     + - * /  unary -  abs  sqrt
//     a < b, a mask                        any(mask), a bool;  select(mask, yes, no)
//     min(a, b), a < b ? a : b             max(a, b), a > b ? a : b
//     floor  ceil  round_nearest           to the nearest even; no result is -0
//
// and for scenes with elementary functions or fractals also
//
//     is_nan(a), a mask                    power_of_two(n), 2^n for a whole n of a normal number's exponent
//     mantissa(x), exponent(x)             x = mantissa 2^exponent, the mantissa in [sqrt 1/2, sqrt 2), for x > 0
//
// and is made of one float by T::broadcast(value) or T(value). For lanes of doubles specialise `lanes`.
//
// All functions are inlined: large scenes take long to compile. Define FATHOM_SCENE_INLINE as inline to leave that to
// the compiler. To compile for several instruction sets in one program, include <cmath>, <cstdint>, <cstring> and
// <limits>, then this file within a namespace and the target attributes of each, and undefine the guard between them.
#ifndef {2}
#define {2}

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#ifndef FATHOM_SCENE_INLINE
#if defined(__GNUC__)
#define FATHOM_SCENE_INLINE inline __attribute__((always_inline))
#elif defined(_MSC_VER)
#define FATHOM_SCENE_INLINE __forceinline
#else
#define FATHOM_SCENE_INLINE inline
#endif
#endif

)";

// Not a pattern.
inline constexpr std::string_view kCppPrimitives = R"(// The numbers in a T, and how it is made of one.
template <class T>
struct lanes {
  using scalar = float;
  static FATHOM_SCENE_INLINE T broadcast(float value) { return make<T>(value, 0); }

 private:
  template <class U>
  static FATHOM_SCENE_INLINE auto make(float value, int) -> decltype(U::broadcast(value)) {
    return U::broadcast(value);
  }
  template <class U>
  static FATHOM_SCENE_INLINE U make(float value, long) {
    return U(value);
  }
};
template <>
struct lanes<double> {
  using scalar = double;
  static FATHOM_SCENE_INLINE double broadcast(double value) { return value; }
};

namespace bits {

// x = mantissa 2^exponent. Bits: as wide as Float; kShift: where its exponent begins; kHalf: the bits of sqrt 1/2.
template <class Float>
struct format;
template <>
struct format<float> {
  using Bits = std::uint32_t;
  using Signed = std::int32_t;
  static constexpr int kShift = 23, kBias = 127;
  static constexpr Bits kHalf = 0x3f3504f3;
};
template <>
struct format<double> {
  using Bits = std::uint64_t;
  using Signed = std::int64_t;
  static constexpr int kShift = 52, kBias = 1023;
  static constexpr Bits kHalf = 0x3fe6a09e667f3bcd;
};

template <class To, class From>
FATHOM_SCENE_INLINE To bit_cast(From from) {
  To to;
  std::memcpy(&to, &from, sizeof to);
  return to;
}
template <class Float>
FATHOM_SCENE_INLINE Float power_of_two(Float n) {
  using F = format<Float>;
  const auto whole = static_cast<typename F::Signed>(n == n ? n : Float(0));
  return bit_cast<Float>(static_cast<typename F::Bits>(whole + F::kBias) << F::kShift);
}
// Subnormal numbers are made normal first.
template <class Float>
FATHOM_SCENE_INLINE bool is_subnormal(Float x) {
  return x < std::numeric_limits<Float>::min();
}
template <class Float>
FATHOM_SCENE_INLINE typename format<Float>::Bits normal_bits(Float x) {
  const Float scale = power_of_two<Float>(Float(format<Float>::kShift + 1));
  return bit_cast<typename format<Float>::Bits>(is_subnormal(x) ? x * scale : x);
}
template <class Float>
FATHOM_SCENE_INLINE typename format<Float>::Signed whole_exponent(Float x) {
  using F = format<Float>;
  return static_cast<typename F::Signed>(normal_bits(x) - F::kHalf) >> F::kShift;
}
template <class Float>
FATHOM_SCENE_INLINE Float mantissa(Float x) {
  using F = format<Float>;
  return bit_cast<Float>(normal_bits(x) - (static_cast<typename F::Bits>(whole_exponent(x)) << F::kShift));
}
template <class Float>
FATHOM_SCENE_INLINE Float exponent(Float x) {
  const auto e = whole_exponent(x);
  return static_cast<Float>(is_subnormal(x) ? e - (format<Float>::kShift + 1) : e);
}

}  // namespace bits

FATHOM_SCENE_INLINE bool any(bool mask) { return mask; }
)";

// {0}: float or double. Adding 0 turns -0 into 0.
inline constexpr std::string_view kCppScalar = R"(FATHOM_SCENE_INLINE bool is_nan({0} a) {{ return a != a; }}
FATHOM_SCENE_INLINE {0} select(bool mask, {0} yes, {0} no) {{ return mask ? yes : no; }}
FATHOM_SCENE_INLINE {0} min({0} a, {0} b) {{ return a < b ? a : b; }}
FATHOM_SCENE_INLINE {0} max({0} a, {0} b) {{ return a > b ? a : b; }}
FATHOM_SCENE_INLINE {0} abs({0} a) {{ return std::fabs(a); }}
FATHOM_SCENE_INLINE {0} sqrt({0} a) {{ return std::sqrt(a); }}
FATHOM_SCENE_INLINE {0} floor({0} a) {{ return std::floor(a) + {0}(0); }}
FATHOM_SCENE_INLINE {0} ceil({0} a) {{ return std::ceil(a) + {0}(0); }}
FATHOM_SCENE_INLINE {0} round_nearest({0} a) {{ return std::nearbyint(a) + {0}(0); }}
FATHOM_SCENE_INLINE {0} power_of_two({0} n) {{ return bits::power_of_two(n); }}
FATHOM_SCENE_INLINE {0} mantissa({0} x) {{ return bits::mantissa(x); }}
FATHOM_SCENE_INLINE {0} exponent({0} x) {{ return bits::exponent(x); }}
)";

// Not a pattern.
inline constexpr std::string_view kCppOpen = R"(
template <class T>
struct Scene {
struct vec3 {
  T x, y, z;
};
using scalar = typename lanes<T>::scalar;
static constexpr bool kDouble = sizeof(scalar) == sizeof(double);
static constexpr double kInfinity = std::numeric_limits<double>::infinity();
static FATHOM_SCENE_INLINE T number(double value) { return lanes<T>::broadcast(static_cast<scalar>(value)); }

)";

}  // namespace fathom::compiler
