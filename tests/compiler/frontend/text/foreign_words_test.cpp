// Words and habits of GLSL, OpenSCAD and other programs get an answer that says how a text writes them.
#include <string>

#include "compiler/compile.h"
#include "tests/support/catch.h"

namespace fathom::foreign_words_test {
namespace {

std::string errors_of(const std::string& body) {
  const compiler::Source source("a.fathom", "fathom 1\n" + body + "\n");
  compiler::Diagnostics diagnostics;
  CHECK_FALSE(compiler::compile(source, diagnostics, {}));
  return diagnostics.print(source, compiler::ErrorFormat::Text);
}

}  // namespace

TEST_CASE("text: words of other programs get the right spelling", "[frontend][text]") {
  struct Case {
    const char *body, *help;
  };
  for (const Case& each : {
           Case{"object min(sphere(1), box([1, 1, 1]))", "a union is written a + b"},
           {"object max(sphere(1), box([1, 1, 1]))", "an intersection is written a & b"},
           {"object mix(sphere(1), box([1, 1, 1]), 0.5)", "morph(a, b, t = 0.5)"},
           {"object mod(sphere(1), 2)", "body.repetition(period"},
           {"object morph(sphere(1), box([1, 1, 1]), 0.5)", "is named, as t = 0.5"},
           {"object sphere(1).translate(vec3(1, 2, 3))", "a vector is a list: [1, 2, 3]"},
           {"object sphere(1).repeat([3, 3, 3])", "body.repetition(period"},
           {"object fillet(box([1, 1, 1]), 0.1)", "a +{round = 0.1} b"},
           {"object smin(sphere(1), box([1, 1, 1]), 0.1)", "a +{0.1} b"},
           {"object box([1, 1, 1]).rotate(45)", "[0, 45, 0] turns about y"},
           {"object sphere 1", "a call has parentheses: sphere(1)"},
           {"object text(\"hi\")", "there are no letters"},
           {"object thread(1)", "import \"std/screws\" as screws"},
           {"object minkowski(box([1, 1, 1]), sphere(0.1))", "body.round(0.1)"},
           {"object hull(sphere(1), box([1, 1, 1]))", "there is no hull"},
           {"object fog(0.1)", "transparent(absorption"},
           {"object sphere(1) * 2", "body.scale(2)"},
       }) {
    CAPTURE(each.body);
    CHECK_THAT(errors_of(each.body), Catch::Contains(each.help));
  }
}

}  // namespace fathom::foreign_words_test
