// The report of `fathom check` on a scene without errors, as text for people and as JSON lines.
// Tested by: tests/runtime/cli/cli_check_test.cpp
#pragma once

#include <string>
#include <vector>

#include "compiler/analysis/probe.h"
#include "compiler/analysis/report.h"
#include "compiler/scene/compiled_scene.h"

namespace fathom::cli {

// The text lists only those of many objects that make steps the shortest, unless `all_objects` is true.
std::string report_text(const compiler::CompiledScene& scene, const compiler::Report& report, bool all_objects);
std::string report_json(const compiler::CompiledScene& scene, const compiler::Report& report);

// `culprits` are the rows of `rows` that have the wrong constants (see compiler::culprits()).
std::string probe_text(const compiler::Source& source, const std::vector<compiler::ProbeRow>& rows,
                       const std::vector<const compiler::ProbeRow*>& culprits);
std::string probe_json(const compiler::Source& source, const std::vector<compiler::ProbeRow>& rows,
                       const std::vector<const compiler::ProbeRow*>& culprits);

}  // namespace fathom::cli
