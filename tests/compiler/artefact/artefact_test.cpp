// Compiled scenes as bytes and as text: both forms read back as the same scene. The reader refuses every wrong part
// of a file and names its position, and whatever the reader accepts is valid.
#include <bit>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "compiler/artefact/compiled_file.h"
#include "compiler/artefact/fields.h"
#include "compiler/artefact/listing.h"
#include "compiler/artefact/programs.h"
#include "tests/support/catch.h"
#include "tests/support/compiled.h"
#include "tests/support/draw_small.h"
#include "tests/support/golden.h"
#include "tests/support/scaled_cases.h"
#include "tests/support/sealed_file.h"
#include "vm/interpret/evaluate.h"
#include "vm/prune/def_use_graph.h"

namespace fathom::test::artefact_test {
namespace {

namespace fs = std::filesystem;
using compiler::CompiledScene;
using compiler::FileContents;
using compiler::FileError;
using Bytes = std::vector<std::uint8_t>;
using Catch::Contains;

// Scene that puts at least one entry into every table of a file.
constexpr const char* kEverything = R"scene({
  "version": 1,
  "params": {"r": {"default": 0.5, "min": 0.1, "doc": "of the \"ball\" \\"}},
  "camera": {"type": "perspective", "position": [0, 1, 5], "fov_y": 40, "f_stop": 2, "focus_distance": 5, "blades": 6},
  "film": {"width": 16, "height": 8, "filter": "mitchell", "filter_width": 3, "tone": "agx", "exposure": 1},
  "render": {"spp": 4, "seed": 7, "far": 100, "sampler": "sobol"},
  "background": {"type": "sky", "elevation": 30},
  "lights": {"lamp": {"type": "spot", "position": [0, 3, 0], "target": [0, 0, 0], "intensity": [1, 2, 3]}},
  "materials": {
    "glass": {"type": "transparent", "ior": 1.5, "priority": -2},
    "tiles": {"type": "principled", "base_color": {"pattern": "checker", "space": "object", "a": [1, 0, 0], "b": {"pattern": "noise",
              "a": 0, "b": 1}}, "roughness": "0.2 + 0.1 * sin(x)",
                     "coat" : 1
}
, "glow" : { "type" : "emissive", "emission" : [ 5, 5, 5 ] }
}
, "objects" : [
  {"name" : "ball", "type" : "sphere", "radius" : "r", "material" : "glass", "translate" : [ 0.1, 0, 0 ]},
  {"name" : "floor", "type" : "plane", "normal" : [ 0, 1, 0 ], "offset" : -1, "material" : "tiles"},
  {"name" : "bulb", "type" : "sphere", "radius" : 0.2, "material" : "glow", "translate" : [ 0, 2, 0 ]}, {
    "name" : "outline",
    "type" : "extrude",
    "half_depth" : 0.3,
    "translate" : [ -2, 0, 0 ],
    "of" : {"type" : "polygon", "points" : [ [ 0, 0 ], [ 1, 0 ], [ 0, 1 ] ]}
  }
]
})scene";

CompiledScene opened(const Bytes& bytes) {
  auto stored = compiler::read_stored(bytes, "test.fbc");
  if (const auto* error = std::get_if<FileError>(&stored)) FAIL(error->reason);
  return std::get<compiler::StoredScene>(std::move(stored)).scene;
}

// Returns why the reader refuses the bytes, or "" if it accepts them.
std::string reason_of(const Bytes& bytes) {
  const auto stored = compiler::read_stored(bytes, "test.fbc");
  const auto* error = std::get_if<FileError>(&stored);
  return error ? error->reason : "";
}

CompiledScene reread(const std::string& listing, FileContents& contents) {
  compiler::Diagnostics diagnostics;
  const compiler::Source source("test.txt", listing);
  auto scene = compiler::read_listing(source, diagnostics, contents);
  INFO(diagnostics.print(source, compiler::ErrorFormat::Text));
  REQUIRE(scene);
  return *std::move(scene);
}

