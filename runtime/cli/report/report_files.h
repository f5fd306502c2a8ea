// The files of a report's page: its style.
#pragma once

#include <span>

#include "compiler/source/embedded_file.h"

namespace fathom::cli {

std::span<const compiler::EmbeddedFile> report_files();

}  // namespace fathom::cli
