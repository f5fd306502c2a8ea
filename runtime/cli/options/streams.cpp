#include "runtime/cli/options/streams.h"

#include <ostream>
#include <system_error>

#include "vm/encoding/printable.h"

namespace fathom::cli {

void UsedFiles::add(const std::string& path, Use use) {
  std::error_code ignored;
  const auto canonical = std::filesystem::weakly_canonical(std::filesystem::absolute(path, ignored), ignored);
  const auto [entry, added] = uses_.emplace(canonical, use);
  const bool shared = use == Use::Input && entry->second == Use::Input;
  if (!added && !shared && !conflict_) conflict_ = path;
}

ExitCode fail(const Streams& streams, ExitCode code, std::string_view message, const Help& help) {
  streams.err << (streams.color ? "\033[1;31merror\033[0m: " : "error: ") << vm::printable(message) << '\n';
  for (const std::string& line : help) streams.err << "  = help: " << vm::printable(line) << '\n';
  return code;
}

void print(const Streams& streams, std::string_view text) { streams.out << vm::escape_controls(text); }

void say(const Streams& streams, std::string_view message) {
  if (!streams.quiet) streams.err << vm::printable(message) << '\n';
}

void note(const Streams& streams, std::string_view message) {
  streams.err << (streams.color ? "\033[1mnote\033[0m: " : "note: ") << vm::printable(message) << '\n';
}

void warn(const Streams& streams, std::string_view message) {
  streams.err << (streams.color ? "\033[1;33mwarning\033[0m: " : "warning: ") << vm::printable(message) << '\n';
}

std::string count_of(std::size_t count, std::string_view noun) {
  return std::to_string(count) + ' ' + std::string(noun) + (count == 1 ? "" : "s");
}

}  // namespace fathom::cli
