#include "runtime/cli/editor_files.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>
#include <string_view>

#include "compiler/frontend/text/parse/lexer.h"
#include "compiler/frontend/text/parse/vocabulary.h"

namespace fathom::cli {
namespace {

using Json = nlohmann::ordered_json;

using compiler::text::kReservedWords, compiler::text::kStatementWords;

constexpr std::string_view kValues[] = {"pi", "e", "tau", "x", "y", "z"};

constexpr std::string_view kNumber = R"((\d+(\.(?!\.)\d*)?|\.\d+)([eE][+-]?\d+)?)";

template <class Words>
std::string alternatives(const Words& words) {
  return fmt::format("{}", fmt::join(words, "|"));
}

Json rule(std::string_view name, std::string match) { return {{"name", name}, {"match", std::move(match)}}; }

Json grammar() {
  Json patterns = Json::array();
  patterns.push_back(rule("comment.line.double-slash.fathom", "//.*$"));
  patterns.push_back({{"name", "comment.block.fathom"}, {"begin", "/\\*"}, {"end", "\\*/"}});
  patterns.push_back({{"name", "string.quoted.double.fathom"},
                      {"begin", "\""},
                      {"end", "\"|$"},
                      {"patterns", Json::array({rule("constant.character.escape.fathom", "\\\\.")})}});
  patterns.push_back(
      rule("keyword.other.statement.fathom", fmt::format("^(fathom|{})\\b", alternatives(kStatementWords))));
  patterns.push_back(rule("keyword.control.fathom", fmt::format("\\b({})\\b", alternatives(kReservedWords))));
  patterns.push_back(rule("support.function.fathom",
                          fmt::format("\\b({})(?=\\s*\\()", alternatives(compiler::text::all_words()))));
  patterns.push_back(rule("entity.name.function.fathom", "\\b[A-Za-z_]\\w*(?=\\()"));
  patterns.push_back(rule("constant.language.fathom", fmt::format("\\b({})\\b", alternatives(kValues))));
  patterns.push_back(rule("constant.numeric.fathom", fmt::format("(?<![\\w.]){}", kNumber)));
  patterns.push_back(rule("keyword.operator.fathom", "\\.\\.\\.?|[-+*/^&|!<>=]+"));
  return {{"name", "Fathom"}, {"scopeName", "source.fathom"}, {"patterns", std::move(patterns)}};
}

Json package() {
  const Json pattern = {{"regexp", "^(.+?):(\\d+):(\\d+): (error|warning): (.*) \\[([EW]\\d{4})\\]$"},
                        {"file", 1},
                        {"line", 2},
                        {"column", 3},
                        {"severity", 4},
                        {"message", 5},
                        {"code", 6}};
  const Json matcher = {
      {"name", "fathom"}, {"owner", "fathom"}, {"fileLocation", Json::array({"autoDetect"})}, {"pattern", pattern}};
  const Json language = {{"id", "fathom"},
                         {"aliases", Json::array({"Fathom"})},
                         {"extensions", Json::array({".fathom"})},
                         {"configuration", "./language-configuration.json"}};
  const Json colours = {
      {"language", "fathom"}, {"scopeName", "source.fathom"}, {"path", "./syntaxes/fathom.tmLanguage.json"}};
  return {{"name", "fathom"},
          {"displayName", "Fathom"},
          {"description", "Scenes made of signed distance fields"},
          {"version", "1.0.0"},
          {"publisher", "fathom"},
          {"engines", {{"vscode", "^1.60.0"}}},
          {"categories", Json::array({"Programming Languages"})},
          {"contributes",
           {{"languages", Json::array({language})},
            {"grammars", Json::array({colours})},
            {"problemMatchers", Json::array({matcher})}}}};
}

Json configuration() {
  const Json brackets = Json::array({Json::array({"(", ")"}), Json::array({"[", "]"}), Json::array({"{", "}"})});
  return {{"comments", {{"lineComment", "//"}, {"blockComment", Json::array({"/*", "*/"})}}},
          {"brackets", brackets},
          {"autoClosingPairs", brackets},
          {"surroundingPairs", brackets}};
}

std::string in_lines(const Json& json) { return json.dump(2) + "\n"; }

}  // namespace

std::string vim_syntax() {
  std::string out =
      "\" Vim syntax of Fathom's scenes, written by `fathom schema --editor vim`.\n"
      "if exists(\"b:current_syntax\")\n  finish\nendif\n\n";
  out += fmt::format("syn match fathomStatement /^\\(fathom\\|{}\\)\\>/\n", fmt::join(kStatementWords, "\\|"));
  out += fmt::format("syn keyword fathomKeyword {}\n", fmt::join(kReservedWords, " "));
  out += fmt::format("syn keyword fathomConstant {}\n", fmt::join(kValues, " "));
  // Function names are matches and not keywords, because a value may have the name of a function.
  for (const std::string_view word : compiler::text::all_words()) {
    out += fmt::format("syn match fathomFunction /\\<{}\\ze\\s*(/\n", word);
  }
  out +=
      "syn match fathomNumber /\\(\\w\\|\\.\\)\\@1<!\\(\\d\\+\\(\\.\\.\\@!\\d*\\)\\=\\|\\.\\d\\+\\)\\([eE][+-]\\=\\d\\+\\)\\=/\n"
      "syn region fathomText start=/\"/ skip=/\\\\./ end=/\"/ oneline\n"
      "syn match fathomComment /\\/\\/.*$/\n"
      "syn region fathomComment start=/\\/\\*/ end=/\\*\\//\n\n"
      "hi def link fathomStatement Statement\n"
      "hi def link fathomKeyword Keyword\n"
      "hi def link fathomConstant Constant\n"
      "hi def link fathomFunction Function\n"
      "hi def link fathomNumber Number\n"
      "hi def link fathomText String\n"
      "hi def link fathomComment Comment\n\n"
      "let b:current_syntax = \"fathom\"\n";
  return out;
}

std::vector<EditorFile> vscode_extension() {
  return {{"package.json", in_lines(package())},
          {"language-configuration.json", in_lines(configuration())},
          {"syntaxes/fathom.tmLanguage.json", in_lines(grammar())}};
}

}  // namespace fathom::cli
