#include "runtime/cli/input/import_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "runtime/cli/input/text_file.h"

namespace fathom::cli {
namespace {

namespace fs = std::filesystem;

bool is_below(const fs::path& path, const fs::path& root) {
  const auto [end, ignored] = std::mismatch(root.begin(), root.end(), path.begin(), path.end());
  return end == root.end() || (end->empty() && std::next(end) == root.end());
}

}  // namespace

compiler::ImportReader import_reader(const SceneArguments& arguments, const Streams& streams) {
  using Read = std::variant<std::string, compiler::ImportFault>;
  // Imports of a scene from standard input are relative to the current folder.
  const fs::path folder = arguments.path == "-" ? "." : "." / fs::path(arguments.path).parent_path();
  return [=, root = arguments.root, limits = arguments.limits, on_import = arguments.on_import,
          &streams](const std::string& path) -> Read {
    const fs::path file = folder / path;
    if (on_import) on_import(file.string());
    std::error_code error;
    const fs::path allowed = fs::canonical(root ? fs::path(*root) : folder, error);
    if (error)
      return compiler::ImportFault{
          fmt::format("the folder {}: {}", cli::quoted(root.value_or(".")), error.message())};
    const fs::path real = fs::weakly_canonical(file, error);
    if (error) return compiler::ImportFault{error.message()};
    if (!is_below(real, allowed)) {
      return compiler::ImportFault{
          root ? fmt::format("it is not in the folder {} that --root names", cli::quoted(*root))
               : "it is not in the scene's folder",
          "--root DIR names the folder that imports may be read from, as `--root scenes`"};
    }
    if (fs::exists(real, error) && !fs::is_regular_file(real, error)) return compiler::ImportFault{"it is no file"};
    auto text = read_text(real.string(), limits, streams);
    if (const auto* read_error = std::get_if<ReadError>(&text)) {
      return compiler::ImportFault{read_error->reason, read_error->help};
    }
    return std::get<std::string>(std::move(text));
  };
}

}  // namespace fathom::cli
