// Texts with imports: the meaning of imported names, the lookup of files, and scenes that are equal however they are
// split into files.
#include <map>

#include "compiler/artefact/compiled_file.h"
#include "compiler/artefact/listing.h"
#include "compiler/compile.h"
#include "compiler/frontend/formats/write_json.h"
#include "tests/support/catch.h"

namespace fathom::text_imports_test {

namespace {

using namespace fathom::compiler;

using Files = std::map<std::string, std::string>;

ImportReader reader_of(const Files& files) {
  return [&files](const std::string& path) -> std::variant<std::string, ImportFault> {
    const auto found = files.find(path);
    if (found == files.end()) return ImportFault{"no such file"};
    return found->second;
  };
}

// Returns the scene's objects, nodes and materials as JSON, or the code of its first error.
std::string json_of(const std::string& text, const Files& files) {
  Source source("a.fathom", "fathom 1\n" + text);
  Diagnostics diagnostics;
  const auto read = read_scene(source, diagnostics, {}, {}, reader_of(files));
  if (diagnostics.has_errors()) return diagnostics.all()[0].code;
  std::string json = write_json(read->file);
  std::erase(json, '\n'), std::erase(json, ' ');
  return json;
}

std::optional<CompiledScene> compiled(const std::string& text, const Files& files) {
  Diagnostics diagnostics;
  CompileOptions options;
  options.imports = reader_of(files);
  Source whole;
  options.on_source = [&](const Source& source) { whole = source; };
  auto scene = compile(Source("a.fathom", text), diagnostics, options);
  INFO(diagnostics.print(whole, ErrorFormat::Text));
  CHECK(scene);
  return scene;
}

bool equal(vm::Digest a, vm::Digest b) { return a.low == b.low && a.high == b.high; }

const Files kFiles = {
    {"lib/a.fathom", "fathom 1\nparam r(max = 9) = 1\nlet red = diffuse(color = r/10)\ndef ball(n) = sphere(n*r)\n"
                     "import \"b.fathom\"(k = 2*r) as b\nlet twice = b.cube + b.cube\nobject \"o\" ball(3)\n"},
    {"lib/b.fathom", "fathom 1\nparam k = 1\nlet cube = box([k, k, k])\nobject cube\nobject sphere(-1)\n"},
};

TEST_CASE("imports: names of files stand for what they are there", "[frontend][text]") {
  CHECK(json_of("import \"lib/a.fathom\" as a\nobject a.ball(2).material(a.red)", kFiles) ==
        R"({"version":1,"materials":{"red":{"type":"diffuse","color":0.1}},"objects":[{"type":"sphere","radius":2,"material":"red"}]})");
  CHECK(json_of("import \"lib/a.fathom\"(r = 4) as a\nobject a.ball(2)", kFiles) ==
        R"({"version":1,"objects":[{"type":"sphere","radius":8}]})");
  CHECK(json_of("import \"lib/a.fathom\" as a\nobject a.scene", kFiles) ==
        R"({"version":1,"objects":[{"type":"union","of":[{"type":"sphere","radius":3,"name":"o"}]}]})");
  // A file is a function of its parameters, here called through another file.
  CHECK(json_of("import \"lib/a.fathom\"(r = 4) as a\nobject a.twice", kFiles) ==
        R"({"version":1,"nodes":{"cube":{"type":"box","half_size":[8,8,8]}},"objects":[{"type":"union","of":[{"use":"cube"},{"use":"cube"}]}]})");
  CHECK(json_of("param s = 2\nlet t = s + 1\nimport \"lib/b.fathom\"(k = t*s) as b\nobject b.cube", kFiles) ==
        R"({"version":1,"params":{"s":2},"objects":[{"type":"box","half_size":[6,6,6]}]})");
}

TEST_CASE("imports: the library is there without a file", "[frontend][text]") {
  const std::string screw = "object screws.nut(1)";
  const std::string from_library = json_of("import \"std/screws\" as screws\n" + screw, {});
  CHECK(from_library.find("objects") != std::string::npos);
  CHECK(json_of("import \"std/screws.fathom\" as screws\n" + screw, {}) == from_library);
  // From a file in a folder, and by two names: one file.
  const Files files = {{"parts/a.fathom", "fathom 1\nimport \"std/screws\" as screws\nlet nut = screws.nut(1)\n"}};
  CHECK(json_of("import \"parts/a.fathom\" as a\nobject a.nut", files) == from_library);
  CHECK(json_of("import \"std/sprockets\" as s\nobject s.x", {}) == "E0810");
}

TEST_CASE("imports: a local name hides a file's", "[frontend][text]") {
  CHECK(json_of("import \"lib/a.fathom\" as a\nlet b = a.red\nobject [for a in [[1, 2, 3]]: sphere(a.x)].material(b)",
                kFiles) ==
        R"({"version":1,"materials":{"b":{"type":"diffuse","color":0.1}},"objects":[{"type":"union","of":[{"type":"sphere","radius":1}],"material":"b"}]})");
}

// The sphere of radius -1 in lib/b.fathom is never evaluated.
TEST_CASE("imports: of a file only what is asked for is evaluated", "[frontend][text]") {
  CHECK(json_of("import \"lib/b.fathom\" as b\nobject b.cube", kFiles).starts_with("{"));
}

TEST_CASE("imports: scenes of other formats", "[frontend][text]") {
  const Files files = {{"ball.json", R"({"version": 1, "params": {"r": 0.5}, "materials": {"red": {"type": "diffuse"}},
    "nodes": {"ball": {"type": "sphere", "radius": "2*r", "material": "red"}}, "objects": [{"use": "ball"}]})"},
                       {"plane.vm", "_0 var-z\n_1 const 1\n_2 sub _0 _1\n"}};
  CHECK(json_of("import \"ball.json\"(r = 3) as b\nobject b.ball", files) ==
        R"({"version":1,"materials":{"red":{"type":"diffuse"}},"objects":[{"type":"sphere","radius":6,"material":"red"}]})");
  CHECK(json_of("import \"ball.json\" as b\nobject b.scene + sphere(1)", files).starts_with("{"));
  CHECK(json_of("import \"plane.vm\" as p\nobject p.scene & sphere(1)", files).find("expression") != std::string::npos);
}

TEST_CASE("imports: there is an end to them", "[frontend][text]") {
  Files files;
  std::string many;
  for (int i = 0; i < 300; ++i) {
    files[std::to_string(i)] = "fathom 1\nlet s = sphere(1)\n";
    many += "import \"" + std::to_string(i) + "\" as s" + std::to_string(i) + "\n";
  }
  CHECK(json_of(many + "object s1.s", files) == "E0810");
  // Each file imports the next one twice, with values: 2^40 modules without a limit.
  for (int i = 0; i < 40; ++i) {
    const std::string next = "import \"" + std::to_string(i + 1) + "\"(k = 1) as ";
    files[std::to_string(i)] = "fathom 1\nparam k = 1\n" + next + "a\n" + next + "b\nlet s = a.s + b.s\n";
  }
  files["40"] = "fathom 1\nparam k = 1\nlet s = sphere(k)\n";
  CHECK(json_of("import \"0\" as a\nobject a.s", files) == "E0810");
  // Without values the same files are 41 shared modules.
  for (int i = 0; i < 40; ++i) {
    const std::string next = "import \"" + std::to_string(i + 1) + "\" as ";
    files[std::to_string(i)] = "fathom 1\n" + next + "a\n" + next + "b\nlet s = a.s + b.s\n";
  }
  CHECK(json_of("import \"0\" as a\nobject a.s", files).size() < 8000);
  CHECK(json_of("import \"a.fathom\" as a\nobject a.s", {{"a.fathom", "fathom 1\n"}}) == "E0810");  // imports itself
  const Files circle = {{"b", "fathom 1\nimport \"c\" as c\nlet s = c.s\n"}, {"c", "fathom 1\nimport \"b\" as b\n"}};
  CHECK(json_of("import \"b\" as b\nimport \"c\" as c\nobject b.s + c.s", circle) == "E0810");
}

TEST_CASE("imports: the limits are of all files together", "[frontend][text]") {
  const Files files = {{"b", "fathom 1\n//" + std::string(1000, ' ') + "\nlet s = sphere(1)\n"}};
  for (const double most : {500.0, 2000.0}) {
    Limits limits;
    limits.file_size = most;
    Source source("a.fathom", "fathom 1\nimport \"b\" as b\nobject b.s");
    Diagnostics diagnostics;
    read_scene(source, diagnostics, limits, {}, reader_of(files));
    CHECK(diagnostics.has_errors() == (most < 1000));
    if (diagnostics.has_errors()) CHECK(diagnostics.all()[0].code == "E0008");
  }
  Limits limits;
  limits.tokens = 12;  // both files together have more tokens, neither alone does
  Source source("a.fathom", "fathom 1\nimport \"b\" as b\nobject b.s");
  Diagnostics diagnostics;
  read_scene(source, diagnostics, limits, {}, reader_of({{"b", "fathom 1\nlet s = sphere(1)"}}));
  CHECK((diagnostics.has_errors() && diagnostics.all()[0].code == "E0008"));
}

TEST_CASE("imports: compiled files and listings carry them", "[frontend][text]") {
  const std::string text = "fathom 1\nimport \"lib/a.fathom\"(r = 4) as a\nobject a.twice\nobject a.ball(1)\n";
  const auto scene = compiled(text, kFiles);
  const auto bytes = write_file(*scene);
  const auto stored = read_stored(bytes, "x/a.fbc");
  REQUIRE(std::holds_alternative<StoredScene>(stored));
  const auto& back = std::get<StoredScene>(stored);
  REQUIRE(back.scene.source.imports().size() == 2);
  CHECK(back.scene.source.imports()[0].path == "lib/a.fathom");
  CHECK(back.scene.source.imports()[1].file->name() == "x/lib/b.fathom");
  Diagnostics diagnostics;
  const auto again = compile(back.scene.source, diagnostics);  // reads no file
  REQUIRE(again);
  CHECK(equal(scene_digest(*again), scene_digest(*scene)));
  const std::string listing = write_listing(*scene, {});
  FileContents contents;
  const auto listed = read_listing(Source("a.txt", listing), diagnostics, contents);
  REQUIRE(listed);
  CHECK(listed->source.imports().size() == 2);
  CHECK(write_listing(*listed, contents) == listing);
  CHECK(write_file(*listed, contents) == bytes);
  // Paths that lead out of the folder, absolute paths and duplicates are refused.
  for (const char* path : {"/etc/a.fathom", "lib/../a.fathom", "", "lib/b.fathom"}) {
    Source source("a.fathom", text);
    CHECK(add_import(source, "lib/b.fathom", "fathom 1\n"));
    CHECK(!add_import(source, path, "fathom 1\n"));
  }
}

TEST_CASE("imports: instructions tell the file that they are of", "[frontend][text]") {
  const auto scene = compiled("fathom 1\nimport \"lib/a.fathom\" as a\nobject a.ball(2)\n", kFiles);
  const auto& debug = scene->distance.program().debug;
  REQUIRE(!debug.empty());
  CHECK(debug.back().line == 4);
  CHECK(debug.back().symbol == "sphere in lib/a.fathom");
}

}  // namespace

}  // namespace fathom::text_imports_test
