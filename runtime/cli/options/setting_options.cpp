#include "runtime/cli/options/setting_options.h"

#include <fmt/format.h>

#include <string>
#include <type_traits>

#include "runtime/cli/options/values.h"

namespace fathom::cli {
namespace {

using compiler::Setting;

template <typename Record, typename Member>
Setter setting_reader(const Setting<Record, Member>& setting, std::optional<int>& target) {
  return whole(target, static_cast<int>(setting.range.least), static_cast<int>(setting.range.most));
}

template <typename Record, typename Member>
Setter setting_reader(const Setting<Record, Member>&, std::optional<std::uint64_t>& target) {
  return into(read_seed, target);
}

template <typename Record, typename Member>
Setter setting_reader(const Setting<Record, Member>& setting, std::optional<double>& target) {
  if (setting.range.above_zero) return into(read_positive, target);
  return [range = setting.range, help = setting.option.hint, &target](std::string_view text) {
    double number = 0;
    OptionResult error = read_between(text, range.least, range.most, help, number);
    if (!error) target = number;
    return error;
  };
}

template <typename Record, typename Enum>
requires std::is_enum_v<Enum>
Setter setting_reader(const Setting<Record, Enum>&, std::optional<Enum>& target) {
  const auto words = compiler::words_of(Enum{});
  return one_of({words.begin(), words.end()}, target);
}

// Returns the option's help with the default in place of {}.
template <typename Record, typename Member>
std::string setting_help(const Setting<Record, Member>& setting) {
  if constexpr (std::is_arithmetic_v<Member>) {
    return fmt::format(fmt::runtime(setting.option.help), Record().*setting.member);
  } else {
    return std::string(setting.option.help);
  }
}

}  // namespace

void add_setting_options(Arguments& arguments, compiler::OptionGroup group, compiler::SettingsOverrides& overrides,
                         const std::function<void(std::string_view setting)>& after) {
  compiler::for_each_setting([&](const auto& setting) {
    const compiler::SettingOption& option = setting.option;
    if (option.names.empty() || option.group != group) return;
    arguments.option(std::string(option.names), std::string(option.placeholder), setting_help(setting),
                     setting_reader(setting, overrides.*setting.overriding));
    after(setting.name);
  });
}

}  // namespace fathom::cli
