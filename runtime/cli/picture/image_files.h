// The files of an image: for each -o one file, or one file per layer.
// Tested by: tests/runtime/cli/picture/cli_layers_test.cpp
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/cli/options/output_file.h"
#include "runtime/cli/options/streams.h"
#include "runtime/film/film_file.h"

namespace fathom::cli {

struct ImageFiles {
  std::vector<Output> outputs;
  // Layers written to files of their own, next to outputs whose format holds one layer.
  bool albedo = false, depth = false, normal = false, noisy = false;
  bool deep = false;  // 16 bits per channel in formats that support them
};

// Returns every file that would be written, without standard output.
std::vector<std::string> files_of(const ImageFiles& pictures);

// check_paths() prints a message and returns an exit code if a file is known in advance not to be writable.
// check_bits() does so if 16 bits are requested and a format has 8.
std::optional<ExitCode> check_paths(const ImageFiles& pictures, const Streams& streams);
std::optional<ExitCode> check_bits(const ImageFiles& pictures, const Streams& streams);

// Returns the warning that `what`, such as "3 samples", overflowed a sum of the film.
std::string overflow_text(std::string_view what);

// Writes all files and appends a line for each to `lines`. Returns the first problem, after which no further file is
// written. `seconds` is the render time, for formats that store it.
std::optional<std::string> write_image_files(const ImageFiles& pictures, const runtime::FilmHeader& header,
                                             const runtime::PartialRender& render, std::optional<double> seconds,
                                             std::vector<std::string>& lines, const Streams& streams);

}  // namespace fathom::cli
