// A verb's command line: CLI11 parses it, but help, messages and exit codes are our own.
//
//     Arguments arguments("eval", "Prints distances at points.", "fathom eval ball.json --at 0,1,0");
//     arguments.positional("scene", "The scene file, - for stdin", scene);
//     arguments.option("--at", "X,Y,Z", "A point; may be repeated", append_to(read_point, points));
//     if (auto code = arguments.parse(args, streams)) return *code;
//
// An option that is given twice calls its setter twice: a plain target keeps the last value, a list grows.
// Tested by: tests/runtime/cli/options/cli_usage_test.cpp, tests/runtime/cli/cli_test.cpp
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "runtime/cli/options/option_table.h"
#include "runtime/cli/options/streams.h"
#include "runtime/cli/options/values.h"

// Forward declarations, because including CLI11 adds seconds to each compilation.
namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace fathom::cli {

class Arguments {
 public:
  Arguments(const std::string& verb, const std::string& description, const std::string& examples);
  ~Arguments();

  // Sets the heading in --help for the options added from now on.
  void group(std::string heading) { group_ = std::move(heading); }

  // Names are in the form of CLI11: "-s,--spp".
  void positional(const std::string& name, const std::string& doc, std::string& target, bool required = true,
                  const std::string& value = "FILE", std::vector<std::string> words = {});
  // Adds a positional argument with several values, at least one if `required`.
  void positionals(const std::string& name, const std::string& doc, std::vector<std::string>& targets,
                   const std::string& value = "FILE", bool required = true);
  void flag(const std::string& names, const std::string& doc, bool& target);
  void counter(const std::string& names, const std::string& doc, int& target);  // counts how often the flag is given
  void option(const std::string& names, const std::string& value, const std::string& doc, Setter setter);

  // Returns nullopt if the verb may go on. Otherwise parse() has printed help or an error, or stored the options in
  // Streams::options, and the verb ends with the returned code.
  std::optional<int> parse(std::span<const std::string> args, const Streams& streams);

  // Returns the options given to parse(), without positional arguments, each by its longest name and with its values
  // as written. Parsing the result again gives the same request.
  struct ParsedOption {
    std::string name;                 // "--spp"
    std::vector<std::string> values;  // empty for a flag
    std::vector<std::string> arguments() const;
  };
  std::vector<ParsedOption> parsed_options() const;

 private:
  struct Option {
    CLI::Option* option;
    std::vector<std::string> texts;
    Setter setter;
  };
  void add_common(const Streams& streams);
  void add_row(const std::string& names, const std::string& value, const std::string& doc,
               std::vector<std::string> words = {});
  int report_unknown(const std::vector<std::string>& remaining, const Streams& streams) const;
  int report_usage(const Streams& streams, const std::string& message, Help help = {}) const;

  std::unique_ptr<CLI::App> app_;
  OptionTable table_;
  std::string group_ = "Options";
  std::deque<Option> options_;  // a deque keeps addresses stable
};

}  // namespace fathom::cli
