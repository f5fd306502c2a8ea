// The page of `fathom report`: one HTML text without links, which a browser shows offline.
// Tested by: tests/runtime/cli/cli_report_test.cpp
#pragma once

#include <optional>
#include <string>

#include "compiler/analysis/report.h"
#include "compiler/scene/compiled_scene.h"
#include "runtime/render.h"

namespace fathom::cli {

struct ReportContents {
  const compiler::CompiledScene& scene;
  const compiler::Report& report;
  const runtime::RenderResult& render;  // with all layers
  std::string command;                  // that wrote the report
  std::string messages;                 // of the compiler, for people
  std::optional<std::string> chart;     // an SVG file's text
};

std::string report_page(const ReportContents& contents);

}  // namespace fathom::cli
