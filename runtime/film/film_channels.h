// The channels an OpenEXR file of a render has, in one table; docs/reference/layers.md says what each is for.
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
  bool FilmLayers::*layer;  // that the film must keep for it; nullptr: none
  double (*value)(const PixelMeans& pixel);
};
std::span<const FilmChannel> film_channels();

// Over the samples that hit; not normalised, 0 where none did.
inline glm::dvec3 normal_of_hits(const PixelMeans& pixel) {
  return pixel.hits == 0 ? glm::dvec3(0) : pixel.normal * (static_cast<double>(pixel.samples) / pixel.hits);
}

// The channels of what the film keeps, of a picture of width x height pixels. Positions are of the scene, whose
// programs' zero lies at `origin`. Refers to the film.
ImageRows rows_of(const Film& film, int width, int height, glm::dvec3 origin, Attributes attributes);

}  // namespace fathom::runtime
