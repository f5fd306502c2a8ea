// A plan: one render, of a still or of frames, cut into units that machines render independently. A unit is a
// rectangle of a frame's pixels and a range of their samples, identified by its number. The plan contains everything
// that a worker needs: the scene's text with its imports, the options, and the environment map. The plan is a JSON
// file (docs/how-to/farm.md) whose size does not depend on the number of units.
//
// Units are films in a folder next to the plan, frame.json -> frame.units/000/000007.film, in subfolders of a
// thousand.
//
// Tested by: tests/runtime/cli/plan/cli_plan_test.cpp
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "compiler/source/source.h"
#include "runtime/cli/input/text_file.h"
#include "runtime/cli/options/unit_options.h"
#include "runtime/cli/plan/plan_grid.h"
#include "runtime/film/film_file.h"

namespace fathom::cli {

struct RenderPlan {
  compiler::Source source;             // includes the imports
  std::vector<std::string> arguments;  // arguments of `fathom render`, except the scene
  PlanGrid grid;
  std::string background_name, background;  // name and bytes of the environment map
  runtime::Identity identity;               // of the still, or of the first frame
  std::string digest;                       // of all other members, in hexadecimal
};

// Returns the text of the plan's file and sets the digest. Returns the reason if the scene cannot be written as JSON.
std::variant<std::string, ReadError> write_plan(RenderPlan& plan);
// Reads a plan. Prints a message and returns an exit code if the file cannot be read or is not a plan.
std::variant<RenderPlan, ExitCode> read_plan(const std::string& path, const compiler::Limits& limits,
                                             const Streams& streams);

// True for rows of the identity that may differ between frames of a plan. The other rows describe the whole plan.
bool is_of_frame(std::string_view row);
runtime::Identity without_frame(runtime::Identity identity);  // the rows of the whole plan

// Returns the folder of the units: "frame.json" -> "frame.units".
std::string units_folder(const std::string& plan);
std::string unit_file(const std::string& folder, std::uint64_t number);

// The units of a range that have a film or a checkpoint, by number. The time depends on their number, not on the range.
struct UnitFiles {
  bool film = false, checkpoint = false;
};
std::map<std::uint64_t, UnitFiles> unit_files(const std::string& folder, UnitRange range);

// Creates the folder or checks that it belongs to this plan. Otherwise prints a message and returns an exit code.
std::optional<ExitCode> claim_folder(const std::string& folder, const RenderPlan& plan, const Streams& streams);
// The same without creating the folder. Returns true if the folder belongs to this plan, false if no plan has claimed
// the folder.
std::variant<bool, ExitCode> find_folder(const std::string& folder, const RenderPlan& plan, const Streams& streams);

// Returns nullopt if the film is complete and belongs to the unit, else the reason. `header` is the film file, for
// which the header suffices.
std::optional<std::string> fault_of(const runtime::FilmFile& header, const RenderPlan& plan, const PlanUnit& unit);

}  // namespace fathom::cli
