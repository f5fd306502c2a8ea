// The layers of a film as images.
// Tested by: tests/runtime/image/image_test.cpp
#pragma once

#include "runtime/film/film.h"
#include "runtime/image/image.h"

namespace fathom::runtime {

// Returns the values of a layer, which refer to the film.
LayerValues layer_of(const Film& film, Layer layer);

// Converts a layer of the film to an image of 8 bits.
inline ByteImage layer_image(const Film& film, Layer layer, ToneMapping tone = {}) {
  return to_byte_image(DisplayImage(layer_of(film, layer), tone));
}

}  // namespace fathom::runtime