void check_round_trips(const CompiledScene& scene, const FileContents& contents = {}) {
  const Bytes bytes = compiler::write_file(scene, contents);
  const CompiledScene stored = opened(bytes);
  CHECK((compiler::write_file(stored, contents) == bytes));
  CHECK(compiler::scene_digest(stored) == compiler::scene_digest(scene));
  const std::string listing = compiler::write_listing(stored, contents);
  FileContents found;
  const CompiledScene read = reread(listing, found);
  CHECK((compiler::write_file(read, found) == bytes));
  CHECK(compiler::write_listing(read, found) == listing);
}

Sections without_text(const Bytes& file) {
  Sections sections = sections_of(file);
  sections.text.clear();
  return sections;
}

}  // namespace

TEST_CASE("every shipped scene reads back from its bytes and from its listing", "[artefact]") {
  int count = 0;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(FATHOM_SOURCE_DIR "/scenes")) {
    if (entry.path().extension() != ".json") continue;
    // Scenes of ten thousand copies of a node show the sanitizers no more than the scene d1000 does.
    if (few_cases() && entry.file_size() > 500'000) continue;
    INFO(entry.path().string());
    check_round_trips(test::compiled(test::read_file(entry.path())));
    ++count;
  }
  CHECK(count >= 20);
}

TEST_CASE("all that a scene can say reads back, with and without places and text", "[artefact]") {
  const CompiledScene scene = test::compiled(kEverything);
  REQUIRE(scene.media.size() == 1);
  REQUIRE(scene.area_lights.size() == 1);
  REQUIRE(scene.formulas.size() == 1);
  REQUIRE(scene.textures.size() >= 3);
  for (const bool debug : {true, false}) {
    for (const bool text : {true, false}) {
      CAPTURE(debug, text);
      check_round_trips(scene, {debug, text});
      CHECK(compiler::scene_digest(opened(compiler::write_file(scene, {debug, text}))) ==
            compiler::scene_digest(scene));
    }
  }
  const CompiledScene bare = opened(compiler::write_file(scene, {false, false}));
  CHECK(bare.distance.program().debug.empty());
  CHECK(bare.source.text().empty());
  const CompiledScene whole = opened(compiler::write_file(scene));
  CHECK(whole.source.text() == kEverything);
  CHECK(whole.distance.program().debug.size() == scene.distance.instructions());
}

TEST_CASE("two scenes have one digest only when they render alike", "[artefact]") {
  const std::string ball = R"({"type": "sphere", "radius": 1})";
  const vm::Digest digest = compiler::scene_digest(test::compiled_objects(ball));
  CHECK(compiler::scene_digest(test::compiled_objects("  " + ball)) == digest);
  CHECK_FALSE(compiler::scene_digest(test::compiled_objects(R"({"type": "sphere", "radius": 1.0000001})")) == digest);
  CHECK_FALSE(compiler::scene_digest(test::compiled(
                  R"({"version": 1, "camera": {"position": [0, 0, 6]}, "objects": [)" + ball + "]}")) == digest);
  CHECK_FALSE(compiler::scene_digest(
                  test::compiled(R"({"version": 1, "render": {"spp": 17}, "objects": [)" + ball + "]}")) == digest);
}

TEST_CASE("a file that was cut or changed anywhere is refused", "[artefact]") {
  const Bytes bytes = compiler::write_file(test::compiled(kEverything));
  for (std::size_t size = 0; size < bytes.size(); size += size < 300 ? 1 : 37) {
    CAPTURE(size);
    REQUIRE_FALSE(reason_of({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)}).empty());
  }
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    Bytes changed = bytes;
    changed[at] ^= static_cast<std::uint8_t>(1u << at % 8);
    CAPTURE(at);
    REQUIRE_FALSE(reason_of(changed).empty());
  }
  Bytes longer = bytes;
  longer.push_back(0);
  CHECK(reason_of(longer) == "1 bytes follow its last section");
}

