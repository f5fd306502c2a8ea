// Fuzz target for scenes in Fathom's own notation (compiler/frontend/text/read_text.h) and files that they import. A
// text compiles or has an error, formatting a formatted text changes nothing, and the text's JSON is the same scene.
#include <string>
#include <utility>
#include <vector>

#include "compiler/compile.h"
#include "compiler/frontend/formats/write_json.h"
#include "compiler/frontend/read_scene.h"
#include "compiler/frontend/text/format.h"
#include "compiler/frontend/text/parse/parser.h"
#include "tests/fuzz/check_scene.h"
#include "tests/fuzz/target.h"

namespace fathom::fuzz {
namespace {

constexpr const char* kTextLoops =
    "fathom 1\n// posts\nparam n(min = 1, max = 9, doc = \"how many\") = 3\nlet red = diffuse(color = [0.8, 0.1, x])\n"
    "def post(h, r = 0.1) = let top = h*2 in cylinder(r, h).translate([0, top, 0]) +{0.1} sphere(r)\n"
    "object \"posts\" [for i in 0..n: if i != 1: post(1 + random(i)/4).translate([i, 0, 0]).material(red)]\n"
    "object fold part = box([1, 1, 1]) for k in [0.1, 0.2]: part - sphere(k).onion(k)\n";
constexpr const char* kFoldedFormulas =
    "fathom 1\nlet f = fold s = 0 for c in [[1, 2], [3, 4]]: s + (x - c.x)^2*sin(c.y*y)\n"
    "object expression(let a = f let b = a*z in smoothstep(0, 1, a - b) - 1/3, half_size = [1, 1, 1])\n"
    "light \"sun\" directional(direction = [0, -1, 0])\nbackground sky(elevation = 30)\n";

constexpr const char* kImports =
    "fathom 1\nimport \"1\"(k = 2) as a\nimport \"2\" as b\nobject a.f(b.ball).material(a.red) + b.scene\n"
    "%%\nfathom 1\nimport \"2\" as c\nparam k(max = 3) = 1\nlet red = diffuse(color = k/4)\n"
    "def f(n) = n + c.ball.scale(k)\n%%\n{\"version\": 1, \"params\": {\"r\": 1}, \"nodes\": {\"ball\": {\"type\": "
    "\"sphere\", \"radius\": \"r/2\"}}, \"objects\": [{\"use\": \"ball\"}]}\n";

// Splits an input into files at lines of %%: the scene, and the files that it may import as "1", "2" ...
std::vector<std::string> files_of(const std::string& text) {
  constexpr std::string_view kMark = "\n%%\n";
  std::vector<std::string> files;
  for (std::size_t at = 0;;) {
    const std::size_t end = text.find(kMark, at);
    files.push_back(text.substr(at, end - at));
    if (end == text.npos) return files;
    at = end + kMark.size();
  }
}

compiler::ImportReader reader_of(std::vector<std::string> files) {
  return [files = std::move(files)](const std::string& path) -> std::variant<std::string, compiler::ImportFault> {
    const bool known = path.size() == 1 && path[0] > '0' && path[0] < static_cast<char>('0' + files.size());
    if (!known) return compiler::ImportFault{"no such file"};
    return files[static_cast<std::size_t>(path[0] - '0')];
  };
}

// Smaller limits, so that one input fits into its time.
compiler::Limits small_limits() {
  compiler::Limits limits;
  limits.steps = 20000;
  return limits;
}

}  // namespace

void run_text(Bytes input) {
  std::vector<std::string> files = files_of(to_text(input));
  if (files.size() > 10) files.resize(10);
  const std::string text = files[0];
  const compiler::ImportReader imports = reader_of(std::move(files));
  check_scene(text);
  compiler::Source source("a.fathom", text);
  compiler::Diagnostics diagnostics;
  const auto read = compiler::read_scene(source, diagnostics, small_limits(), {}, imports);
  promise(read.has_value() || diagnostics.has_errors(), "a scene or an error");
  diagnostics.print(source, compiler::ErrorFormat::Text);
  compiler::Diagnostics syntax;
  compiler::text::parse(source, syntax, small_limits());
  const std::string once = compiler::text::format_text(source);
  promise(syntax.has_errors() || compiler::text::format_text(compiler::Source("b.fathom", once)) == once,
          "what is laid out stays");
  if (!read || diagnostics.has_errors() || read->format != compiler::SceneFormat::Text) return;
  compiler::Diagnostics none;
  const auto kept = compiler::read_with_formulas(source, none, small_limits(), imports);
  promise(kept.has_value(), "what is read once is read again");
  check_scene(compiler::write_json(kept->file));
}

std::vector<Input> seeds_of_text() {
  std::vector<Input> seeds = {to_input(kTextLoops), to_input(kFoldedFormulas), to_input(kImports)};
  for (Input& input : golden_inputs("E08")) seeds.push_back(std::move(input));
  return seeds;
}

}  // namespace fathom::fuzz
