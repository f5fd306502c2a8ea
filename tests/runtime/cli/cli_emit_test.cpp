// End-to-end tests of `fathom emit`.
#include <string>

#include "tests/support/catch.h"
#include "tests/support/program.h"

namespace fathom::test::cli_emit_test {
namespace {

bool contains(const std::string& text, const std::string& part) { return text.find(part) != text.npos; }

}  // namespace

TEST_CASE("emit writes a header or a shader's functions", "[cli][emit]") {
  const Folder folder;
  const Result header = folder.run("emit cpp ball.json");
  CHECK(header.code == 0);
  CHECK(header.err.empty());
  CHECK(contains(header.out, "namespace fathom_scene {"));
  CHECK(contains(header.out, "// ball.json: "));
  CHECK(folder.run("emit cpp ball.json -o ball.h").code == 0);
  CHECK(folder.read("ball.h") == header.out);
  CHECK(contains(folder.run("emit cpp ball.json --namespace my::ball").out, "my::ball::distance(T x, T y, T z)"));
  CHECK(contains(folder.run("emit glsl ball.json").out, "\nfloat scene_distance(vec3 p) {"));
  const std::string surfaces = folder.run("emit glsl ball.json --surfaces").out;
  CHECK(contains(surfaces, "\nint scene_surface(vec3 p) {"));
  CHECK(contains(surfaces, "\n//     0  "));
  CHECK(folder.run("emit html ball.json").out.starts_with("<!doctype html>"));
  CHECK(contains(folder.run("emit glsl - --name ball", kBall).out, "\nfloat ball_distance(vec3 p) {"));
}

TEST_CASE("emit says what it cannot do", "[cli][emit]") {
  const Folder folder;
  const auto refused = [&](const std::string& arguments, int code, const std::string& message) {
    const Result result = folder.run("emit " + arguments);
    CAPTURE(arguments, result.err);
    CHECK(result.code == code);
    CHECK(result.out.empty());
    CHECK(contains(result.err, message));
  };
  refused("glsk ball.json", 2, "did you mean `glsl`?");
  refused("ball.json", 2, "scene");
  refused("cpp ball.json --name x", 2, "use --namespace");
  refused("glsl ball.json --namespace x", 2, "use --name");
  refused("html ball.json --name x", 2, "--name is about GLSL");
  refused("cpp ball.json --surfaces", 2, "emit glsl");
  refused("cpp ball.json --namespace 1x", 2, "a namespace is made of letters");
  refused("cpp ball.json --namespace class", 2, "a word of C++ itself");
  refused("cpp ball.json --namespace my::co_await::ball", 2, "a word of C++ itself");
  refused("cpp ball.json --namespace _Ball", 2, "for itself");
  refused("cpp ball.json --namespace std", 2, "standard library");
  refused("glsl ball.json --name gl_x", 2, "GLSL keeps names");
  refused("cpp ball.json -o ball.json", 2, "would be overwritten");
  refused("cpp ball.json -o ball.json/ball.h", 74, "cannot write to the folder `ball.json`");
  refused("cpp nothing.json", 74, "nothing.json");
  folder.write("bad.json", "{");
  refused("cpp bad.json", 65, "bad.json");
}

}  // namespace fathom::test::cli_emit_test
