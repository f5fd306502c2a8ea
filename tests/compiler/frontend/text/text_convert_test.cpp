// Conversion from JSON to text and back loses nothing.
#include <cstdlib>
#include <filesystem>
#include <string>

#include "compiler/artefact/compiled_file.h"
#include "compiler/compile.h"
#include "compiler/frontend/formats/write_json.h"
#include "compiler/frontend/read_scene.h"
#include "compiler/frontend/text/format.h"
#include "compiler/frontend/text/print.h"
#include "compiler/frontend/text/read_text.h"
#include "tests/support/catch.h"
#include "tests/support/golden.h"
#include "tests/support/import_folder.h"
#include "tests/support/random/random_document.h"
#include "tests/support/scaled_cases.h"

namespace fathom::text_convert_test {

namespace {

using namespace fathom::compiler;
using fathom::test::canonical;

// Converts JSON to text and back. Returns the canonical form of the result.
std::string there_and_back(const syntax::File& file, const std::string& json) {
  const std::string text = text::print_text(file, Source("a.json", json));
  Source source("a.fathom", text);
  Diagnostics diagnostics;
  const auto kept = read_text_with_formulas(source, {}, diagnostics);
  INFO(text);
  INFO(diagnostics.print(source, ErrorFormat::Text));
  REQUIRE(kept);
  return canonical(kept->file.root);
}

TEST_CASE("text: documents come back from text as they were", "[frontend][text]") {
  const char* count = std::getenv("FATHOM_DOCUMENTS");  // 10,000 take 20 seconds
  const int documents = count ? std::atoi(count) : test::scaled_cases(1000);
  for (int i = 0; i < documents; ++i) {
    test::Random random(static_cast<std::uint64_t>(i));
    const syntax::File file = test::random_document(random);
    const std::string expected = canonical(file.root);
    CAPTURE(i);
    REQUIRE(there_and_back(file, write_json(file)) == expected);
  }
}

std::string digest_of(const Source& source) {
  Diagnostics diagnostics;
  const auto scene = compile(source, diagnostics, {});
  INFO(diagnostics.print(source, ErrorFormat::Text));
  REQUIRE(scene);
  const vm::Digest digest = scene_digest(*scene);
  return std::string(reinterpret_cast<const char*>(&digest), sizeof(digest));
}

// The conversion to JSON expands loops and functions, and keeps formulas and parameters.
TEST_CASE("text: the JSON scene of a text is the same scene", "[frontend][text]") {
  const char* const texts[] = {
      "param n = 7\nobject \"posts\" [for i in 0..n: cylinder(0.1 + 0.02*i, random(i)).translate([i, 0, 0])]",
      "param r(min = 0.1) = 0.5\nlet d = 2*r\nobject sphere(d + 1/3).translate([d^2, sqrt(r), -r])",
      "def wave(n) = 0.01*sin(n*x)*sin(n*y)\nobject sphere(1).displacement(wave(20) + wave(31))",
      ("let skin = principled(color = [0.2 + 0.6*smoothstep(0, 1, x), 0.3, clamp(y, 0, 1)])\n"
       "object box([1, 1, 1]).material(skin)"),
      "object expression(let a = x*y let b = a + a in (a*b - a)/4 + z, half_size = [1, 1, 1])",
  };
  for (const char* const body : texts) {
    CAPTURE(body);
    Source text("a.fathom", std::string("fathom 1\n") + body);
    Diagnostics diagnostics;
    const auto kept = read_text_with_formulas(text, {}, diagnostics);
    REQUIRE(kept);
    const Source json("a.json", write_json(kept->file));
    CAPTURE(json.text());
    CHECK(digest_of(json) == digest_of(text));
  }
}

// Two values of one name met in a formula, and normalize() took a number: both wrote the parameter's default.
TEST_CASE("text: all arithmetic with parameters stays a formula in JSON", "[frontend][text]") {
  const char* const texts[] = {
      ("param t = 0.3\n"
       "def hop(u) = let s = u - floor(u) in 4*s*(1 - s)\n"
       "def ball(u) = let s = 1 - 0.25*hop(u) in sphere(s).scale([1/sqrt(s), s, 1/sqrt(s)])\n"
       "object ball(t)"),
      "param t = 0.3\nobject sphere(1).translate(normalize([t, 1, t*t]))",
      "param t = 0.3\nlet v = [t, 2, 1]\nobject box(v/2).translate([length(v), dot(v, v), max(t, 1)^2])",
      "param t = 0.3\nobject sphere(fold s = 1 for i in 0..4: s + sqrt(t*i)/(i + 1))",
  };
  for (const char* const body : texts) {
    CAPTURE(body);
    Source text("a.fathom", std::string("fathom 1\n") + body);
    Diagnostics diagnostics;
    const auto kept = read_text_with_formulas(text, {}, diagnostics);
    REQUIRE(kept);
    CHECK(kept->frozen.empty());
    const std::string json = write_json(kept->file);
    CAPTURE(json);
    for (const char* const value : {"0.3", "0.7"}) {
      const auto at = [&](const std::string& param, std::string from) {
        return digest_of(Source("a", from.replace(from.find(param), param.size(), param.substr(0, param.size() - 3) + value)));
      };
      CHECK(at("\"t\": 0.3", json) == at("param t = 0.3", std::string("fathom 1\n") + body));
    }
  }
}

TEST_CASE("text: the project's scenes come back as they were, and are one scene in both notations",
          "[frontend][text]") {
  int scenes = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(FATHOM_SOURCE_DIR "/scenes")) {
    if (entry.path().extension() != ".json") continue;
    Source json(entry.path().string(), test::read_file(entry.path()));
    CAPTURE(entry.path().string());
    Diagnostics diagnostics;
    const auto read = read_scene(json, diagnostics);
    REQUIRE(read);
    CHECK(there_and_back(read->file, json.text()) == canonical(read->file.root));
    const Source text(entry.path().string() + ".fathom", text::print_text(read->file, json));
    CHECK(digest_of(text) == digest_of(json));
    ++scenes;
  }
  CHECK(scenes > 20);
}

TEST_CASE("text: the project's texts are one scene as JSON", "[frontend][text][released]") {
  int scenes = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(FATHOM_SOURCE_DIR "/scenes")) {
    if (entry.path().extension() != ".fathom") continue;
    Source text(entry.path().string(), test::read_file(entry.path()));
    CAPTURE(entry.path().string());
    Diagnostics diagnostics;
    const auto kept = read_with_formulas(text, diagnostics, {}, test::imports_from(entry.path().parent_path()));
    REQUIRE(kept);
    CHECK(digest_of(Source("a.json", write_json(kept->file))) == digest_of(text));
    CHECK(text::format_text(text) == text.text());
    ++scenes;
  }
  CHECK(scenes >= 2);
}

