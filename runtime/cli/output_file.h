// Pictures as a verb writes them: their names on the command line, and that none takes the place of another file.
// Tested by: tests/runtime/cli_test.cpp
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/limits.h"
#include "runtime/cli/streams.h"
#include "runtime/cli/values.h"

namespace fathom::cli {

// A file name with the ending of a film or of a picture format; of one that holds what a display shows.
Verdict read_output(std::string_view text, std::string& path);
Verdict read_shown_output(std::string_view text, std::string& path);

// Whether the name is that of a film file (runtime/film_file.h).
bool is_film(const std::string& path);

// Whether the output holds all layers in one file, so that none is written beside it.
bool holds_layers(const std::string& output);

// "scenes/ball.json" -> "ball.png", in the current folder; "out.png" for standard input.
std::string default_output(const std::string& scene);

// "dir/ball.png", "albedo" -> "dir/ball-albedo.png"
std::string beside(const std::string& path, const std::string& suffix);

// Texts: of a file as a whole or not at all; devices and pipes are written to as they are.
bool is_special(const std::string& path);  // whether something other than a regular file has that name
// The reason why the text could not be written, as far as can be known before there is any.
std::optional<std::string> check_text_path(const std::string& path);
// The reason why it was not written; what was there before is as it was.
[[nodiscard]] std::optional<std::string> write_text(const std::string& text, const std::string& path);

// An ExitCode, after a message, when a picture of that size would be too large.
std::optional<ExitCode> check_picture_size(double width, double height, const compiler::Limits& limits,
                                           const Streams& streams);

// An ExitCode, after a message, when one of `outputs` is the scene's file or another output.
std::optional<ExitCode> check_collisions(const std::string& scene, const std::vector<std::string>& outputs,
                                         const Streams& streams);

}  // namespace fathom::cli
