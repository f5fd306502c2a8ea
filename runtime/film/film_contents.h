// A film file's contents in memory: its header, the shape of its film, and the render itself. film_file.h reads and
// writes them. Tested by: tests/runtime/film/film_file_test.cpp
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <string>
#include <utility>
#include <vector>

#include "runtime/base/coverage.h"
#include "runtime/base/pixel_rect.h"
#include "runtime/film/film.h"
#include "runtime/film/partial_render.h"
#include "runtime/image/float_image.h"

namespace fathom::runtime {

// Names and values in which all films of one render agree. Their order is arbitrary, but always the same.
using Identity = std::vector<std::pair<std::string, std::string>>;

struct FilmHeader {
  Identity identity;
  // Attributes of images made of the film, except attributes about the film's number of samples.
  Attributes attributes;
  int width = 0, height = 0;  // of the whole image, pixels
  SampleRange samples;        // range of each pixel's samples in the finished film
  glm::dvec3 origin{0};       // scene position of the film's zero, scene units
};

// Shape of a film, known even if the sums are not read.
struct FilmShape {
  PixelRect area;
  FilmLayers layers;
  std::size_t stages = 1;

  bool operator==(const FilmShape&) const = default;
};

struct FilmFile {
  FilmHeader header;
  FilmShape shape;
  PartialRender render;
};

}  // namespace fathom::runtime
