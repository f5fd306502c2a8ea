// The measurements as tables: one line a row, the names of the columns first, lines end with '\n'.
//
// Texts with a comma, a quote or a line's end are quoted (Y. Shafranovich, "Common Format and MIME Type for
// Comma-Separated Values (CSV) Files", RFC 4180, 2005). Numbers are the shortest that read back as the same double,
// with a point in every locale; what was not measured is `nan`, what the method has not (eps, steps_max) is 0.
// Tested by: tests/runtime/chart/chart_csv_test.cpp
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "runtime/chart/measurements.h"

namespace fathom::runtime {

// A field as it stands between commas.
std::string csv_field(std::string_view text);

std::string rays_csv(std::span<const RayMeasurement> rows, const Provenance& provenance);
std::string images_csv(std::span<const ImageMeasurement> rows, const Provenance& provenance);

}  // namespace fathom::runtime
