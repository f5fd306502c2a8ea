// Scenes in Fathom's own notation (compiler/frontend/text/read_text.h): what is read compiles or is an error, its
// layout is kept by laying it out, and its JSON is the same scene.
#include <string>

#include "compiler/compile.h"
#include "compiler/frontend/text/format.h"
#include "compiler/frontend/text/parser.h"
#include "compiler/frontend/text/read_text.h"
#include "compiler/frontend/write_json.h"
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

// A smaller world, for all of it to fit into the time of one input.
compiler::Limits small_limits() {
  compiler::Limits limits;
  limits.steps = 20000;
  return limits;
}

}  // namespace

void run_text(Bytes input) {
  const std::string text = to_text(input);
  check_scene(text);
  const compiler::Source source("a.fathom", text);
  compiler::Diagnostics diagnostics;
  const auto read = compiler::read_text_scene(source, {}, small_limits(), diagnostics);
  promise(read.has_value() || diagnostics.has_errors(), "a scene or an error");
  diagnostics.print(source, compiler::ErrorFormat::Text);
  compiler::Diagnostics syntax;
  compiler::text::parse(source, syntax, small_limits());
  const std::string once = compiler::text::format_text(source);
  promise(syntax.has_errors() || compiler::text::format_text(compiler::Source("b.fathom", once)) == once,
          "what is laid out stays");
  if (!read || diagnostics.has_errors()) return;
  compiler::Diagnostics none;
  const auto kept = compiler::read_text_with_formulas(source, small_limits(), none);
  promise(kept.has_value(), "what is read once is read again");
  check_scene(compiler::write_json(kept->file));
}

std::vector<Input> seeds_of_text() {
  std::vector<Input> seeds = {to_input(kTextLoops), to_input(kFoldedFormulas)};
  for (Input& input : golden_inputs("E08")) seeds.push_back(std::move(input));
  return seeds;
}

}  // namespace fathom::fuzz
