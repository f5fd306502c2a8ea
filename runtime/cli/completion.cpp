// fathom completion: scripts with which a shell completes verbs, options and values, generated from the option
// tables.
// Tested by: tests/runtime/cli/options/cli_completion_test.cpp
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <ostream>

#include "runtime/cli/options/arguments.h"
#include "runtime/cli/verbs.h"

namespace fathom::cli {
namespace {

constexpr const char* kCompletionExamples =
    "eval \"$(fathom completion bash)\"   # in ~/.bashrc\n"
    "fathom completion bash > ~/.local/share/bash-completion/completions/fathom\n"
    "fathom completion zsh > ~/.zfunc/_fathom   # a folder of $fpath\n"
    "fathom completion fish > ~/.config/fish/completions/fathom.fish\n"
    "\n"
    "`cmake --install` puts the three where the shells look for them.";

const std::vector<std::string> kHelpTopics = {"help", "limits"};

// Returns the first clause of an option's help, which is enough to identify the option.
std::string brief(std::string_view doc) {
  std::string text(doc.substr(0, std::min({doc.find(": "), doc.find("; "), doc.find(" ("), doc.find(". ")})));
  if (text.ends_with('.')) text.pop_back();
  return text;
}

// Returns the text in a shell's single quotes. Inside them fish has two escapes, the other shells none.
std::string quoted_for_shell(std::string_view text, bool fish) {
  std::string quoted = "'";
  for (const char c : text) {
    if (c == '\'') {
      quoted += fish ? "\\'" : "'\\''";
    } else if (c == '\\' && fish) {
      quoted += "\\\\";
    } else {
      quoted += c;
    }
  }
  return quoted + '\'';
}

std::string spaced(const std::vector<std::string>& words) { return fmt::format("{}", fmt::join(words, " ")); }

std::vector<std::string> verb_names() {
  std::vector<std::string> names;
  for (const Verb& verb : kVerbs) names.emplace_back(verb.name);
  return names;
}

// Returns the words that may follow the verb, for instance `cpp` after `emit`. Empty: file names.
std::vector<std::string> first_words(const OptionTable& table) {
  return table.positionals.empty() ? std::vector<std::string>() : table.positionals.front().words;
}

// ---- bash

constexpr const char* kBashHead = R"(# Completion of fathom for bash. Made by `fathom completion bash`.
_fathom() {
  local cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD-1]} verb=${COMP_WORDS[1]}
  local options= words= first= value=none
  COMPREPLY=()
  if [[ $cur == '=' ]]; then  # bash splits --option=value in three
    cur=
  elif [[ $prev == '=' ]]; then
    prev=${COMP_WORDS[COMP_CWORD-2]}
  fi
)";
constexpr const char* kBashTail = R"(  if [[ $value == words ]]; then
    COMPREPLY=($(compgen -W "$words" -- "$cur"))
  elif [[ $value == other ]]; then
    return
  elif [[ $value == none && $cur == -* ]]; then
    COMPREPLY=($(compgen -W "$options" -- "$cur"))
  elif [[ $value == none && -n $first && $COMP_CWORD == 2 ]]; then
    COMPREPLY=($(compgen -W "$first" -- "$cur"))
  else
    compopt -o default 2>/dev/null  # names of files
  fi
}
complete -F _fathom fathom
)";

std::string bash_verb(const OptionTable& table) {
  std::vector<std::string> all;
  std::string cases, files, others;
  for (const OptionRow& row : table.options) {
    const std::vector<std::string> names = names_of(row);
    all.insert(all.end(), names.begin(), names.end());
    if (row.value.empty()) continue;
    const std::string pattern = fmt::format("{}", fmt::join(names, "|"));
    if (!row.words.empty()) {
      cases +=
          fmt::format("        {}) value=words words={} ;;\n", pattern, quoted_for_shell(spaced(row.words), false));
    } else {
      std::string& list = takes_file(row) ? files : others;
      list += (list.empty() ? "" : "|") + pattern;
    }
  }
  if (!files.empty()) cases += fmt::format("        {}) value=file ;;\n", files);
  if (!others.empty()) cases += fmt::format("        {}) value=other ;;\n", others);
  std::string text = fmt::format("    {})\n      options={}\n", table.verb, quoted_for_shell(spaced(all), false));
  if (const auto words = first_words(table); !words.empty()) {
    text += fmt::format("      first={}\n", quoted_for_shell(spaced(words), false));
  }
  if (!cases.empty()) text += "      case $prev in\n" + cases + "      esac\n";
  return text + "      ;;\n";
}

std::string bash_script() {
  const std::string verbs = spaced(verb_names());
  std::string text = kBashHead;
  text += fmt::format(
      "  if ((COMP_CWORD == 1)); then\n"
      "    COMPREPLY=($(compgen -W '{} help --help --version -h -V' -- \"$cur\"))\n"
      "    return\n"
      "  fi\n"
      "  case $verb in\n"
      "    help) first='{} {}' ;;\n",
      verbs, verbs, spaced(kHelpTopics));
  for (const Verb& verb : kVerbs) text += bash_verb(option_table(verb.name));
  return text + "  esac\n" + kBashTail;
}

// ---- zsh

constexpr const char* kZshHead = R"(#compdef fathom
# Completion of fathom for zsh. Made by `fathom completion zsh`.
_fathom() {
  local -a verbs
)";

// The file serves both as the body of an autoloaded function and for `source`.
constexpr const char* kZshTail = R"(  esac
}
if [[ $funcstack[1] == _fathom ]]; then
  _fathom "$@"
