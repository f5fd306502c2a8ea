// Settings from the command line and from the scene, by the rows that films keep of them.
#include <fmt/format.h>

#include <optional>
#include <string>

#include "compiler/scene/settings.h"
#include "runtime/film/film_file.h"
#include "tests/support/program.h"
#include "tests/support/setting_values.h"

namespace fathom::cli_settings_test {

namespace {

using test::Folder;

// Renders the scene with these properties of its records `film` and `render`. Returns a row of the film's identity.
std::optional<std::string> row_of(std::string_view row, const std::string& arguments, const std::string& film = "",
                                  const std::string& render = "") {
  const Folder folder;
  folder.write("a.json", R"({"version": 1, "film": {"width": 4, "height": 4)" + film + R"(}, "render": {"tile": 8)" +
                             render + R"(}, "objects": [{"type": "sphere", "radius": 1}]})");
  const test::Result result = folder.run("render a.json -q -o a.film " + arguments);
  INFO(result.err);
  REQUIRE(result.code == 0);
  const auto read = runtime::read_film((folder.path() / "a.film").string());
  REQUIRE(std::holds_alternative<runtime::FilmFile>(read));
  for (const auto& [name, value] : std::get<runtime::FilmFile>(read).header.identity) {
    if (name == row) return value;
  }
  return std::nullopt;
}

template <typename Setting>
std::string text_of(const Setting&, typename Setting::Value value) {
  if constexpr (std::is_enum_v<typename Setting::Value>) {
    return std::string(compiler::words_of(value)[static_cast<std::size_t>(value)]);
  } else {
    return fmt::format("{}", value);
  }
}

}  // namespace

TEST_CASE("cli settings: an option and the scene's property change the film's row alike", "[cli]") {
  int settings = 0;
  compiler::for_each_setting([&](const auto& setting) {
    using Setting = std::remove_cvref_t<decltype(setting)>;
    if (setting.identity.row.empty() || setting.option.names.empty()) return;
    CAPTURE(std::string(setting.name));
    const std::string value = text_of(setting, test::another_value(setting));
    const std::string option(setting.option.names.substr(setting.option.names.rfind("--")));
    CHECK(row_of(setting.identity.row, "") != value);
    CHECK(row_of(setting.identity.row, option + "=" + value) == value);
    ++settings;
    if (setting.doc.empty()) return;
    const bool word = std::is_enum_v<typename Setting::Value>;
    const std::string property = fmt::format(word ? ", \"{}\": \"{}\"" : ", \"{}\": {}", setting.name, value);
    const bool film = std::is_same_v<typename Setting::Record, compiler::Film>;
    CHECK(row_of(setting.identity.row, "", film ? property : "", film ? "" : property) == value);
  });
  CHECK(settings >= 10);
}

// The scene's seed was a double, so seeds from 2^53 on were refused or rounded.
TEST_CASE("cli settings: seeds that differ in the last of 64 bits are two pictures, of either notation or the option",
          "[cli]") {
  const Folder folder;
  folder.write("a.json", R"({"version": 1, "background": {"top": 1}, "objects": [{"type": "sphere", "radius": 1}]})");
  const auto picture = [&](const std::string& scene, const std::string& seed) {
    REQUIRE(folder.run("render " + scene + " -q -s 1 --size 24x16 -o a.png" + seed).code == 0);
    return folder.read("a.png");
  };
  std::string before;
  for (const std::string seed :
       {"9007199254740992", "9007199254740993", "18446744073709551614", "18446744073709551615"}) {
    CAPTURE(seed);
    folder.write("seed.json", R"({"version": 1, "background": {"top": 1}, "render": {"seed": )" + seed +
                                  R"(}, "objects": [{"type": "sphere", "radius": 1}]})");
    folder.write("seed.fathom", "fathom 1\nbackground (top = 1)\nrender (seed = " + seed + ")\nobject sphere(1)\n");
    REQUIRE(folder.run("compile seed.fathom -o seed.fbc").code == 0);
    const std::string given = picture("a.json", " --seed " + seed);
    for (const char* scene : {"seed.json", "seed.fathom", "seed.fbc"}) CHECK(picture(scene, "") == given);
    CHECK(given != before);
    before = given;
  }
}

}  // namespace fathom::cli_settings_test
