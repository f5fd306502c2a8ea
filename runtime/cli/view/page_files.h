// The files of the viewer's page: those of runtime/cli/view/page, and the scripts of runtime/live.
#pragma once

#include <span>

#include "compiler/source/embedded_file.h"

namespace fathom::cli {

std::span<const compiler::EmbeddedFile> page_files();

}  // namespace fathom::cli
