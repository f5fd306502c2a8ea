// Compiled scenes as bytes and as text: both forms read back as the same scene. The reader refuses every wrong part
// of a file and names its position, and whatever the reader accepts is valid.
#include <bit>
#include <catch2/catch.hpp>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "compiler/artefact/listing.h"
#include "compiler/artefact/load.h"
#include "compiler/artefact/programs.h"
#include "tests/support/compiled.h"
#include "tests/support/draw_small.h"
#include "tests/support/effort.h"
#include "tests/support/golden.h"
#include "tests/support/sealed_file.h"
#include "vm/interpret/evaluate.h"
#include "vm/prune/expression.h"

namespace fathom::test::artefact_test {
namespace {

namespace fs = std::filesystem;
using compiler::CompiledScene;
using compiler::FileContents;
using compiler::FileError;
using Bytes = std::vector<std::uint8_t>;
using Catch::Matchers::Contains;

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
  auto file = compiler::open_file(bytes);
  if (const auto* error = std::get_if<FileError>(&file)) FAIL(error->reason);
  auto scene = compiler::read_file(std::get<compiler::CompiledFile>(file), "test.fbc");
  if (const auto* error = std::get_if<FileError>(&scene)) FAIL(error->reason);
  return std::get<CompiledScene>(std::move(scene));
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
    const bool few_cases = few(8) < 8;
    if (few_cases && entry.file_size() > 500'000) continue;
    INFO(entry.path().string());
    check_round_trips(tests::compiled(tests::read_file(entry.path())));
    ++count;
  }
  CHECK(count >= 20);
}

TEST_CASE("all that a scene can say reads back, with and without places and text", "[artefact]") {
  const CompiledScene scene = tests::compiled(kEverything);
  REQUIRE(scene.media.size() == 1);
  REQUIRE(scene.lamps.size() == 1);
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
  const vm::Digest digest = compiler::scene_digest(tests::compiled_objects(ball));
  CHECK(compiler::scene_digest(tests::compiled_objects("  " + ball)) == digest);
  CHECK_FALSE(compiler::scene_digest(tests::compiled_objects(R"({"type": "sphere", "radius": 1.0000001})")) ==
              digest);
  CHECK_FALSE(compiler::scene_digest(tests::compiled(
                  R"({"version": 1, "camera": {"position": [0, 0, 6]}, "objects": [)" + ball + "]}")) == digest);
  CHECK_FALSE(compiler::scene_digest(
                  tests::compiled(R"({"version": 1, "render": {"spp": 17}, "objects": [)" + ball + "]}")) == digest);
}

TEST_CASE("a file that was cut or changed anywhere is refused", "[artefact]") {
  const Bytes bytes = compiler::write_file(tests::compiled(kEverything));
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
  const Sections parts = without_text(compiler::write_file(tests::compiled(kEverything)));
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
      vm::Expression().read(*row.program);
    }
    if (accepted % 16 == 0) draw_small(compiler::unproved(good->scene));
  };
  const std::size_t stride = few(8) == 8 ? 1 : 8;
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
  const Bytes good = compiler::write_file(tests::compiled(kEverything), {true, false});
  const Sections parts = sections_of(good);
  CHECK((sealed(parts) == good));
  const auto with = [&](auto change) {
    Sections changed = parts;
    change(changed);
    return reason_of(sealed(changed));
  };
  CHECK_THAT(reason_of({'{', '}'}), Contains("no compiled scene"));
  Bytes other = good;
  other[8] = 4;
  CHECK_THAT(reason_of(other),
             Contains("it is of version 4 of the format with 4 sections; this program reads version 3"));
  CHECK_THAT(reason_of({good.begin(), good.begin() + 10}), Contains("header is damaged or cut off"));
  CHECK_THAT(reason_of(sealed(parts, vm::Digest{1, 2})), Contains("another machine"));
  CHECK_THAT(with([](Sections& s) { s.code.push_back(0); }), Contains("goes on for 1 bytes after its last program"));
  CHECK_THAT(with([](Sections& s) { s.code.resize(4); }), Contains("`code` is cut off"));
  CHECK_THAT(with([](Sections& s) { s.code[0] = 200; }), Contains("`code` is cut off"));
  CHECK_THAT(with([](Sections& s) { s.code[24] = 0xff; }),
             Contains("program `distance` at byte 8 of the code, word 0: no opcode 255"));
  CHECK_THAT(with([](Sections& s) { s.tables.push_back(0); }), Contains("`tables` goes on"));
  CHECK_THAT(with([](Sections& s) { s.tables.pop_back(); }), Contains("`tables` is wrong at byte"));
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
  const std::string good = compiler::write_listing(tests::compiled(kEverything));
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
  CHECK_THAT(refused("fathom 3", "fathom 4"), Contains("test.txt:1:8: error: `3` should be here"));
  CHECK_THAT(refused("fov ", "fvo "), Contains("`fov` should be here"));
  CHECK_THAT(refused("blades 6", "blades 99"), Contains("99 is not in 0..32"));
  CHECK_THAT(refused("blades 6", "blades six"), Contains("this should be a whole number"));
  CHECK_THAT(refused("filter mitchell", "filter michell"), Contains("one of: box, tent"));
  CHECK_THAT(refused("position 0 1 5", "position 0 nan 5"), Contains("nan is not in"));
  CHECK_THAT(refused("program surface {", "program sorface {"),
             Contains("program `sorface` is out of order; `surface` should come here"));
  CHECK_THAT(refused("program formula 0 {", "  program"), Contains("neither a program nor the text"));
  CHECK_THAT(refused("\n}\nprogram surface", "\nprogram surface"), Contains("error"));
  CHECK_THAT(refused("sphere 0.5", "sphere 0.5 7"), Contains("`sphere` takes 1 numbers (radius), not 2"));
  CHECK_THAT(refused("tag 0", "tag 99"), Contains("tag 99: the scene has 4 surfaces"));
  CHECK_THAT(refused("|{", "{"), Contains("begins with |"));
  CHECK_THAT(refused("name \"ball\"", "name \"ba\\nll\""), Contains("a control character"));
}

