// fathom man: the manual page, generated from the option tables.
// Tested by: tests/runtime/cli/options/cli_completion_test.cpp
#include <fmt/format.h>

#include <ostream>

#include "compiler/source/limits.h"
#include "runtime/cli/options/arguments.h"
#include "runtime/cli/options/version.h"
#include "runtime/cli/verbs.h"

namespace fathom::cli {
namespace {

constexpr const char* kManExamples =
    "fathom man | man -l -\n"
    "fathom man > ~/.local/share/man/man1/fathom.1";

// Escapes text for roff: a line must not begin with a point or an apostrophe, and a minus is not a hyphen.
std::string roff(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    if (escaped.empty() || escaped.back() == '\n') {
      if (c == '.' || c == '\'') escaped += "\\&";
    }
    if (c == '\\') {
      escaped += "\\e";
    } else if (c == '-') {
      escaped += "\\-";
    } else if (c == '\'') {
      escaped += "\\(aq";
    } else if (c == '`') {
      escaped += "\\(ga";
    } else {
      escaped += c;
    }
  }
  return escaped;
}

// Returns an option's names and value: "\fB\-o\fR, \fB\-\-output\fR \fIFILE\fR".
std::string heading(const OptionRow& row) {
  std::string text;
  for (const std::string& name : names_of(row)) {
    text += fmt::format("{}\\fB{}\\fR", text.empty() ? "" : ", ", roff(name));
  }
  return row.value.empty() ? text : fmt::format("{} \\fI{}\\fR", text, roff(row.value));
}

std::string tagged(std::string_view tag, std::string_view doc) {
  return fmt::format(".TP\n{}\n{}\n", tag, roff(doc));
}

std::string examples(std::string_view all) {
  const std::size_t prose = all.find("\n\n");
  std::string text = fmt::format(".PP\nExamples:\n.PP\n.nf\n.RS\n{}\n.RE\n.fi\n", roff(all.substr(0, prose)));
  if (prose != std::string_view::npos) text += fmt::format(".PP\n{}\n", roff(all.substr(prose + 2)));
  return text;
}

std::string verb_section(const Verb& verb) {
  const OptionTable table = option_table(verb.name);
  std::string text = fmt::format(".SS \"{}\"\n{}\n", roff(usage_of(verb)), roff(table.description));
  for (const OptionRow& row : table.positionals) text += tagged(fmt::format("\\fI{}\\fR", roff(row.names)), row.doc);
  std::string group = "Options";
  for (const OptionRow& row : table.options) {
    if (row.group != group) text += fmt::format(".PP\n{}:\n", roff(row.group));
    group = row.group;
    text += tagged(heading(row), row.doc);
  }
  return text + examples(table.examples);
}

std::string manual() {
  std::string text = fmt::format(
      ".\\\" Made by `fathom man`.\n"
      ".TH FATHOM 1 \"\" \"fathom {}\" \"User Commands\"\n"
      ".SH NAME\nfathom \\- compile and render scenes made of signed distance fields\n"
      ".SH SYNOPSIS\n.B fathom\n.I verb\n.RI [ options ]\n.I arguments\n.br\n.B fathom help\n.I verb\n"
      ".SH DESCRIPTION\nFathom compiles scenes made of signed distance fields to a compact bytecode and "
      "path\\-traces them.\nA scene is a text in a language of its own, or a JSON file.\n.SH VERBS\n",
      kVersion);
  for (const Verb& verb : kVerbs) text += verb_section(verb);
  text +=
      ".SH LIMITS\nA file that asks for more than its limits is refused.\n\\fB\\-\\-limit\\fR "
      "\\fINAME=VALUE\\fR sets one.\n";
  for (const compiler::LimitRow& row : compiler::kLimits) {
    text += tagged(fmt::format("\\fB{}\\fR", roff(row.name)), fmt::format("{}: {}", row.unit, row.bounds));
  }
  text += ".SH EXIT STATUS\n";
  for (const ExitCodeInfo& row : kExitCodes) text += tagged(fmt::format("\\fB{}\\fR", int{row.code}), row.meaning);
  text +=
      ".SH SEE ALSO\nThe scene language is described in docs/reference/scene-file.md, and more in the files\n"
      "beside it. They are installed under share/doc/fathom, example scenes under share/fathom/scenes.\n";
  text += ".SH ENVIRONMENT\n";
  text += tagged("\\fBCOLUMNS\\fR", "The width that help is wrapped to, in place of the terminal's.");
  text += tagged("\\fBNO_COLOR\\fR", "When set, messages have no colours.");
  text += tagged("\\fBFATHOM_ISA\\fR", "Forces an instruction set: avx512, avx2, sse4, neon or scalar.");
  return text;
}

}  // namespace

int run_man(std::span<const std::string> args, const Streams& streams) {
  Arguments arguments("man", "Prints the manual page of all verbs, for `man`.", kManExamples);
  if (const auto code = arguments.parse(args, streams)) return *code;
  streams.out << manual();
  return kDone;
}

}  // namespace fathom::cli
