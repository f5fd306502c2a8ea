// A change of the renderer that changes an image must raise kRendererBits: films of the previous renderer then belong
// to another render.
#include <fmt/format.h>

#include <cstdlib>
#include <map>
#include <sstream>

#include "runtime/film/film_file.h"
#include "tests/support/catch.h"
#include "tests/support/golden.h"
#include "tests/support/program.h"

namespace fathom::renderer_bits_test {

namespace {

using namespace fathom;

// Scenes and sampling options that cover most of the renderer, 8 x 8 pixels.
constexpr const char* kRenders[] = {"cornell.json -s 4",
                                    "showcase.json -s 4",
                                    "blends.json -s 4",
                                    "primitives.json -s 4",
                                    "mandelbulb.json -s 2",
                                    "gallery/still-life.json -s 2",
                                    "chess.fathom -s 2",
                                    "cornell.json -s 16 --noise-threshold 0",
                                    "cornell.json -s 64 --noise-threshold 0.2 --sampler sobol --filter tent"};

std::string value_of(const runtime::Identity& identity, std::string_view name) {
  for (const auto& [row, value] : identity) {
    if (row == name) return value;
  }
  return "";
}

// The stored bits have two lines per render: its arguments, and "RENDERER SCENE-PROGRAM FILM".
struct Bits {
  std::string renderer, program, film;
  bool operator==(const Bits&) const = default;
};

Bits bits_of(const std::string& render) {
  const test::Folder folder;
  const test::Result result =
      folder.run("render " FATHOM_SOURCE_DIR "/scenes/" + render + " -q --size 8x8 -o a.film");
  INFO(render << "\n" << result.err);
  REQUIRE(result.code == 0);
  const auto read = runtime::read_film((folder.path() / "a.film").string());
  REQUIRE(std::holds_alternative<runtime::FilmFile>(read));
  const auto& file = std::get<runtime::FilmFile>(read);
  const runtime::Identity& identity = file.header.identity;
  return {value_of(identity, "renderer"), value_of(identity, "scene") + "-" + value_of(identity, "program"),
          fmt::format("{:016x}", file.render.film.hash())};
}

TEST_CASE("renderer bits: what changes them raises kRendererBits of runtime/cli/picture/render_identity.h",
          "[runtime]") {
  const std::filesystem::path path = std::filesystem::path(FATHOM_SOURCE_DIR) / "tests/golden/renderer/bits.txt";
  std::map<std::string, Bits> known;
  std::istringstream lines(test::read_file(path));
  for (std::string render, renderer, program, film; std::getline(lines, render);) {
    lines >> renderer >> program >> film >> std::ws;
    known[render] = {renderer, program, film};
  }
  std::string text;
  bool raised = true;
  for (const char* render : kRenders) {
    const Bits now = bits_of(render);
    text += fmt::format("{}\n{} {} {}\n", render, now.renderer, now.program, now.film);
    const Bits& before = known[render];
    const bool unsaid = before.program == now.program && before.renderer == now.renderer && before.film != now.film;
    INFO(
        render << ": the same programs of the same scene, and other bits. Raise kRendererBits, so that no checkpoint "
                  "of the renderer before is resumed, then run this with FATHOM_UPDATE_GOLDEN=1");
    CHECK_FALSE(unsaid);
    raised = raised && !unsaid;
  }
  if (std::getenv("FATHOM_UPDATE_GOLDEN") != nullptr) {
    if (raised) std::ofstream(path, std::ios::binary) << text;
    return;
  }
  INFO("run with FATHOM_UPDATE_GOLDEN=1 once scenes, programs or kRendererBits have changed");
  CHECK(test::read_file(path) == text);
}

}  // namespace

}  // namespace fathom::renderer_bits_test
