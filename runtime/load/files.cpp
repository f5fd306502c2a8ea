#include "runtime/load/files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <istream>

#include "runtime/base/machine.h"

namespace fathom::runtime {
namespace {

namespace fs = std::filesystem;

bool is_below(const fs::path& path, const fs::path& root) {
  const auto [end, ignored] = std::mismatch(root.begin(), root.end(), path.begin(), path.end());
  return end == root.end() || (end->empty() && std::next(end) == root.end());
}

// Returns the file's path without links, or the reason why the file may not be read.
std::variant<std::string, compiler::ImportFault> resolve_import(const ImportFolder& folder, const fs::path& file) {
  std::error_code error;
  const fs::path allowed = fs::canonical(folder.root ? fs::path(*folder.root) : folder.folder, error);
  if (error) {
    return compiler::ImportFault{fmt::format("the folder `{}`: {}", folder.root.value_or("."), error.message())};
  }
  const fs::path real = fs::weakly_canonical(file, error);
  if (error) return compiler::ImportFault{error.message()};
  if (!is_below(real, allowed)) {
    return compiler::ImportFault{
        folder.root ? fmt::format("it is not in the folder `{}` that {} names", *folder.root, folder.option)
                    : "it is not in the scene's folder",
        folder.remedy};
  }
  if (fs::exists(real, error) && !fs::is_regular_file(real, error)) return compiler::ImportFault{"it is no file"};
  return real.string();
}

}  // namespace

std::variant<std::string, FileFault> read_stream(std::istream& in, const compiler::Limits& limits) {
  std::string text;
  char block[1 << 16];
  while (in.read(block, sizeof block) || in.gcount() > 0) {
    text.append(block, static_cast<std::size_t>(in.gcount()));
    const auto size = static_cast<double>(text.size());
    if (size > limits.file_size) {
      return FileFault{fmt::format("it has more than {:.15g} bytes, as many as are read", limits.file_size),
                       compiler::raise(&compiler::Limits::file_size, 2 * limits.file_size), true};
    }
  }
  if (in.bad()) return FileFault{std::strerror(errno)};
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";  // means nothing in UTF-8
  if (text.starts_with(kByteOrderMark)) text.erase(0, kByteOrderMark.size());
  return text;
}

std::variant<std::string, FileFault> read_file(const std::string& path, const compiler::Limits& limits) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) return FileFault{"it is a directory"};
  std::ifstream file(path, std::ios::binary);
  if (!file) return FileFault{std::strerror(errno)};
  return read_stream(file, limits);
}

compiler::ImportReader import_reader(ImportFolder folder) {
  using Read = std::variant<std::string, compiler::ImportFault>;
  return [folder = std::move(folder)](const std::string& path) -> Read {
    const fs::path file = folder.folder / path;
    if (folder.on_import) folder.on_import(file.string());
    auto resolved = resolve_import(folder, file);
    if (auto* fault = std::get_if<compiler::ImportFault>(&resolved)) return std::move(*fault);
    auto text = read_file(std::get<std::string>(resolved), folder.limits);
    if (auto* fault = std::get_if<FileFault>(&text)) {
      return compiler::ImportFault{std::move(fault->reason), std::move(fault->remedy)};
    }
    return std::get<std::string>(std::move(text));
  };
}

double allowed_memory(const compiler::Limits& limits) {
  if (limits.memory > 0) return limits.memory;
  return 0.75 * usable_memory();
}

}  // namespace fathom::runtime
