// The text of runtime/cli/report/report.css, which the build puts into the program.
#pragma once

#include <string_view>

namespace fathom::cli {

extern const std::string_view kReportStyle;

}  // namespace fathom::cli
