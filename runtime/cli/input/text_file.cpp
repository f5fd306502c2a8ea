#include "runtime/cli/input/text_file.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <istream>

namespace fathom::cli {
namespace {

std::variant<std::string, ReadError> read_all(std::istream& in, const compiler::Limits& limits) {
  std::string text;
  char block[1 << 16];
  while (in.read(block, sizeof block) || in.gcount() > 0) {
    text.append(block, static_cast<std::size_t>(in.gcount()));
    const auto size = static_cast<double>(text.size());
    if (size > limits.file_size) {
      return ReadError{fmt::format("it has more than {:.15g} bytes, as many as are read", limits.file_size),
                       compiler::raise(&compiler::Limits::file_size, 2 * limits.file_size), kBadScene};
    }
  }
  if (in.bad()) return ReadError{std::strerror(errno)};
  return text;
}

}  // namespace

std::variant<std::string, ReadError> read_text(const std::string& path, const compiler::Limits& limits,
                                               const Streams& streams) {
  if (path == "-") return read_all(streams.in, limits);
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    return ReadError{"it is a directory"};
  }
  std::ifstream file(path, std::ios::binary);
  if (!file) return ReadError{std::strerror(errno)};
  return read_all(file, limits);
}

ExitCode fail(const Streams& streams, const std::string& path, const ReadError& read_error) {
  return fail(streams, read_error.code, fmt::format("cannot read {}: {}", cli::quoted(path), read_error.reason),
              read_error.help.empty() ? Help{} : Help{read_error.help});
}

std::string quoted(const std::string& path) { return path == "-" ? "standard input" : "`" + path + "`"; }

std::string source_name(const std::string& path) { return path == "-" ? "<stdin>" : path; }

}  // namespace fathom::cli
