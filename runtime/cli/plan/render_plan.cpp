#include "runtime/cli/plan/render_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "compiler/artefact/compiled_file.h"
#include "runtime/cli/options/output_file.h"
#include "runtime/cli/picture/render_identity.h"
#include "runtime/cli/plan/base64.h"
#include "runtime/cli/request/render_request.h"
#include "vm/encoding/digest.h"

namespace fathom::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kPlanFormat = 1;
constexpr std::string_view kPlanEnding = ".json";
constexpr std::uint64_t kUnitsPerFolder = 1000;
constexpr const char* kClaimName = "plan";  // file in the units' folder with the plan's digest

Json to_json(const compiler::Source& source) {
  Json imports = Json::array();
  for (const compiler::Import& import : compiler::files_of(source)) {
    imports.push_back({{"path", import.path}, {"text", import.file->text()}});
  }
  return {{"name", source.name()}, {"text", source.text()}, {"imports", std::move(imports)}};
}

Json to_json(const RenderPlan& plan) {
  const PlanGrid& grid = plan.grid;
  Json json = {{"fathom plan", kPlanFormat}, {"units", grid.units()}};
  if (grid.frames) json["frames"] = {grid.frames->first, grid.frames->last, grid.frames->step};
  json["size"] = {grid.width, grid.height};
  json["tiles"] = {grid.columns, grid.rows};
  json["samples"] = grid.spp;
  json["sample block"] = grid.block;
  json["arguments"] = plan.arguments;
  Json identity = Json::object();
  for (const auto& [name, value] : plan.identity) identity[name] = value;
  json["render"] = std::move(identity);
  json["scene"] = to_json(plan.source);
  if (!plan.background_name.empty()) {
    json["background"] = {{"name", plan.background_name}, {"base64", to_base64(plan.background)}};
  }
  return json;
}

std::string digest_of(const Json& json) {
  const std::string text = json.dump();
  return vm::digest({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}).text();
}

// Throws the exceptions of nlohmann::json if a value is missing or has the wrong type.
RenderPlan from_json(const Json& json) {
  RenderPlan plan;
  PlanGrid& grid = plan.grid;
  if (json.contains("frames")) {
    grid.frames = {json["frames"].at(0), json["frames"].at(1), json["frames"].at(2)};
  }
  grid.width = json.at("size").at(0), grid.height = json.at("size").at(1);
  grid.columns = json.at("tiles").at(0), grid.rows = json.at("tiles").at(1);
  grid.spp = json.at("samples"), grid.block = json.at("sample block");
  plan.arguments = json.at("arguments").get<std::vector<std::string>>();
  for (const auto& [name, value] : json.at("render").items()) plan.identity.emplace_back(name, value);
  const Json& scene = json.at("scene");
  plan.source = compiler::Source(scene.at("name"), scene.at("text"));
  for (const Json& import : scene.at("imports")) {
    if (!compiler::add_import(plan.source, import.at("path"), import.at("text"))) {
      throw Json::other_error::create(501, "an import that cannot be", nullptr);
    }
  }
  if (json.contains("background")) {
    plan.background_name = json["background"].at("name");
    plan.background = from_base64(json["background"].at("base64").get<std::string>()).value_or("");
  }
  return plan;
}

bool is_possible(const PlanGrid& grid) {
  const auto within = [](int value, int most) { return value >= 1 && value <= most; };
  if (grid.frames && !(grid.frames->step >= 1 && grid.frames->first >= 0 && grid.frames->first < grid.frames->last)) {
    return false;
  }
  if (too_many_units(grid)) return false;
  return within(grid.width, compiler::kMaxSide) && within(grid.height, compiler::kMaxSide) &&
         within(grid.columns, grid.width) && within(grid.rows, grid.height) && grid.block >= 1 &&
         grid.spp >= grid.block && grid.spp <= static_cast<std::uint32_t>(compiler::kMaxSpp);
}

std::optional<std::string> value_of(const runtime::Identity& identity, std::string_view row) {
  const auto found = std::ranges::find(identity, row, [](const auto& each) { return std::string_view(each.first); });
  return found == identity.end() ? std::nullopt : std::optional(found->second);
}

// True if the grid divides the picture that the identity describes.
bool is_of(const PlanGrid& grid, const runtime::Identity& identity) {
  return value_of(identity, "size") == fmt::format("{}x{}", grid.width, grid.height) &&
         value_of(identity, "spp") == std::to_string(grid.spp);
}

std::optional<std::string> frame_of(const PlanGrid& grid, const PlanUnit& unit) {
  if (!grid.frames) return std::nullopt;
  return std::to_string(grid.frames->at(unit.frame_index));
}

std::vector<std::string> names_in(const std::string& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (std::filesystem::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    names.push_back(at->path().filename());
  }
  return names;
}

std::optional<std::uint64_t> leading_number(const std::string& name) {
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  return error == std::errc() && number < kMaxUnits ? std::optional(number) : std::nullopt;
}

ExitCode refuse_folder(const std::string& folder, const std::string& held, const RenderPlan& plan,
                       const Streams& streams) {
  return fail(
      streams, kBadScene,
      fmt::format("`{}` has units of another plan: its digest is {} there and {} here", folder, held, plan.digest),
      {fmt::format("remove `{}`, or give one of the plans another name", folder)});
}

}  // namespace

