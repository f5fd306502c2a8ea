// Helpers for the rows of the catalogue: plain sphere tracing, to show that each row catches its errors, and the
// compiler's diagnostics.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <type_traits>
#include <vector>

#include "compiler/compile.h"
#include "tests/runtime/rays.h"
#include "tests/runtime/scenes.h"
#include "vm/interpret/evaluate.h"

namespace fathom::catalogue {

using namespace runtime;

// Sphere tracing as most programs implement it (Hart, "Sphere Tracing", 1996): a distance below `eps` is a hit.
struct Naive {
  double eps = 1e-4;  // scene units
  int max_steps = 1000;
  double t_max = 100;  // scene units
};

struct NaiveHit {
  enum class Status { Hit, Miss, Exhausted };
  Status status;
  double t;
};

// Traces a ray entirely in the precision of Number, float or double.
template <class Number = float>
NaiveHit trace_naively(const vm::VerifiedProgram& program, const Ray& ray, const Naive& rule,
                       vm::Workspace& workspace) {
  using Vector = glm::vec<3, Number>;
  const Vector origin(ray.origin), direction(ray.direction);
  Number t = 0;
  for (int i = 0; i < rule.max_steps; ++i) {
    const Vector p = origin + t * direction;
    Number d;
    if constexpr (std::is_same_v<Number, float>) {
      vm::evaluate_distance(program, {&p.x, &p.y, &p.z}, 1, &d, workspace);
    } else {
      d = vm::evaluate_distance(program, p, workspace);
    }
    if (d <= static_cast<Number>(rule.eps)) return {NaiveHit::Status::Hit, static_cast<double>(t)};
    t += d;
    if (!(static_cast<double>(t) < rule.t_max)) return {NaiveHit::Status::Miss, 0};
  }
  return {NaiveHit::Status::Exhausted, 0};
}

// Judges naive tracing. A ray that ran out of steps counts only as exhausted, because no program knows whether it
// hits.
template <class Number = float>
Judgement judge_naive(const compiler::CompiledScene& scene, const std::vector<Ray>& rays, const Truth& truth,
                      const Naive& rule) {
  Judgement judgement;
  vm::Workspace workspace;
  for (const Ray& ray : rays) {
    const NaiveHit ray_hit = trace_naively<Number>(scene.distance, ray, rule, workspace);
    if (ray_hit.status == NaiveHit::Status::Exhausted) {
      ++judgement.rays;
      ++judgement.exhausted;
    } else {
      judgement.note(ray_hit.status == NaiveHit::Status::Hit, ray_hit.t, truth(ray));
    }
  }
  std::sort(judgement.errors.begin(), judgement.errors.end());
  return judgement;
}

inline double share(int part, const Judgement& of) { return static_cast<double>(part) / of.rays; }

// Codes of the compiler's diagnostics for a scene of these objects: "E0301 W0506" and so on, in source order.
inline std::string codes_of(const std::string& objects, bool lint = false) {
  compiler::Diagnostics diagnostics;
  compiler::CompileOptions options;
  options.lint = lint;
  const std::string scene = R"({"version": 1, "background": [1, 1, 1], "objects": [)" + objects + "]}";
  compile(compiler::Source("test.json", scene), diagnostics, options);
  std::string codes;
  for (const compiler::Diagnostic& diagnostic : diagnostics.all()) {
    codes += (codes.empty() ? "" : " ") + diagnostic.code;
  }
  return codes;
}

}  // namespace fathom::catalogue
