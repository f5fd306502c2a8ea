// Methods of following rays through the field: the renderer's own, and baseline methods to compare it with.
//
// `tiered` is the renderer's own method (march.h). The methods with `uses_epsilon` report a hit where the field falls
// below `epsilon`, and give up a ray, as a miss, after `steps` evaluations. The methods except `tiered` exist for
// charts and tests.
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
  bool uses_epsilon;  // the method uses Marching's `epsilon` and `steps`
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
  Precision precision = Precision::Single;  // Certified always runs in double
  double epsilon = 1e-4;                    // scene units; smaller values of the field are hits
  int steps = 512;                          // maximum number of evaluations per ray
  double relaxation = 1.6;                  // Relaxed: length of a step in safe radii, in [1, 2)
};

}  // namespace fathom::runtime
