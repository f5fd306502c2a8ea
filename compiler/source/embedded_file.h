// A file that the build puts into the program: embed_table() of cmake/EmbedFiles.cmake.
#pragma once

#include <string_view>

namespace fathom::compiler {

struct EmbeddedFile {
  std::string_view name, text;
};

}  // namespace fathom::compiler