else
  compdef _fathom fathom
fi
)";

// Escapes text for a specification of _arguments, in which brackets and colons are separators.
std::string zsh_text(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '[' || c == ']' || c == ':' || c == '\\') escaped += '\\';
    escaped += c;
  }
  return escaped;
}

// Returns the value's part of a specification: ":FILE:_files", ":CURVE:(none filmic)".
std::string zsh_value(const OptionRow& row) {
  if (row.value.empty()) return "";
  const std::string action = takes_file(row)     ? "_files"
                             : row.words.empty() ? " "
                                                 : fmt::format("({})", spaced(row.words));
  return fmt::format(":{}:{}", zsh_text(row.value), action);
}

std::string zsh_verb(const OptionTable& table) {
  std::string text = fmt::format("    {})\n      _arguments -S", table.verb);
  for (const OptionRow& row : table.options) {
    for (const std::string& name : names_of(row)) {
      const bool separate = !row.value.empty();
      const std::string end = !separate ? "" : name.starts_with("--") ? "=" : "+";
      text +=
          " \\\n        " +
          quoted_for_shell(fmt::format("*{}{}[{}]{}", name, end, zsh_text(brief(row.doc)), zsh_value(row)), false);
    }
  }
  for (std::size_t i = 0; i < table.positionals.size(); ++i) {
    OptionRow row = table.positionals[i];
    const std::string which = row.repeated ? "*" : std::to_string(i + 1);
    const std::string value = zsh_value(row);
    text += " \\\n        " +
            quoted_for_shell(fmt::format("{}:{}{}", which, row.names, value.substr(value.rfind(':'))), false);
  }
  return text + "\n      ;;\n";
}

std::string zsh_script() {
  std::string text = kZshHead;
  text += "  verbs=(\n";
  for (const Verb& verb : kVerbs) {
    text += fmt::format("    {}\n", quoted_for_shell(fmt::format("{}:{}", verb.name, zsh_text(verb.summary)), false));
  }
  text += "    'help:prints the options of a verb'\n  )\n";
  text +=
      "  if ((CURRENT == 2)); then\n"
      "    _describe verb verbs\n"
      "    return\n"
      "  fi\n"
      "  local verb=$words[2]\n"
      "  shift words\n"
      "  ((CURRENT--))\n"
      "  case $verb in\n";
  text += fmt::format("    help)\n      _values verb {} {}\n      ;;\n", spaced(verb_names()), spaced(kHelpTopics));
  for (const Verb& verb : kVerbs) text += zsh_verb(option_table(verb.name));
  return text + kZshTail;
}

// ---- fish

std::string fish_verb(const OptionTable& table) {
  const std::string begin = fmt::format("complete -c fathom -n '__fish_seen_subcommand_from {}'", table.verb);
  std::string text;
  if (const auto words = first_words(table); !words.empty()) {
    text += fmt::format("{} -a {}\n", begin, quoted_for_shell(spaced(words), true));
  }
  const auto is_file = [](const OptionRow& row) { return takes_file(row) && row.words.empty(); };
  if (std::any_of(table.positionals.begin(), table.positionals.end(), is_file)) text += begin + " -F\n";
  for (const OptionRow& row : table.options) {
    text += begin;
    for (const std::string& name : names_of(row)) {
      text += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
    }
    if (!row.words.empty())
      text += " -x -a " + quoted_for_shell(spaced(row.words), true);
    else if (takes_file(row))
      text += " -r -F";
    else if (!row.value.empty())
      text += " -x";
    text += fmt::format(" -d {}\n", quoted_for_shell(brief(row.doc), true));
  }
  return text;
}

std::string fish_script() {
  std::string text = "# Completion of fathom for fish. Made by `fathom completion fish`.\ncomplete -c fathom -f\n";
  for (const Verb& verb : kVerbs) {
    text += fmt::format("complete -c fathom -n __fish_use_subcommand -a {} -d {}\n", verb.name,
                        quoted_for_shell(verb.summary, true));
  }
  text += "complete -c fathom -n __fish_use_subcommand -a help -d 'prints the options of a verb'\n";
  text += "complete -c fathom -n __fish_use_subcommand -s V -l version -d 'prints the version and the commit'\n";
  text += fmt::format("complete -c fathom -n '__fish_seen_subcommand_from help' -a '{} {}'\n", spaced(verb_names()),
                      spaced(kHelpTopics));
  for (const Verb& verb : kVerbs) text += fish_verb(option_table(verb.name));
  return text;
}

}  // namespace

int run_completion(std::span<const std::string> args, const Streams& streams) {
  const std::vector<std::string_view> shells = {"bash", "zsh", "fish"};
  std::string name;
  Arguments arguments("completion", "Prints the script by which a shell completes verbs, options and their values.",
                      kCompletionExamples);
  arguments.positional("shell", "bash, zsh or fish", name, true, "SHELL", {shells.begin(), shells.end()});
  if (const auto code = arguments.parse(args, streams)) return *code;
  int shell = 0;
  if (const OptionResult wrong = one_of(shells, shell)(name)) {
    return fail(streams, kUsage, fmt::format("unknown shell: {}", wrong->problem),
                wrong->help.empty() ? Help{} : Help{wrong->help});
  }
  streams.out << (shell == 0 ? bash_script() : shell == 1 ? zsh_script() : fish_script());
  return kDone;
}

}  // namespace fathom::cli
