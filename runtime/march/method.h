// How rays meet the field: the renderer's own way, and the ways of others, to compare it with.
//
// `tiered` is what every picture is made with (march.h). The others say "hit" where the field falls below `epsilon`
// and give a ray up, as a miss, after `steps` evaluations; they exist to be charted and tested.
// Tested by: tests/runtime/march/method_test.cpp
#pragma once

#include <string_view>

namespace fathom::runtime {

enum class Method { Tiered, Sphere, Relaxed, Automatic, Certified };
enum class Precision { Single, Double };

struct MethodInfo {
  Method method;
  std::string_view name;  // on the command line and in charts
  std::string_view summary;
  bool uses_epsilon;  // and `steps`
};

inline constexpr MethodInfo kMethods[] = {
    {Method::Tiered, "tiered", "float steps, brackets at changes of sign, double where float cannot decide", false},
    {Method::Sphere, "sphere", "sphere tracing (Hart 1996): steps of the safe radius until it is below epsilon",
     true},
    {Method::Relaxed, "relaxed", "over-relaxation (Keinert 2014): steps of a fixed multiple of the safe radius",
     true},
    {Method::Automatic, "automatic", "automatic relaxation (Ban and Valasek 2023): multiples from the slope", true},
    {Method::Certified, "certified", "certified search in double for every ray: the reference", false},
};

constexpr const MethodInfo& info(Method method) { return kMethods[static_cast<int>(method)]; }

struct Marching {
  Method method = Method::Tiered;
  Precision precision = Precision::Single;  // Certified is always in double
  double epsilon = 1e-4;                    // scene units; what counts as a hit
  int steps = 512;                          // evaluations before a ray is given up
  double relaxation = 1.6;                  // of Relaxed: steps are this many safe radii, in [1, 2)
};

}  // namespace fathom::runtime
