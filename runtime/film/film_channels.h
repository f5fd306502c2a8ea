// Table of the channels of a render's OpenEXR files. docs/reference/layers.md describes each channel.
// Tested by: tests/runtime/image/image_exr_test.cpp
#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <string_view>

#include "runtime/film/film.h"
#include "runtime/image/float_image.h"

namespace fathom::runtime {

struct FilmChannel {
  std::string_view name;
  bool whole;
  bool FilmLayers::*layer;  // layer that the channel needs; nullptr: the channel is always there
  double (*value)(const PixelMeans& pixel);
};
std::span<const FilmChannel> film_channels();

// Returns the mean normal over the samples that hit, not normalised; 0 when no sample hit.
inline glm::dvec3 normal_of_hits(const PixelMeans& pixel) {
  return pixel.hits == 0 ? glm::dvec3(0) : pixel.normal * (static_cast<double>(pixel.samples) / pixel.hits);
}

// Returns the channels whose layers the film keeps, in an image of width x height pixels. `origin` is the scene
// position of the programs' zero, and is added to positions. The result refers to the film.
ImageRows rows_of(const Film& film, int width, int height, glm::dvec3 origin, Attributes attributes);

}  // namespace fathom::runtime
