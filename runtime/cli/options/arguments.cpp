#include "runtime/cli/options/arguments.h"

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <ostream>

#include "compiler/source/diagnostics.h"
#include "runtime/cli/options/help_text.h"

namespace fathom::cli {
namespace {

std::string longest_name(const CLI::Option& option) {
  return option.get_lnames().empty() ? option.get_name() : "--" + option.get_lnames().back();
}

// Rewords a message of CLI11, which mentions the option's name only at its start.
std::string explain(const CLI::ParseError& error) {
  const std::string what = error.what();
  const std::string name = what.substr(0, what.find_first_of(": "));
  if (dynamic_cast<const CLI::RequiredError*>(&error)) return "the " + name + " is missing";
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error)) return name + ": its value is missing";
  return what;
}

}  // namespace

Arguments::Arguments(const std::string& verb, const std::string& description, const std::string& examples)
    : app_(std::make_unique<CLI::App>(description, "fathom " + verb)), table_{verb, description, examples, {}, {}} {
  app_->allow_extras();
  app_->set_help_flag("-h,--help");
  add_row("-h,--help", "", "Print this help and exit");
}

Arguments::~Arguments() = default;

void Arguments::add_row(const std::string& names, const std::string& value, const std::string& doc,
                        std::vector<std::string> words) {
  table_.options.push_back({names, value, doc, group_, std::move(words)});
}

void Arguments::positional(const std::string& name, const std::string& doc, std::string& target, bool required,
                           const std::string& value, std::vector<std::string> words) {
  app_->add_option(name, target)->required(required);
  table_.positionals.push_back({name, value, doc, "", std::move(words), required, false});
}

void Arguments::positionals(const std::string& name, const std::string& doc, std::vector<std::string>& targets,
                            const std::string& value, bool required) {
  app_->add_option(name, targets)->required(required);
  table_.positionals.push_back({name, value, doc, "", {}, required, true});
}

void Arguments::flag(const std::string& names, const std::string& doc, bool& target) {
  app_->add_flag_callback(names, [&target] { target = true; });
  add_row(names, "", doc);
}

void Arguments::counter(const std::string& names, const std::string& doc, int& target) {
  app_->add_flag_function(names, [&target](std::int64_t count) { target = static_cast<int>(count); });
  add_row(names, "", doc);
}

void Arguments::option(const std::string& names, const std::string& value, const std::string& doc, Setter setter) {
  add_row(names, value, doc, setter.words());
  Option& option = options_.emplace_back(Option{nullptr, {}, std::move(setter)});
  option.option = app_->add_option(names, option.texts);
  option.option->type_size(1)->expected(1);
  option.option->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)->allow_extra_args(false);
}

// Adds the common options that the verb does not declare itself: -q for every verb, -v for every verb with a scene.
void Arguments::add_common(const Streams& streams) {
  group("Options");
  if (app_->get_option_no_throw("--quiet") == nullptr) {
    flag("-q,--quiet", "Print errors, warnings and notes only", streams.quiet);
  }
  if (app_->get_option_no_throw("scene") != nullptr && app_->get_option_no_throw("--verbose") == nullptr) {
    counter("-v,--verbose", "Say what the scene compiles to; -vv: and what each pass leaves", streams.verbosity);
  }
}

std::optional<int> Arguments::parse(std::span<const std::string> args, const Streams& streams) {
  add_common(streams);
  if (streams.options != nullptr) {
    *streams.options = table_;
    return kDone;
  }
  try {
    // CLI11 expects the arguments in reverse order.
    app_->parse(std::vector<std::string>(args.rbegin(), args.rend()));
  } catch (const CLI::CallForHelp&) {
    streams.out << help_text(table_, streams.columns);
    return kDone;
  } catch (const CLI::ParseError& error) {
    const auto remaining = app_->remaining();
    if (!remaining.empty()) return report_unknown(remaining, streams);
    return report_usage(streams, explain(error));
  }
  const auto remaining = app_->remaining();
  if (!remaining.empty()) return report_unknown(remaining, streams);
  for (const Option& option : options_) {
    for (const std::string& text : option.texts) {
      const bool swallowed = text.starts_with("--") && app_->get_option_no_throw(text) != nullptr;
      const OptionResult error = swallowed ? OptionError{"its value is missing", ""} : option.setter(text);
      if (!error) continue;
      return report_usage(streams, longest_name(*option.option) + ": " + error->problem,
                          error->help.empty() ? Help{} : Help{error->help});
    }
  }
  return std::nullopt;
}

std::vector<std::string> Arguments::ParsedOption::arguments() const {
  if (values.empty()) return {name};
  std::vector<std::string> result;
  for (const std::string& value : values) result.push_back(name + "=" + value);
  return result;
}

std::vector<Arguments::ParsedOption> Arguments::parsed_options() const {
  std::vector<ParsedOption> result;
  for (const CLI::Option* option : app_->get_options()) {
    if (option->count() == 0 || option->get_positional()) continue;
    const auto own =
        std::ranges::find(options_, option, [](const Option& o) -> const CLI::Option* { return o.option; });
    result.push_back({longest_name(*option), own == options_.end() ? std::vector<std::string>{} : own->texts});
  }
  return result;
}

int Arguments::report_unknown(const std::vector<std::string>& remaining, const Streams& streams) const {
  const auto unknown = std::find_if(remaining.begin(), remaining.end(), [](const std::string& text) {
    return text.size() > 1 && text[0] == '-' && text != "--";
  });
  if (unknown == remaining.end()) {
    return report_usage(streams, fmt::format("unexpected argument `{}`", remaining.front()));
  }
  const std::string word = unknown->substr(0, unknown->find('='));
  std::vector<std::string> names;
  for (const CLI::Option* option : app_->get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  const std::string_view near = compiler::nearest(word, {names.begin(), names.end()});
  return report_usage(streams, fmt::format("unknown option `{}`", word),
                      near.empty() ? Help{} : Help{fmt::format("did you mean `{}`?", near)});
}

int Arguments::report_usage(const Streams& streams, const std::string& message, Help help) const {
  help.push_back(fmt::format("`fathom {} --help` lists the options", table_.verb));
  return fail(streams, kUsage, message, help);
}

}  // namespace fathom::cli
