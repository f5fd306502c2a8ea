#include "runtime/cli/input/text_file.h"

#include <fmt/format.h>

#include "runtime/load/files.h"

namespace fathom::cli {

std::variant<std::string, ReadError> read_text(const std::string& path, const compiler::Limits& limits,
                                               const Streams& streams) {
  if (path != "-") streams.files.add_input(path);
  if (streams.files.conflict()) {
    return ReadError{"it would be overwritten by an output", "give each output a name of its own", kUsage};
  }
  auto text = path == "-" ? runtime::read_stream(streams.in, limits) : runtime::read_file(path, limits);
  if (auto* fault = std::get_if<runtime::FileFault>(&text)) {
    return ReadError{std::move(fault->reason), std::move(fault->remedy), fault->too_large ? kBadScene : kIo};
  }
  return std::get<std::string>(std::move(text));
}

ExitCode fail(const Streams& streams, const std::string& path, const ReadError& read_error) {
  return fail(streams, read_error.code, fmt::format("cannot read {}: {}", cli::quoted(path), read_error.reason),
              read_error.help.empty() ? Help{} : Help{read_error.help});
}

std::string quoted(const std::string& path) { return path == "-" ? "standard input" : "`" + path + "`"; }

std::string source_name(const std::string& path) { return path == "-" ? "<stdin>" : path; }

}  // namespace fathom::cli
