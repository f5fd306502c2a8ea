// A render under way or done: its film, and which samples are in it. What a checkpoint holds.
#pragma once

#include <cstdint>
#include <vector>

#include "runtime/base/coverage.h"
#include "runtime/film/film.h"
#include "runtime/film/noise.h"

namespace fathom::runtime {

struct PartialRender {
  Film film;
  std::vector<Coverage> covered;  // [stage of the film]; the samples counted from 0 in each
  NoiseState noise;               // of a render that stops where there is little
};

}  // namespace fathom::runtime