std::variant<std::string, ReadError> write_plan(RenderPlan& plan) {
  try {
    Json json = to_json(plan);
    plan.digest = digest_of(json);
    json["digest"] = plan.digest;
    return json.dump(1) + "\n";
  } catch (const Json::exception&) {
    return ReadError{"the scene's text is no UTF-8, which a plan must be", "save it as UTF-8", kBadScene};
  }
}

std::variant<RenderPlan, ExitCode> read_plan(const std::string& path, const compiler::Limits& limits,
                                             const Streams& streams) {
  const auto text = read_text(path, limits, streams);
  if (const auto* read_error = std::get_if<ReadError>(&text)) return fail(streams, path, *read_error);
  const auto refuse = [&](std::string_view why) {
    return fail(streams, kBadScene, fmt::format("{} is no plan that can be used: {}", quoted(path), why),
                {"`fathom plan scene -o plan.json` makes one"});
  };
  Json json = Json::parse(std::get<std::string>(text), nullptr, false);
  if (!json.is_object() || !json.contains("fathom plan")) return refuse("it does not begin as one");
  try {
    if (const int format = json["fathom plan"]; format != kPlanFormat) {
      return refuse(fmt::format("it is of format {}, and this program reads {}", format, kPlanFormat));
    }
    const std::string digest = json.at("digest");
    json.erase("digest");
    if (digest != digest_of(json)) return refuse("it was changed since it was made: its digest does not fit");
    RenderPlan plan = from_json(json);
    if (!is_possible(plan.grid) || json.at("units") != plan.grid.units() || !is_of(plan.grid, plan.identity)) {
      return refuse("its numbers do not go together");
    }
    plan.digest = digest;
    return plan;
  } catch (const Json::exception&) {
    return refuse("something is missing in it");
  }
}

bool is_of_frame(std::string_view row) {
  constexpr std::array<std::string_view, 7> kRows = {"scene", "program", "camera", "field of view",
                                                     "seed",  "moments", kFrameRow};
  return std::ranges::find(kRows, row) != kRows.end();
}

runtime::Identity without_frame(runtime::Identity identity) {
  std::erase_if(identity, [](const auto& row) { return is_of_frame(row.first); });
  return identity;
}

std::string units_folder(const std::string& plan) {
  return (plan.ends_with(kPlanEnding) ? plan.substr(0, plan.size() - kPlanEnding.size()) : plan) + ".units";
}

std::string unit_file(const std::string& folder, std::uint64_t number) {
  return fmt::format("{}/{:03}/{:06}.film", folder, number / kUnitsPerFolder, number);
}

std::map<std::uint64_t, UnitFiles> unit_files(const std::string& folder, UnitRange range) {
  std::map<std::uint64_t, UnitFiles> units;
  const auto add_file = [&](const std::string& name) {
    const std::optional<std::uint64_t> number = leading_number(name);
    if (!number || *number < range.first || *number >= range.last) return;
    const std::string film = std::filesystem::path(unit_file(folder, *number)).filename();
    if (name == film) units[*number].film = true;
    if (name == film + kCheckpointEnding) units[*number].checkpoint = true;
  };
  for (const std::string& name : names_in(folder)) {
    const std::optional<std::uint64_t> thousand = leading_number(name);
    const bool overlaps = thousand && *thousand * kUnitsPerFolder < range.last &&
                          (*thousand + 1) * kUnitsPerFolder > range.first;
    if (!overlaps) continue;
    for (const std::string& file : names_in(folder + "/" + name)) add_file(file);
  }
  return units;
}

std::variant<bool, ExitCode> find_folder(const std::string& folder, const RenderPlan& plan, const Streams& streams) {
  const std::string claim = folder + "/" + kClaimName;
  std::error_code error;
  if (!std::filesystem::exists(claim, error)) return false;
  const auto held = read_text(claim, {}, streams);
  if (const auto* read_error = std::get_if<ReadError>(&held)) return fail(streams, claim, *read_error);
  std::string digest = std::get<std::string>(held);
  if (digest.ends_with('\n')) digest.pop_back();
  if (digest != plan.digest) return refuse_folder(folder, digest, plan, streams);
  return true;
}

std::optional<ExitCode> claim_folder(const std::string& folder, const RenderPlan& plan, const Streams& streams) {
  const auto found = find_folder(folder, plan, streams);
  if (const auto* code = std::get_if<ExitCode>(&found)) return *code;
  if (std::get<bool>(found)) return std::nullopt;
  if (const auto problem = write_text(plan.digest + "\n", folder + "/" + kClaimName))
    return fail(streams, kIo, *problem);
  // A worker of another plan may have claimed the folder at the same moment.
  const auto claimed = find_folder(folder, plan, streams);
  if (const auto* code = std::get_if<ExitCode>(&claimed)) return *code;
  return std::nullopt;
}

std::optional<std::string> fault_of(const runtime::FilmFile& file, const RenderPlan& plan, const PlanUnit& unit) {
  const PlanGrid& grid = plan.grid;
  const bool fits = file.header.width == grid.width && file.header.height == grid.height &&
                    file.shape.area == unit.area && !file.render.adaptive.used();
  if (!fits || !(file.header.samples == unit.samples) ||
      value_of(file.header.identity, kFrameRow) != frame_of(grid, unit)) {
    return "it is of another unit";
  }
  const auto differ = runtime::differences(without_frame(plan.identity), without_frame(file.header.identity),
                                           "in the plan", "in it");
  if (!differ.empty()) return "it is of another render: " + differ.front();
  if (!file.render.covered.front().covers({unit.area, unit.samples})) return "it has not all samples";
  return std::nullopt;
}

}  // namespace fathom::cli
