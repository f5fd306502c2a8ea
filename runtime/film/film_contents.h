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

// The names and values of what renders must agree in; any order, but always the same.
using Identity = std::vector<std::pair<std::string, std::string>>;

struct FilmHeader {
  Identity identity;
  Attributes attributes;      // of the pictures that are made of it, but for those about how many samples it has
  int width = 0, height = 0;  // of the whole picture, pixels
  SampleRange samples;        // of each pixel, that the film is to have when it is done
  glm::dvec3 origin{0};       // of its positions in the scene, scene units
};

// What the film is, whether its sums were read or not.
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