TEST_CASE("text: noise the pattern and noise the function are told apart, there and back", "[frontend][text]") {
  Source source("a.fathom", R"(fathom 1
param height = 0.5
param octaves = 5
let soil = diffuse(color = noise(scale = 2, octaves = 3, a = [0.2, 0.1, 0], b = 0.8))
let ground = y - height*fbm(x, 0, z, octaves) + 0.1*noise(3*x, noise(y, z, 0.5), z)
object expression(ground, half_size = [2, 1, 2]).material(soil)
)");
  Diagnostics diagnostics;
  const auto kept = read_text_with_formulas(source, {}, diagnostics);
  INFO(diagnostics.print(source, ErrorFormat::Text));
  REQUIRE(kept);
  const std::string json = write_json(kept->file);
  CAPTURE(json);
  CHECK(json.find("\"pattern\": \"noise\"") != json.npos);
  CHECK(json.find("fbm(x, 0, z, octaves)") != json.npos);
  CHECK(json.find("noise(3*x, noise(y, z, 0.5), z)") != json.npos);
  CHECK(digest_of(Source("a.json", json)) == digest_of(source));
  Source converted("a.json", json);
  const auto read = read_scene(converted, diagnostics);
  REQUIRE(read);
  CHECK(there_and_back(read->file, json) == canonical(read->file.root));
}

}  // namespace

}  // namespace fathom::text_convert_test
