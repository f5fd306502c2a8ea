// Options of settings: one for each row of compiler/scene/settings.def that has one.
// Tested by: tests/runtime/cli/cli_test.cpp, tests/runtime/cli/options/cli_usage_test.cpp
#pragma once

#include <functional>
#include <string_view>

#include "compiler/scene/settings.h"
#include "runtime/cli/options/arguments.h"

namespace fathom::cli {

// Adds the group's options in the table's order. Calls `after` with the name of each added setting, so that the
// caller can add options between them.
void add_setting_options(
    Arguments& arguments, compiler::OptionGroup group, compiler::SettingsOverrides& overrides,
    const std::function<void(std::string_view setting)>& after = [](std::string_view) {});

}  // namespace fathom::cli
