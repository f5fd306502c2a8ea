// A render in progress or finished, as a checkpoint stores it: its film, and the samples that are in the film.
#pragma once

#include <cstdint>
#include <vector>

#include "runtime/base/coverage.h"
#include "runtime/film/adaptive.h"
#include "runtime/film/film.h"

namespace fathom::runtime {

struct PartialRender {
  Film film;
  std::vector<Coverage> covered;  // [stage of the film]; each stage counts its samples from 0
  AdaptiveState adaptive;         // no tiles if all pixels take the same number of samples
};

}  // namespace fathom::runtime