// An attacker who changes a file can also correct its digests.
TEST_CASE("a sealed file with any byte changed is refused or sound", "[artefact]") {
  const Sections parts = without_text(compiler::write_file(test::compiled(kEverything)));
  vm::Workspace workspace;
  int accepted = 0;
  const auto try_one = [&](Sections changed) {
    const Bytes bytes = sealed(changed);
    const auto stored = compiler::read_stored(bytes, "test.fbc");
    const auto* good = std::get_if<compiler::StoredScene>(&stored);
    if (good == nullptr) {
      CHECK_FALSE(std::get<FileError>(stored).reason.empty());
      return;
    }
    ++accepted;
    const Bytes again = compiler::write_file(good->scene, {true, false});
    if (again != bytes) {
      const auto where = std::mismatch(again.begin(), again.end(), bytes.begin());
      FAIL_CHECK("byte " << where.first - again.begin() << " of " << bytes.size()
                         << " is another when written again");
    }
    for (const compiler::NamedProgram& row : compiler::programs_of(good->scene)) {
      if (row.program->cost() < 100000) vm::evaluate_surface(*row.program, glm::dvec3(0.1, 0.2, 0.3), workspace);
      vm::DefUseGraph().read(*row.program);
    }
    if (accepted % 16 == 0) draw_small(good->scene);
  };
  const std::size_t stride = few_cases() ? 8 : 1;
  for (std::size_t at = 0; at < parts.code.size(); at += stride) {
    CAPTURE(at);
    Sections changed = parts;
    changed.code[at] ^= static_cast<std::uint8_t>(1u << at % 8);
    try_one(changed);
  }
  for (std::size_t at = 0; at < parts.tables.size(); at += stride) {
    CAPTURE(at);
    Sections changed = parts;
    changed.tables[at] ^= static_cast<std::uint8_t>(1u << at % 8);
    try_one(changed);
  }
  CHECK(accepted > 0);
}

