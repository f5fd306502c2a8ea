// `fathom render --cost-map`: what each pixel cost, as a coloured picture or as plain numbers.
//
//     --cost-map cost.png     writes cost-evaluations.png and cost-instructions.png
//
// Values are means over the pixel's samples: evaluations of the field by all rays of a path, and the instructions the
// machine ran in them. Both are the same for any number of threads and tile size. Tested by:
// tests/runtime/cli/picture/cli_profile_test.cpp
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runtime/film/film.h"

namespace fathom::cli {

// The files for a `path` that was asked for.
std::vector<std::string> cost_map_files(const std::string& path);

// Writes them from a film that keeps the cost; the reason when it cannot be done. `lines` collects what is said of
// each: its name, size, and what its numbers or colours mean.
std::optional<std::string> write_cost_maps(const std::string& path, const runtime::Film& film,
                                           std::vector<std::string>& lines);

}  // namespace fathom::cli
