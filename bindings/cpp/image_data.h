// A rendered image of the library: the film, and how it is shown.
// Tested by: tests/bindings/library_render_test.cpp
#pragma once

#include <fathom/fathom.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "runtime/film/film.h"
#include "runtime/image/tone.h"

namespace fathom {

struct __attribute__((visibility("hidden"))) Image::Data {
  runtime::Film film;  // with the layers of Image::read()
  runtime::ToneMapping tone;
  glm::dvec3 origin{0};              // of the film's positions, in the scene
  std::vector<std::string> objects;  // names, for files that keep them
  bool complete = true;
};

}  // namespace fathom
