// Values for the settings of compiler/scene/settings.def, so that tests cover every row.
#pragma once

#include <type_traits>

#include "compiler/scene/settings.h"

namespace fathom::test {

// Returns a valid value that is not the default.
template <typename Record, typename Member>
compiler::SettingValue<Member> another_value(const compiler::Setting<Record, Member>& setting) {
  using Value = compiler::SettingValue<Member>;
  if constexpr (std::is_enum_v<Value>) {
    return static_cast<Value>(1);
  } else if constexpr (std::is_same_v<Value, std::uint64_t>) {
    return ~Value{0};
  } else {
    const Value least = static_cast<Value>(setting.range.above_zero ? 1 : setting.range.least);
    return Record().*setting.member == least ? least + 1 : least;
  }
}

}  // namespace fathom::test
