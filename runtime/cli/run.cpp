#include "runtime/cli/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <new>
#include <ostream>
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

int run_verb(std::span<const std::string> args, const Streams& streams) {
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
  const int code = run_verb(args, streams);
  streams.out.flush();
  if (!streams.out && code == kDone) return fail(streams, kIo, "cannot write to standard output");
  return code;
}

}  // namespace

int run(std::span<const std::string> args, const Streams& streams) {
  try {
    return run_and_flush(args, streams);
  } catch (const std::bad_alloc&) {
    return fail(streams, kInternal, "not enough memory");
  } catch (const std::exception& error) {
    return fail(streams, kInternal, fmt::format("internal error: {}", error.what()));
  }
}

}  // namespace fathom::cli
