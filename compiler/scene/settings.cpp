#include "compiler/scene/settings.h"

namespace fathom::compiler {
namespace {

template <typename Record>
void put_overrides(const SettingsOverrides& overrides, Record& record) {
  for_each_setting_of<Record>([&](const auto& setting) {
    if (const auto& value = overrides.*setting.overriding) record.*setting.member = *value;
  });
}

}  // namespace

Film with_overrides(Film film, const SettingsOverrides& overrides) {
  if (overrides.filter) film.filter_width.reset();
  put_overrides(overrides, film);
  return film;
}

RenderSettings with_overrides(RenderSettings settings, const SettingsOverrides& overrides) {
  put_overrides(overrides, settings);
  return settings;
}

}  // namespace fathom::compiler
