// The program fathom: finds the verb and runs it. Implements `help`, `--help` and `--version` itself.
// Tested by: tests/runtime/cli/cli_test.cpp
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <iostream>
#include <new>
#include <set>

#include "compiler/source/diagnostics.h"
#include "compiler/source/limits.h"
#include "runtime/cli/options/help_text.h"
#include "runtime/cli/options/version.h"
#include "runtime/cli/verbs.h"
#include "vm/interpret/evaluate.h"

namespace fathom::cli {
namespace {

const Verb* find_verb(std::string_view name) {
  const auto found = std::find_if(kVerbs.begin(), kVerbs.end(), [&](const Verb& verb) { return verb.name == name; });
  return found == kVerbs.end() ? nullptr : &*found;
}

std::string overview(int columns) {
  std::string text = paragraph("Fathom renders scenes made of signed distance fields.", 0, columns) + "\nUsage:\n";
  const auto add = [&](std::string_view usage, std::string_view summary) {
    text += hanging(usage, summary, 42, columns);
  };
  for (const Verb& verb : kVerbs) add(usage_of(verb), verb.summary);
  add("fathom help VERB", "prints the options of a verb");
  add("fathom help limits", "prints the limits on what a file may ask for");
  add("fathom -V, --version", "prints the version, the commit and the instruction set in use");
  text += "\nExit status:\n";
  for (const ExitCodeInfo& row : kExitCodes) text += hanging(std::to_string(int{row.code}), row.meaning, 6, columns);
  return text;
}

std::string version() {
  return fmt::format("fathom {}{}\ninstruction set {}, compiled by {}\n", kVersion,
                     kCommit.empty() ? "" : fmt::format(" ({})", kCommit), vm::isa_name(), kCompiler);
}

// Returns the table of `fathom help limits`.
std::string limits_text(int columns) {
  std::string text =
      paragraph("A file that asks for more than a limit is refused. --limit NAME=VALUE sets a limit.", 0, columns) +
      '\n';
  const auto add = [&](std::string_view name, std::string_view value, std::string_view largest,
                       std::string_view doc) {
    text += hanging(fmt::format("{:<17}{:>12} {:>12}", name, value, largest), doc, 46, columns);
  };
  add("name", "default", "largest", "what it counts");
  for (const compiler::LimitRow& row : compiler::kLimits) {
    const double value = compiler::Limits{}.*row.value;
    add(row.name, value > 0 ? fmt::format("{:.15g}", value) : "3/4 of all", fmt::format("{:.15g}", row.largest),
        fmt::format("{}: {}", row.unit, row.bounds));
  }
  return text;
}

// Terminate handler: prints the reason and exits. std::terminate is called for an uncaught exception in a thread, and
// for a thread not joined when the main thread throws. Both happen when memory or threads run out.
[[noreturn]] void end_at_once() {
  std::string_view reason = "not enough memory, or not enough threads";
  try {
    if (const std::exception_ptr thrown = std::current_exception()) std::rethrow_exception(thrown);
  } catch (const std::bad_alloc&) {
    reason = "not enough memory";
  } catch (const std::exception& error) {
    reason = error.what();
  }
  for (const std::string_view part : {std::string_view("error: "), reason, std::string_view("\n")})
    (void)!::write(STDERR_FILENO, part.data(), part.size());
  std::_Exit(kInternal);
}

int unknown_verb(const std::string& word, const Streams& streams) {
  std::vector<std::string_view> names = {"help", "--help", "--version"};
  for (const Verb& verb : kVerbs) names.push_back(verb.name);
  Help help;
  std::error_code ignored;
  if (const std::string_view near = compiler::nearest(word, names); !near.empty()) {
    help.push_back(fmt::format("did you mean `fathom {}`?", near));
  } else if (word.ends_with(".json") || std::filesystem::exists(word, ignored)) {
    help.push_back(fmt::format("did you mean `fathom render {}`?", word));
  }
  help.push_back("`fathom --help` lists the verbs");
  return fail(streams, kUsage, fmt::format("unknown {} `{}`", word.starts_with('-') ? "option" : "verb", word), help);
}

int run(std::span<const std::string> args, const Streams& streams) {
  if (args.empty()) {
    streams.err << overview(streams.columns);
    return kUsage;
  }
  const std::string& word = args.front();
  if (word == "--version" || word == "-V") {
    streams.out << version();
    return kDone;
  }
  const std::set<std::string_view> help_words = {"help", "--help", "-h"};
  const bool help = help_words.contains(word);
  const bool of_help = args.size() == 2 && help_words.contains(args[1]);
  if (help && (args.size() == 1 || of_help)) {
    streams.out << overview(streams.columns);
    return kDone;
  }
  const std::string& name = help ? args[1] : word;
  if (help && name == "limits") {
    streams.out << limits_text(streams.columns);
    return kDone;
  }
  const Verb* verb = find_verb(name);
  if (!verb) return unknown_verb(name, streams);
  const std::string show_help[] = {"--help"};
  return verb->run(help ? std::span<const std::string>(show_help) : args.subspan(1), streams);
}

// Runs the verb and checks that its output reached standard output.
int run_and_flush(std::span<const std::string> args, const Streams& streams) {
  const int code = run(args, streams);
  streams.out.flush();
  if (!streams.out && code == kDone) return fail(streams, kIo, "cannot write to standard output");
  return code;
}

}  // namespace
}  // namespace fathom::cli

int main(int argc, char** argv) {
  using namespace fathom::cli;
  const bool terminal = isatty(STDERR_FILENO) != 0;
  const char* no_color = std::getenv("NO_COLOR");
  const char* term = std::getenv("TERM");
  const bool dumb = term == nullptr || std::string_view(term) == "dumb";
  const bool color = terminal && !dumb && (no_color == nullptr || *no_color == '\0');
  std::ios::sync_with_stdio(false);
  std::signal(SIGXFSZ, SIG_IGN);  // exceeding the limit of file size makes a write fail instead of ending the program
  std::set_terminate(end_at_once);
  std::signal(SIGABRT, [](int) { std::_Exit(kInternal); });  // a failed CHECK aborts after its message
  const Streams streams{std::cin,          std::cout, std::cerr, terminal && !dumb, color, isatty(STDOUT_FILENO) != 0,
                        terminal_columns()};
  try {
    return run_and_flush(std::vector<std::string>(argv + 1, argv + argc), streams);
  } catch (const std::bad_alloc&) {
    return fail(streams, kInternal, "not enough memory");
  } catch (const std::exception& error) {
    return fail(streams, kInternal, fmt::format("internal error: {}", error.what()));
  }
}
