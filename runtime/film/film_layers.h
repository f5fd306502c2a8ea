// The layers of a film, as pictures.
// Tested by: tests/runtime/image/image_test.cpp
#pragma once

#include "runtime/film/film.h"
#include "runtime/image/image.h"

namespace fathom::runtime {

// Refers to the film.
LayerValues layer_of(const Film& film, Layer layer);

// In one step.
inline Picture layer_picture(const Film& film, Layer layer, ToneMapping tone = {}) {
  return to_picture(Shown(layer_of(film, layer), tone));
}

}  // namespace fathom::runtime
