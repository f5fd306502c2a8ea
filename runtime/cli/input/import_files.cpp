#include "runtime/cli/input/import_files.h"

#include <filesystem>

#include "runtime/load/files.h"

namespace fathom::cli {

compiler::ImportReader import_reader(const SceneArguments& arguments, const Streams& streams) {
  namespace fs = std::filesystem;
  return runtime::import_reader({
      // Imports of a scene from standard input are relative to the current folder.
      .folder = arguments.path == "-" ? fs::path(".") : "." / fs::path(arguments.path).parent_path(),
      .root = arguments.root,
      .limits = arguments.limits,
      .option = "--root",
      .remedy = "--root DIR names the folder that imports may be read from, as `--root scenes`",
      .on_import =
          [&streams, watch = arguments.on_import](const std::string& path) {
            streams.files.add_input(path);
            if (watch) watch(path);
          },
  });
}

}  // namespace fathom::cli
