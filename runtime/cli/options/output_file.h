// Output files of a verb: their names on the command line, writing, and checks that they overwrite no other file.
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

// Destination and format of an image.
struct Output {
  std::string path;                                  // "-": standard output
  const runtime::ImageFormatInfo* format = nullptr;  // nullptr: a film (runtime/film/film_file.h)

  bool standard() const { return path == "-"; }
  bool folder() const { return path.ends_with('/'); }  // frames go into it, named by their numbers
  bool film() const { return format == nullptr; }
  // True if the file itself holds all layers, so that no layer needs a file of its own.
  bool layers() const { return film() || format->format == runtime::ImageFormat::Exr; }
};

// Reads a file name with the ending of a film or of an image format, or "-". The format of "-" is PNG unless
// apply_format() changes it. read_display_output() accepts only formats of displayable images.
OptionResult read_output(std::string_view text, Output& output);
OptionResult read_display_output(std::string_view text, Output& output);
// Also accepts a folder. The format of the files in it is PNG unless apply_format() changes it.
OptionResult read_frame_output(std::string_view text, Output& output);

// Reads a file name with the ending of an image format or of a map of numbers.
OptionResult read_map_name(std::string_view text, std::string& path);

// Adds the option --format, the format of -o - and of folders. `format` becomes an index into the format names, -1:
// not given.
void add_format_option(Arguments& arguments, bool display_only, int& format);

// Sets the format that --format names in the outputs that are standard output or folders. Prints a message and
// returns an exit code if there is no such output, if standard output is given twice, or if standard output is a
// terminal.
std::optional<ExitCode> apply_format(std::span<Output> outputs, int format, const Streams& streams);

// Lets `fill` write the output and commits it. Returns the problem, if any.
using Fill = std::function<std::optional<std::string>(runtime::AtomicFile& file)>;
std::optional<std::string> write_to(const Output& output, const Fill& fill, const Streams& streams);

// Returns "wrote out.png (640x360)" or "wrote png to standard output (640x360)".
std::string wrote(const Output& output, int width, int height);

// Derives the default output from the scene's name: "scenes/ball.json" -> "ball.png" in the current folder, "out.png"
// for standard input.
Output default_output(const std::string& scene);

// Returns "png", "exr", ... or "film".
std::string_view ending_of(const Output& output);

// Inserts a suffix before the ending: "dir/ball.png", "albedo" -> "dir/ball-albedo.png".
std::string with_suffix(const std::string& path, const std::string& suffix);

// Text outputs: a regular file is replaced atomically, devices and pipes are written to directly.
bool is_special(const std::string& path);  // true if `path` exists and is neither a regular file nor a folder
// Returns the problem that would prevent writing the text, as far as it can be detected in advance.
std::optional<std::string> check_text_path(const std::string& path);
// Writes the text. Returns the problem, if any, and then the previous file is unchanged.
[[nodiscard]] std::optional<std::string> write_text(const std::string& text, const std::string& path);
// Prints a message and returns an exit code if the text cannot be written there. "-", standard output, becomes nullopt.
std::optional<ExitCode> check_text_output(std::optional<std::string>& output, const Streams& streams);
// Writes the text to the file that -o names and says so, or to standard output without -o.
ExitCode write_text_output(const std::string& text, const std::optional<std::string>& output, const Streams& streams);

// Prints a message and returns an exit code if an image of this size exceeds the limits.
std::optional<ExitCode> check_image_size(double width, double height, const compiler::Limits& limits,
                                         const Streams& streams);

// Print a message and return an exit code if an output file is known in advance not to be writable, or if it would
// overwrite a file that the command has read or another output.
std::optional<ExitCode> check_output_files(const std::vector<std::string>& outputs, const Streams& streams);
std::optional<ExitCode> check_outputs(std::span<const Output> outputs, const Streams& streams);

// True if an output with all layers goes to standard output.
bool holds_whole(std::span<const Output> outputs);

// Returns the file names of the outputs, without standard output.
std::vector<std::string> paths_of(std::span<const Output> outputs);

// Prints a message and returns an exit code if one of `outputs` is a file that the command has read or another output.
// Files that the command reads later must not be among them either.
std::optional<ExitCode> claim_outputs(const std::vector<std::string>& outputs, const Streams& streams);

// Prints a message and returns an exit code if an output would overwrite a file that is read, or another output.
std::optional<ExitCode> check_files(const Streams& streams);

}  // namespace fathom::cli
