// Tests of `fathom emit glsl`. The reference compiler checks that the output is GLSL. The values are checked by
// compiling the output with these tests as C++ over GLM, whose names are GLSL's.
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <glm/glm.hpp>
#include <regex>
#include <sstream>
#include <string>
#include <string_view>

#include "compiler/emit/emit.h"
#include "compiler/emit/language.h"
#include "emitted_programs_glsl.h"
#include "tests/support/catch.h"
#include "tests/support/compiled.h"
#include "tests/support/emitted_programs.h"
#include "tests/support/not_run.h"
#include "tests/support/random/random_scene.h"
#include "tests/support/temporary_folder.h"
#include "vm/interpret/evaluate.h"

namespace fathom::test::emitted_glsl_test {
namespace {

// True if the text calls a function whose accuracy GLSL does not specify.
bool has_elementary(const std::string& text) {
  static const std::regex kCall("[^_a-z](sin|cos|tan|exp|log|atan)\\(");
  return std::regex_search(text, kCall);
}

// Fragment shader that calls every function, so that the compiler checks all of them.
std::string shader(const std::string& version) {
  std::string text = "#version " + version + "\nprecision highp float;\nout vec4 colour;\n", sum;
  for (const EmittedProgram& program : emitted_programs()) {
    text += compiler::emit_glsl(program.scene, program.name, true);
    sum += "  d += " + program.name + "_distance(colour.xyz) + float(" + program.name + "_surface(colour.xyz));\n";
  }
  for (const char* path : {"scenes/showcase.json", "scenes/bench/b-csg.json", "scenes/bench/e-gyroid.json",
                           "scenes/bench/h-composite.json", "scenes/mandelbulb.json", "tests/data/molecule.json"}) {
    std::stringstream file;
    file << std::ifstream(std::string(FATHOM_SOURCE_DIR "/") + path).rdbuf();
    const std::string name = std::filesystem::path(path).stem().string().substr(2);
    text += compiler::emit_glsl(test::compiled(file.str()), name);
    sum += "  d += " + name + "_distance(colour.xyz);\n";
  }
  return text + "void main() {\n  colour = gl_FragCoord;\n  float d = 0.0;\n" + sum + "  colour = vec4(d);\n}\n";
}

// Returns the functions of emitted GLSL without comments and parentheses, which templates do not have or need.
std::string bare(const std::string& text) {
  static const std::regex kComment(" *//[^\n]*\n"), kParenthesis("[()]");
  const std::string code = std::regex_replace(text, kComment, "\n");
  return std::regex_replace(code.substr(code.find_first_not_of('\n')), kParenthesis, "");
}

// Returns a template's functions with their numbers in place.
std::string filled(const compiler::GlslTemplate& glsl) {
  static const std::regex kNumber("[A-Za-z0-9_]+_numbers\\[([0-9]+)\\]\\.([xyzw])");
  const std::string& text = glsl.text;
  std::string result;
  std::size_t at = 0;
  for (std::sregex_iterator found(text.begin(), text.end(), kNumber), end; found != end; ++found) {
    const std::size_t i = 4 * std::stoul(found->str(1)) + std::string("xyzw").find(found->str(2));
    const auto place = static_cast<std::size_t>(found->position());
    result += text.substr(at, place - at) + compiler::kGlsl.literal(glsl.numbers.at(i));
    at = place + found->str().size();
  }
  return result + text.substr(at);
}

}  // namespace

TEST_CASE("a template of emitted GLSL with its numbers is the emitted GLSL", "[emit]") {
  for (const EmittedProgram& program : emitted_programs()) {
    if (program.name.starts_with("rows")) continue;  // templates have no loops
    const compiler::GlslTemplate glsl = compiler::emit_glsl_template(program.scene, program.name);
    CAPTURE(program.name);
    CHECK(glsl.numbers.size() % 4 == 0);
    CHECK(bare(filled(glsl)) == bare(compiler::emit_glsl(program.scene, program.name, true)));
  }
}

TEST_CASE("scenes that differ only in numbers and names have the same template of GLSL", "[emit]") {
  const auto glsl_of = [](const std::string& name, const std::string& radius, const std::string& blend) {
    return compiler::emit_glsl_template(
        test::compiled_objects(R"({"name": ")" + name + R"(", "type": "smooth_union", "k": )" + blend +
                               R"(, "of": [{"type": "sphere", "radius": )" + radius +
                               R"(}, {"type": "box", "half_size": [1, 2, 3], "translate": [1, 0, )" + radius +
                               "]}]}"),
        "scene");
  };
  const compiler::GlslTemplate a = glsl_of("a", "1.5", "0.3"), b = glsl_of("other", "1.625", "0.2");
  CHECK(a.text == b.text);
  CHECK(a.numbers != b.numbers);
  CHECK(a.numbers.size() == b.numbers.size());
}

// Devices need not have room for more.
TEST_CASE("a template of GLSL has more numbers than a uniform block holds in its text", "[emit]") {
  const auto glsl_of = [](int count) {
    std::string spheres;
    for (int i = 0; i < count; ++i) {
      spheres += (i > 0 ? ", " : "") + fmt::format(R"({{"type": "sphere", "radius": {}, "translate": [{}, 0, 1]}})",
                                                   0.25 + i * 0.001, 3 * i + 2);
    }
    return compiler::emit_glsl_template(test::compiled_objects(spheres), "scene");
  };
  const compiler::GlslTemplate some = glsl_of(300), many = glsl_of(1200);
  CHECK(some.numbers.size() >= 4 * 300);
  CHECK(some.text.find("scene_numbers") != some.text.npos);
  CHECK(many.numbers.size() == 4);
  CHECK(many.text.find("scene_numbers") == many.text.npos);
}

TEST_CASE("emitted GLSL is GLSL ES 3.00 and GLSL 3.30", "[emit]") {
  if (std::string_view(FATHOM_GLSLANG).empty()) return test::not_run("glslangValidator is missing");
  const test::TemporaryFolder folder;
  for (const char* version : {"300 es", "330"}) {
    std::ofstream(folder.path() / "scene.frag") << shader(version);
    const std::string command = "cd '" + folder.path().string() + "' && '" FATHOM_GLSLANG "' scene.frag > log";
    CAPTURE(version);
    CHECK(std::system(command.c_str()) == 0);
    std::string line;
    for (std::ifstream log(folder.path() / "log"); std::getline(log, line);) UNSCOPED_INFO(line);
    std::ofstream(folder.path() / "scene.frag") << shader(version) + "float broken = true;\n";
    CHECK(std::system(command.c_str()) != 0);  // the reference compiler does detect errors
  }
}

TEST_CASE("emitted GLSL computes what the machine does", "[emit]") {
  const auto programs = emitted_programs();
  REQUIRE(programs.size() == std::size(kEmittedGlsl));
  vm::Workspace workspace;
  std::size_t surfaces_seen = 0;
  for (std::size_t i = 0; i < programs.size(); ++i) {
    const compiler::CompiledScene& scene = programs[i].scene;
    CAPTURE(programs[i].name);
    REQUIRE(programs[i].name == kEmittedGlsl[i].name);
    const bool exact = !has_elementary(compiler::emit_glsl(scene, "scene"));
    Random random(i);
    std::size_t wrong = 0, wrong_surfaces = 0;
    for (int n = 0; n < 2000; ++n) {
      const glm::vec3 p(random.in_box(2)), q = p - glm::vec3(scene.origin);
      float machine;
      vm::evaluate_distance(scene.distance, {&q.x, &q.y, &q.z}, 1, &machine, workspace);
      const float glsl = kEmittedGlsl[i].distance(p);
      const float allowed = exact ? 0 : 2e-5f * std::max(1.f, std::fabs(machine));
      const bool both_nan = std::isnan(glsl) && std::isnan(machine);
      wrong += !both_nan && !(glsl == machine) && !(std::fabs(glsl - machine) <= allowed);
      std::uint32_t surface;
      float d, gx, gy, gz;
      vm::evaluate_surface(scene.surface, {&q.x, &q.y, &q.z}, 1, {&d, &gx, &gy, &gz, &surface, nullptr}, workspace);
      wrong_surfaces += exact && kEmittedGlsl[i].surface(p) != static_cast<int>(surface);
      surfaces_seen += surface > 0;
    }
    CHECK(wrong == 0);
    CHECK(wrong_surfaces == 0);
  }
  CHECK(surfaces_seen > 20000);
}

}  // namespace fathom::test::emitted_glsl_test