TEST_CASE("each section says what is wrong with it", "[artefact]") {
  const Bytes good = compiler::write_file(test::compiled(kEverything), {true, false});
  const Sections parts = sections_of(good);
  CHECK((sealed(parts) == good));
  const auto with = [&](auto change) {
    Sections changed = parts;
    change(changed);
    return reason_of(sealed(changed));
  };
  CHECK_THAT(reason_of({'{', '}'}), Contains("no compiled scene"));
  Bytes other = good;
  other[8] = 3;
  CHECK_THAT(reason_of(other),
             Contains("it is of version 3 of the format with 4 sections; this program reads version 6"));
  CHECK_THAT(reason_of({good.begin(), good.begin() + 10}), Contains("header is damaged or cut off"));
  CHECK_THAT(reason_of(sealed(parts, vm::Digest{1, 2})), Contains("another machine"));
  CHECK_THAT(with([](Sections& s) { s.code.push_back(0); }), Contains("goes on for 1 bytes after its last program"));
  CHECK_THAT(with([](Sections& s) { s.code.resize(4); }), Contains("`code` is cut off"));
  CHECK_THAT(with([](Sections& s) { s.code[0] = 200; }), Contains("`code` is cut off"));
  CHECK_THAT(with([](Sections& s) { s.code[32] = 0xff; }),
             Contains("program `distance` at byte 8 of the code, word 0: no opcode 255"));
  CHECK_THAT(with([](Sections& s) { s.tables.push_back(0); }), Contains("`tables` is wrong: byte"));
  CHECK_THAT(with([](Sections& s) { s.tables.pop_back(); }), Contains("`tables` is wrong: byte"));
  const auto tables = [&](auto change) {
    return with([&](Sections& s) {
      auto json = std::get<compiler::TableJson>(compiler::parse_tables(s.tables, true));
      change(json);
      s.tables = compiler::TableJson::to_cbor(json);
    });
  };
  using Json = compiler::TableJson;
  CHECK(tables([](Json&) {}).empty());
  CHECK_THAT(tables([](Json& t) { t["camera"]["blades"] = 99; }),
             Contains("`tables` is wrong at /camera/blades: 99 is not in 0..32"));
  CHECK_THAT(tables([](Json& t) { t["camera"]["position"][1] = "nan"; }),
             Contains("/camera/position/1: this should be a number with a point"));
  CHECK_THAT(tables([](Json& t) { t["materials"][1]["coat_ior"] = -1.0; }), Contains("/materials/1/coat_ior: -1 is"));
  CHECK_THAT(tables([](Json& t) { t["surfaces"][2]["material"] = 4; }),
             Contains("/surfaces/2/material: 4 is not in"));
  CHECK_THAT(tables([](Json& t) { t["media"] = Json::array(); }), Contains("/media: the array has another size"));
  CHECK_THAT(tables([](Json& t) { t["film"]["more"] = 1; }), Contains("/film: holds more than it should"));
  CHECK_THAT(tables([](Json& t) { t["film"].erase("fps"); }), Contains("/film: `fps` should be here"));
  CHECK_THAT(tables([](Json& t) { t = Json::array(); }), Contains("should be an object"));
  CHECK_THAT(with([](Sections& s) { s.tables.insert(s.tables.begin(), 100'000, 0x81); }),
             Contains("nested too deep"));
  CHECK_THAT(with([](Sections& s) { s.tables = {0xa2, 0x61, 'a', 1, 0x61, 'a', 1}; }),
             Contains("`a` is there twice"));
  CHECK_THAT(with([](Sections& s) { s.tables = {0x9b, 0x7f, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff}; }),
             Contains("`tables` is wrong"));
  // The same map with its length in two bytes.
  CHECK_THAT(with([](Sections& s) {
               s.tables.insert(s.tables.begin() + 1, static_cast<std::uint8_t>(s.tables[0] - 0xa0));
               s.tables[0] = 0xb8;
             }),
             Contains("not in the shortest form"));
  CHECK_THAT(with([](Sections& s) { s.debug.pop_back(); }), Contains("`debug` makes no sense"));
  CHECK_THAT(with([](Sections& s) { s.debug.push_back(0); }), Contains("`debug` goes on"));
  CHECK_THAT(with([](Sections& s) { s.text = {1, 0, 0, 0}; }), Contains("`text` makes no sense"));
  const auto text = [](const std::string& name, const std::string& content) {
    vm::ByteWriter out;
    out.text(name), out.u32(0), out.text(content), out.u32(0);
    return out.take();
  };
  CHECK(with([&](Sections& s) { s.text = text("a.json", "{}"); }).empty());
  CHECK_THAT(with([&](Sections& s) { s.text = text("../a.json", "{}"); }), Contains("`text` makes no sense"));
  CHECK_THAT(with([&](Sections& s) { s.text = text("a.json", ""); }), Contains("`text` makes no sense"));
  CHECK_THAT(with([](Sections& s) { s.debug.assign(8 * 5, 0); }), Contains("`debug`"));
}

TEST_CASE("a listing is refused at the line that is wrong", "[artefact]") {
  const std::string good = compiler::write_listing(test::compiled(kEverything));
  const auto refused = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    text.replace(at, from.size(), to);
    compiler::Diagnostics diagnostics;
    FileContents contents;
    const compiler::Source source("test.txt", text);
    CHECK_FALSE(compiler::read_listing(source, diagnostics, contents));
    return diagnostics.print(source, compiler::ErrorFormat::Short);
  };
  CHECK_THAT(refused("fathom 6", "fathom 7"), Contains("test.txt:1:8: error: `6` should be here"));
  CHECK_THAT(refused("\"fov\"", "\"fvo\""),
             Contains("test.txt:3:1: error: the tables: /camera: `fov` should be here"));
  CHECK_THAT(refused("\"blades\": 6", "\"blades\": 99"), Contains("/camera/blades: 99 is not in 0..32"));
  CHECK_THAT(refused("\"blades\": 6", "\"blades\": -6"), Contains("this should be a whole number"));
  CHECK_THAT(refused("\"blades\": 6", "\"blades\": six"), Contains("makes no sense"));
  CHECK_THAT(refused("\"mitchell\"", "\"michell\""), Contains("one of: box, tent"));
  CHECK_THAT(refused("program surface {", "program sorface {"),
             Contains("program `sorface` is out of order; `surface` should come here"));
  CHECK_THAT(refused("program formula 0 {", "  program"), Contains("neither a program nor the text"));
  CHECK_THAT(refused("\n}\nprogram surface", "\nprogram surface"), Contains("error"));
  CHECK_THAT(refused("sphere 0.5", "sphere 0.5 7"), Contains("`sphere` takes 1 number (radius), not 2"));
  CHECK_THAT(refused("tag 0", "tag 99"), Contains("tag 99: the scene has 4 surfaces"));
  CHECK_THAT(refused("|{", "{"), Contains("begins with |"));
  CHECK_THAT(refused("\"ball\"", "\"ba\\nll\""), Contains("a control character"));
}

// A limit on words refused files that the compiler had written under the same limits.
TEST_CASE("a file of long instructions is within the limits of its compilation", "[artefact]") {
  std::string points;
  for (int i = 0; i < 1001; ++i) points += fmt::format("{}[{}, {}]", i > 0 ? ", " : "", i, i * i);
  compiler::Limits limits;
  limits.instructions = 50;
  const CompiledScene scene = test::compiled_objects(
      R"({"type": "extrude", "half_depth": 1, "of": {"type": "polygon", "points": [)" + points + "]}}");
  REQUIRE(scene.distance.program().words.size() > 2000);
  CHECK(std::holds_alternative<compiler::StoredScene>(
      compiler::read_stored(compiler::write_file(scene), "test.fbc", limits)));
}

TEST_CASE("a program alone becomes a scene of one surface, of which nothing is proved", "[artefact]") {
  FileContents contents;
  const CompiledScene ball = reread("sphere 1\n", contents);
  CHECK_FALSE(contents.debug);
  CHECK_FALSE(contents.text);
  CHECK(ball.surfaces.size() == 1);
  CHECK_FALSE(ball.certified);
  CHECK(ball.lipschitz == Approx(1));  // intervals show it
  vm::Workspace workspace;
  CHECK(vm::evaluate_distance(ball.distance, glm::dvec3(0, 3, 0), workspace) == 2);
  CHECK(reread("plane 0 3 0 1\n", contents).lipschitz == Approx(3));
  check_round_trips(ball, contents);
}

TEST_CASE("a listing may come from a system that ends lines in two characters", "[artefact]") {
  const std::string listing = compiler::write_listing(test::compiled(kEverything));
  std::string other;
  for (const char c : listing) other += c == '\n' ? "\r\n" : std::string(1, c);
  FileContents contents, same;
  CHECK(
      (compiler::write_file(reread(other, contents), contents) == compiler::write_file(reread(listing, same), same)));
}

TEST_CASE("names of any length and with any printable characters read back", "[artefact]") {
  const std::string odd = R"(; \" @3:4 | } program x { )" + std::string(70000, 'n') + "\u00e4";
  const CompiledScene scene = test::compiled_objects(R"({"type": "sphere", "radius": 1, "name": ")" + odd + R"("})");
  check_round_trips(scene);
}

// Each pattern uses the previous pattern twice, so each doubles the work per point.
TEST_CASE("patterns that share others may not make a point arbitrarily expensive", "[artefact]") {
  CompiledScene scene = test::compiled_objects(R"({"type": "sphere", "radius": 1})");
  scene.textures = {glm::dvec3(1)};
  const auto add = [&] {
    const auto last = static_cast<std::uint32_t>(scene.textures.size() - 1);
    compiler::Pattern pattern{};
    pattern.kind = compiler::Pattern::Checker{};
    pattern.a = pattern.b = last;
    scene.textures.push_back(pattern);
  };
  for (int i = 0; i < 11; ++i) add();
  CHECK(reason_of(compiler::write_file(scene, {true, false})).empty());
  add();
  CHECK_THAT(reason_of(compiler::write_file(scene, {true, false})), Contains("evaluates 8190 others at each point"));
}

TEST_CASE("a program alone has as many surfaces as its tags name", "[artefact]") {
  FileContents contents;
  CHECK(reread("sphere 1\ntag 0\nsphere 1 at 3 0 0\ntag 2\nmin\n", contents).surfaces.size() == 3);
}

}  // namespace fathom::test::artefact_test
