// A render under way or done: its film, and which samples are in it. What a checkpoint holds.
#pragma once

#include <cstdint>
#include <vector>

#include "runtime/base/coverage.h"
#include "runtime/film/adaptive.h"
#include "runtime/film/film.h"

namespace fathom::runtime {

struct PartialRender {
  Film film;
  std::vector<Coverage> covered;  // [stage of the film]; the samples counted from 0 in each
  AdaptiveState adaptive;         // no tiles if all pixels take the same number of samples
};

}  // namespace fathom::runtime
