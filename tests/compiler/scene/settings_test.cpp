// The table of settings, and the merge of the scene's settings under overrides.
#include "compiler/scene/settings.h"

#include <set>
#include <string>

#include "tests/support/catch.h"
#include "tests/support/golden.h"
#include "tests/support/setting_values.h"

namespace fathom::settings_test {

namespace {

using namespace fathom::compiler;

template <typename Record>
int check_overrides() {
  int settings = 0;
  for_each_setting_of<Record>([&](const auto& setting) {
    CAPTURE(std::string(setting.name));
    const auto value = test::another_value(setting);
    SettingsOverrides overrides;
    CHECK(with_overrides(Record(), overrides).*setting.member == Record().*setting.member);
    overrides.*setting.overriding = value;
    CHECK(with_overrides(Record(), overrides).*setting.member == value);
    Record scene;
    scene.*setting.member = value;
    CHECK(with_overrides(scene, {}).*setting.member == value);
    ++settings;
  });
  return settings;
}

}  // namespace

TEST_CASE("settings: an override replaces the scene's value, and no other does", "[scene][settings]") {
  CHECK(check_overrides<Film>() > 5);
  CHECK(check_overrides<RenderSettings>() > 5);
}

TEST_CASE("settings: a filter without a width does not take the width of the scene's filter", "[scene][settings]") {
  Film film;
  film.filter_width = 3.5;
  SettingsOverrides overrides;
  overrides.filter = FilterKind::Tent;
  CHECK_FALSE(with_overrides(film, overrides).filter_width);
  overrides.filter_width = 2;
  CHECK(with_overrides(film, overrides).filter_width == 2.0);
  CHECK(with_overrides(film, overrides).filter == FilterKind::Tent);
}

TEST_CASE("settings: names, options and rows differ, and defaults are valid", "[scene][settings]") {
  std::set<std::string_view> names, options, rows;
  for_each_setting([&](const auto& setting) {
    using Setting = std::remove_cvref_t<decltype(setting)>;
    CAPTURE(std::string(setting.name));
    CHECK(names.insert(setting.name).second);
    if (!setting.option.names.empty()) CHECK(options.insert(setting.option.names).second);
    if (!setting.identity.row.empty()) CHECK(rows.insert(setting.identity.row).second);
    const typename Setting::Member value = typename Setting::Record().*setting.member;
    if constexpr (std::is_enum_v<typename Setting::Member>) {
      CHECK(static_cast<int>(value) == 0);
    } else if constexpr (std::is_arithmetic_v<typename Setting::Member>) {
      const auto number = static_cast<double>(value);
      CHECK((setting.range.above_zero ? number > 0 : number >= setting.range.least && number <= setting.range.most));
    }
  });
}

TEST_CASE("settings: the documents name every property and every option", "[scene][settings]") {
  const std::string properties = test::read_file(FATHOM_SOURCE_DIR "/docs/reference/scene-file.md");
  const std::string commands = test::read_file(FATHOM_SOURCE_DIR "/docs/reference/commands.md");
  for_each_setting([&](const auto& setting) {
    const std::string property = "`" + std::string(setting.name) + "`";
    if (!setting.doc.empty()) CHECK_THAT(properties, Catch::Contains(property));
    if (setting.option.names.empty()) return;
    const std::string option(setting.option.names.substr(setting.option.names.rfind("--")));
    CHECK_THAT(commands, Catch::Contains(option + "`"));
  });
}

}  // namespace fathom::settings_test