TEST_CASE("a program alone becomes a scene of one surface, of which nothing is proved", "[artefact]") {
  FileContents contents;
  const CompiledScene ball = reread("sphere 1\n", contents);
  CHECK_FALSE(contents.debug);
  CHECK_FALSE(contents.text);
  CHECK(ball.surfaces.size() == 1);
  CHECK_FALSE(ball.certified);
  vm::Workspace workspace;
  CHECK(vm::evaluate_distance(ball.distance, glm::dvec3(0, 3, 0), workspace) == 2);
  check_round_trips(ball, contents);
}

TEST_CASE("what a file claims counts for nothing without the text", "[artefact]") {
  CompiledScene liar = tests::compiled_objects(R"({"type": "sphere", "radius": 1})");
  REQUIRE(liar.certified);
  const CompiledScene honest = compiler::unproved(liar);
  CHECK_FALSE(honest.certified);
  CHECK(honest.bound.finite());          // interval arithmetic proves that nothing lies outside
  CHECK(honest.lipschitz == Approx(1));  // proved by intervals, too
  CHECK_THAT(honest.summary, Contains("not proved") && !Contains("(proved)"));
  liar.lipschitz = 0.02;
  CHECK(compiler::unproved(liar).lipschitz == Approx(1));
  liar.contents = compiler::Box::centred(glm::dvec3(1e-3));
  CHECK(compiler::unproved(liar).contents.hi.x > 0.9);
  liar.bound = compiler::Box::centred(glm::dvec3(0.5));  // the ball is larger
  CHECK_FALSE(compiler::unproved(liar).bound.finite());
  const CompiledScene lit = tests::compiled(kEverything);
  REQUIRE(lit.lamps.size() == 1);
  CHECK(compiler::unproved(lit).lamps.empty());
  CHECK_FALSE(compiler::unproved(lit).media[0].certified);
}

TEST_CASE("a listing may come from a system that ends lines in two characters", "[artefact]") {
  const std::string listing = compiler::write_listing(tests::compiled(kEverything));
  std::string other;
  for (const char c : listing) other += c == '\n' ? "\r\n" : std::string(1, c);
  FileContents contents, same;
  CHECK(
      (compiler::write_file(reread(other, contents), contents) == compiler::write_file(reread(listing, same), same)));
}

TEST_CASE("names of any length and with any printable characters read back", "[artefact]") {
  const std::string odd = R"(; \" @3:4 | } program x { )" + std::string(70000, 'n') + "\u00e4";
  const CompiledScene scene = tests::compiled_objects(R"({"type": "sphere", "radius": 1, "name": ")" + odd + R"("})");
  check_round_trips(scene);
}

// Each pattern uses the previous pattern twice, so each doubles the work per point.
TEST_CASE("patterns that share others may not make a point dear without end", "[artefact]") {
  CompiledScene scene = tests::compiled_objects(R"({"type": "sphere", "radius": 1})");
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
