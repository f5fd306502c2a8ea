// A verb's command line: CLI11 splits it; the help, the messages and the exit codes are ours.
//
//     Arguments arguments("eval", "Prints distances at points.", "fathom eval ball.json --at 0,1,0");
//     arguments.positional("scene", "The scene file, - for stdin", scene);
//     arguments.option("--at", "X,Y,Z", "A point; may be repeated", append_to(read_point, points));
//     if (auto code = arguments.parse(args, streams)) return *code;
//
// An option that is given twice calls its setter twice: a plain one keeps the last value, a list grows.
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

// Known by name alone: CLI11 takes seconds to compile.
namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace fathom::cli {

class Arguments {
 public:
  Arguments(const std::string& verb, const std::string& description, const std::string& examples);
  ~Arguments();

  // The heading in --help of what is added after it.
  void group(std::string heading) { group_ = std::move(heading); }

  // Names as CLI11 takes them: "-s,--spp".
  void positional(const std::string& name, const std::string& doc, std::string& target, bool required = true,
                  const std::string& value = "FILE", std::vector<std::string> words = {});
  // One or more where they are required.
  void positionals(const std::string& name, const std::string& doc, std::vector<std::string>& targets,
                   const std::string& value = "FILE", bool required = true);
  void flag(const std::string& names, const std::string& doc, bool& target);
  void counter(const std::string& names, const std::string& doc, int& target);  // how often the flag was given
  void option(const std::string& names, const std::string& value, const std::string& doc, Setter setter);

  // nullopt to go on; otherwise help or an error was printed, or the options were put where Streams::options says,
  // and the verb ends with that code.
  std::optional<int> parse(std::span<const std::string> args, const Streams& streams);

  // What parse() was given beside positional arguments, each option by its longest name and with its values as they
  // were written: parsing it again gives the same.
  struct Given {
    std::string name;                 // "--spp"
    std::vector<std::string> values;  // none of a flag
    std::vector<std::string> arguments() const;
  };
  std::vector<Given> given() const;

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
  std::deque<Option> options_;  // addresses are stable
};

}  // namespace fathom::cli
