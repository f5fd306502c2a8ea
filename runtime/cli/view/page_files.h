// The files of the viewer's page, which the build puts into the program.
#pragma once

#include <span>
#include <string_view>

namespace fathom::cli {

struct PageFile {
  std::string_view name, text;
};

// The files of runtime/cli/view/page, and the scripts of runtime/live.
std::span<const PageFile> page_files();

}  // namespace fathom::cli
