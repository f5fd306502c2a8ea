#include "compiler/frontend/text/parse/standard_library.h"

#include <algorithm>

namespace fathom::compiler::text {

const StandardFile* find_standard(std::string_view path) {
  constexpr std::string_view kFolder = "std/", kEnding = ".fathom";
  if (!is_standard(path)) return nullptr;
  path.remove_prefix(kFolder.size());
  if (path.ends_with(kEnding)) path.remove_suffix(kEnding.size());
  const auto files = standard_files();
  const auto found = std::ranges::find(files, path, &StandardFile::name);
  return found == files.end() ? nullptr : &*found;
}

}  // namespace fathom::compiler::text
