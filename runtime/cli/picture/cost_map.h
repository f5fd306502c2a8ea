// `fathom render --cost-map`: the cost of each pixel, as a coloured image or as plain numbers.
//
//     --cost-map cost.png     writes cost-evaluations.png and cost-instructions.png
//
// Values are means over the pixel's samples: field evaluations by all rays of a path, and instructions executed by
// the machine in them. Both are independent of the number of threads and the tile size.
// Tested by: tests/runtime/cli/picture/cli_profile_test.cpp
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runtime/film/film.h"

namespace fathom::cli {

struct CostMap {
  const char* name;  // of the file and of the counted quantity
  double runtime::PixelMeans::*value;
};
inline constexpr CostMap kCostMaps[] = {
    {"evaluations", &runtime::PixelMeans::evaluations},
    {"instructions", &runtime::PixelMeans::instructions},
};

// Returns a map's values, [y][x], of a film with the cost layer.
std::vector<float> cost_values(const runtime::Film& film, const CostMap& map);

// Returns the files written for the `path` of --cost-map.
std::vector<std::string> cost_map_files(const std::string& path);

// Writes the maps from a film with the cost layer. Returns the problem, if any. Appends one line per map to `lines`:
// its name, its size, and the meaning of its numbers or colours.
std::optional<std::string> write_cost_maps(const std::string& path, const runtime::Film& film,
                                           std::vector<std::string>& lines);

}  // namespace fathom::cli
