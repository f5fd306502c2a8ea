// Writes the measurements as CSV tables: column names first, one line per row, lines end with '\n'.
//
// Texts with a comma, a quote or a line end are quoted (Y. Shafranovich, "Common Format and MIME Type for
// Comma-Separated Values (CSV) Files", RFC 4180, 2005). Numbers are the shortest decimals that read back as the same
// double, with a decimal point in every locale. A value that was not measured is `nan`. A parameter that the method
// does not have (eps, steps_max) is 0.
// Tested by: tests/runtime/chart/chart_csv_test.cpp
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "runtime/chart/measurements.h"

namespace fathom::runtime {

// Returns the text as a CSV field, quoted if necessary.
std::string csv_field(std::string_view text);

std::string rays_csv(std::span<const RayMeasurement> rows, const Provenance& provenance);
std::string images_csv(std::span<const ImageMeasurement> rows, const Provenance& provenance);

}  // namespace fathom::runtime
