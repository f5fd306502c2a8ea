// Pictures as a verb writes them: their names on the command line, and that none takes the place of another file.
// Tested by: tests/runtime/cli/cli_test.cpp
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/source/limits.h"
#include "runtime/cli/options/arguments.h"
#include "runtime/cli/options/streams.h"
#include "runtime/cli/options/values.h"
#include "runtime/image/image_io.h"

namespace fathom::cli {

// Where a picture goes and in which format.
struct Output {
  std::string path;                                  // "-": standard output
  const runtime::ImageFormatInfo* format = nullptr;  // nullptr: a film (runtime/film/film_file.h)

  bool standard() const { return path == "-"; }
  bool folder() const { return path.ends_with('/'); }  // of pictures named by their frames
  bool film() const { return format == nullptr; }
  // Whether all layers are in one file, so that none is written beside it.
  bool layers() const { return film() || format->format == runtime::ImageFormat::Exr; }
};

// A file name with the ending of a film or of a picture format, or "-", which is a PNG until put_formats() says
// otherwise. read_shown_output() takes only formats that hold what a display shows.
Verdict read_output(std::string_view text, Output& output);
Verdict read_shown_output(std::string_view text, Output& output);
// Or a folder, of PNGs until put_formats() says otherwise.
Verdict read_frame_output(std::string_view text, Output& output);

// A file name with the ending of a picture format or of a map of numbers.
Verdict read_map_name(std::string_view text, std::string& path);

// The option --format, which says the format of -o - and of folders. `format` is an index into the names; -1: not
// given.
void add_format_option(Arguments& arguments, bool shown_only, int& format);

// Puts the format that --format said into the outputs that are standard output or a folder. An ExitCode, after a
// message, when there is none, when standard output is given twice, or when it is a terminal.
std::optional<ExitCode> put_formats(std::span<Output> outputs, int format, const Streams& streams);

// Has `fill` write the output and commit it. The reason when that cannot be done.
using Fill = std::function<std::optional<std::string>(runtime::AtomicFile& file)>;
std::optional<std::string> write_to(const Output& output, const Fill& fill, const Streams& streams);

// "wrote out.png (640x360)", "wrote png to standard output (640x360)".
std::string wrote(const Output& output, int width, int height);

// "scenes/ball.json" -> "ball.png", in the current folder; "out.png" for standard input.
Output default_output(const std::string& scene);

// "png", or "film".
std::string_view ending_of(const Output& output);

// "dir/ball.png", "albedo" -> "dir/ball-albedo.png"
std::string beside(const std::string& path, const std::string& suffix);

// Texts: of a file as a whole or not at all; devices and pipes are written to as they are.
bool is_special(const std::string& path);  // whether something other than a regular file has that name
// The reason why the text could not be written, as far as can be known before there is any.
std::optional<std::string> check_text_path(const std::string& path);
// The reason why it was not written; what was there before is as it was.
[[nodiscard]] std::optional<std::string> write_text(const std::string& text, const std::string& path);
// The text to the file that -o names, which is said, or to standard output where there is none.
ExitCode put_text(const std::string& text, const std::optional<std::string>& output, const Streams& streams);

// An ExitCode, after a message, when a picture of that size would be too large.
std::optional<ExitCode> check_picture_size(double width, double height, const compiler::Limits& limits,
                                           const Streams& streams);

// An ExitCode, after a message, when an output that is a file cannot be written, as far as can be known before, or
// would take the place of the file `read` or of another output.
std::optional<ExitCode> check_outputs(const std::string& read, std::span<const Output> outputs,
                                      const Streams& streams);

// Whether a file of all layers goes to standard output.
bool holds_whole(std::span<const Output> outputs);

// The outputs that are files, by name.
std::vector<std::string> paths_of(std::span<const Output> outputs);

// An ExitCode, after a message, when one of `outputs` is the scene's file or another output.
std::optional<ExitCode> check_collisions(const std::string& scene, const std::vector<std::string>& outputs,
                                         const Streams& streams);

}  // namespace fathom::cli
