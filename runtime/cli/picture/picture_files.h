// The files that pictures are written to: one, or one for each layer, for each -o.
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

struct PictureFiles {
  std::vector<Output> outputs;
  bool albedo = false, depth = false, normal = false, noisy = false;  // beside formats that hold one layer
  bool deep = false;  // 16 bits a sample, where the format may have them
};

// Every file that would be written; standard output is none.
std::vector<std::string> files_of(const PictureFiles& pictures);

// An ExitCode, after a message, when one of them cannot be written, as far as can be known before; or when 16 bits
// are asked for and a format has 8.
std::optional<ExitCode> check_paths(const PictureFiles& pictures, const Streams& streams);
std::optional<ExitCode> check_bits(const PictureFiles& pictures, const Streams& streams);

// The warning that "3 samples" overfilled a sum of the film.
std::string lost_text(std::string_view what);

// Writes everything; `lines` collects what was written. The reason when one cannot be written: those after it are
// not. `seconds` is the time the render took, for files that say so.
std::optional<std::string> write_pictures(const PictureFiles& pictures, const runtime::FilmHeader& header,
                                          const runtime::PartialRender& render, std::optional<double> seconds,
                                          std::vector<std::string>& lines, const Streams& streams);

}  // namespace fathom::cli
