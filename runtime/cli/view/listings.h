// The texts about a scene that the viewer shows: those of `fathom dump` and `fathom check`.
// Tested by: tests/runtime/cli/view/cli_view_test.cpp
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "runtime/cli/view/viewed_scene.h"

namespace fathom::cli {

struct Listing {
  int status;  // of HTTP
  std::string text;
};

// Returns the listing of a kind: passes, graph, check, or run and region, which are about `point`, in scene
// coordinates. A listing that cannot be made says why.
Listing make_listing(const LoadedScene& loaded, std::string_view kind, std::optional<glm::dvec3> point);

}  // namespace fathom::cli
