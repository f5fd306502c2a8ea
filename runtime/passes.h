// The passes of a render: one pass for all samples, or with a noise threshold several passes, each of which depends
// on the results of the passes before.
// Tested by: tests/runtime/render_test.cpp, tests/runtime/film/adaptive_test.cpp
#pragma once

#include "runtime/film/partial_render.h"
#include "runtime/path/options.h"
#include "runtime/shared_film.h"
#include "runtime/unit_worker.h"

namespace fathom::runtime {

class Passes {
 public:
  // The passes add missing samples to `render`, the render of `shared_film`.
  Passes(const RenderContext& context, const RenderOptions& options, PartialRender& render, SharedFilm& shared_film)
      : context_(context), options_(options), render_(render), shared_film_(shared_film) {}

  // Renders until all samples are taken or the options say stop. Without a noise threshold, takes only samples in
  // `samples`. Returns the counts of all threads together. Call run() once.
  Stats run(SampleRange samples);
  // Returns the reason why run() ended.
  RenderEnd end() const;

 private:
  Stats run_adaptive();
  Stats run_round(std::uint32_t end);  // all open tiles, from the last convergence test up to `end`
  Stats run_allocation();              // the remaining samples of all tiles
  Stats run_pass(std::size_t stage, SampleRange samples, const SampleLimits& limits,
                 const Coverage& already_covered = {});

  const RenderContext& context_;
  const RenderOptions& options_;
  PartialRender& render_;
  SharedFilm& shared_film_;
};

}  // namespace fathom::runtime
