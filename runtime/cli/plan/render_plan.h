// A plan: one render, of a still or of frames, cut into units that machines render without each other. A unit is a
// rectangle of a frame's pixels and a range of their samples; its number says which. The plan has all that a worker
// needs: the scene's text with what it imports, the options, the background's picture. It is a JSON file
// (docs/FARM.md); its size does not depend on the number of units.
//
// Units are films in a folder beside the plan, frame.json -> frame.units/000/000007.film, by thousands.
//
// Tested by: tests/runtime/cli/plan/cli_plan_test.cpp
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "compiler/source/source.h"
#include "runtime/cli/input/text_file.h"
#include "runtime/cli/plan/plan_grid.h"
#include "runtime/film/film_file.h"

namespace fathom::cli {

struct RenderPlan {
  compiler::Source source;             // with its imports
  std::vector<std::string> arguments;  // of `fathom render`, but for the scene
  PlanGrid grid;
  std::string background_name, background;  // of the picture that the scene's background names: its bytes
  runtime::Identity identity;               // of the still, or the first frame
  std::string digest;                       // of all the others, in hexadecimal
};

// The text of the plan's file; sets the digest. The reason when the scene cannot be written as JSON.
std::variant<std::string, Unreadable> write_plan(RenderPlan& plan);
// An ExitCode, after a message, when it cannot be read or is no plan.
std::variant<RenderPlan, ExitCode> read_plan(const std::string& path, const compiler::Limits& limits,
                                             const Streams& streams);

// What renders of two frames of a plan may differ in; other rows of their identities say how the plan was made.
bool is_of_frame(std::string_view row);

// "frame.json" -> "frame.units".
std::string units_folder(const std::string& plan);
std::string unit_file(const std::string& folder, std::uint64_t number);

// Makes the folder, or sees that what is there is of this plan. An ExitCode, after a message, when it is not.
std::optional<ExitCode> claim_folder(const std::string& folder, const RenderPlan& plan, const Streams& streams);
// The same without making it; true when there is one.
std::variant<bool, ExitCode> find_folder(const std::string& folder, const RenderPlan& plan, const Streams& streams);

// Why the file is not the unit's film, whole; nothing when it is. `header` is that of the file.
std::optional<std::string> fault_of(const runtime::FilmFile& header, const PlanGrid& grid, const PlanUnit& unit);

}  // namespace fathom::cli
