// The passes of a render: all samples at once, or in stages that depend on what those before have shown.
// Tested by: tests/runtime/render_test.cpp, film/adaptive_test.cpp
#pragma once

#include "runtime/film/partial_render.h"
#include "runtime/path/options.h"
#include "runtime/shared_picture.h"
#include "runtime/unit_worker.h"

namespace fathom::runtime {

class Passes {
 public:
  // Adds to `render`, which `picture` shows, what it lacks.
  Passes(const World& world, const RenderOptions& options, PartialRender& render, SharedPicture& picture)
      : world_(world), options_(options), render_(render), picture_(picture) {}

  // Until all samples are taken, those among `samples` where they are not shared out, or the options say stop; what
  // was counted, of all threads together. Once.
  Stats run(SampleRange samples);
  // Why run() came back.
  RenderEnd end() const;

 private:
  Stats run_adaptive();
  Stats run_round(std::uint32_t end);  // both halves of all open tiles, from the last judgement up to `end`
  Stats run_shares();                  // the samples that the halves have left
  Pass pass_of(std::size_t half) const;
  Stats run_pass(std::size_t stage, const Pass& pass, SampleRange samples, const SampleLimits& limits,
                 const Coverage& besides = {});

  const World& world_;
  const RenderOptions& options_;
  PartialRender& render_;
  SharedPicture& picture_;
};

}  // namespace fathom::runtime
