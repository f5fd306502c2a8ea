#include "compiler/frontend/text/read_text.h"

#include <algorithm>
#include <iterator>
#include <set>

#include "compiler/frontend/syntax/json_error.h"
#include "compiler/frontend/text/evaluate/emit.h"
#include "compiler/frontend/text/evaluate/evaluate.h"
#include "compiler/frontend/text/parse/lexer.h"
#include "compiler/frontend/text/parse/names.h"
#include "compiler/frontend/text/parse/parser.h"

namespace fathom::compiler {

namespace {

struct ReadText {
  syntax::File file;
  text::Evaluated evaluated;
};

std::optional<ReadText> read(Source& source, const ImportedFiles& files, const Definitions& definitions,
                             const Limits& limits, bool keep_formulas, Diagnostics& diagnostics) {
  diagnostics.set_notation(Notation::Text);
  if (!check_text(source, diagnostics) || !text::check_tokens(source, limits, diagnostics)) return std::nullopt;
  text::Tree tree;
  text::append(tree, text::parse(source, diagnostics, limits), {.file = &source});
  text::load_imports(tree, source, files.reader, files.to_text, limits, diagnostics);
  if (diagnostics.has_errors()) return std::nullopt;
  // After an error in a name or a value, continue, so that errors elsewhere are reported too.
  const std::optional<std::vector<std::uint32_t>> order = text::resolve_names(tree, diagnostics);
  if (!order) return std::nullopt;
  text::Evaluated evaluated = text::evaluate(tree, *order, definitions, limits, diagnostics, keep_formulas);
  const std::size_t errors = diagnostics.errors();
  syntax::File file = text::to_syntax(tree, evaluated, limits, diagnostics);
  const auto& objects = std::get<syntax::Record>(file.root.data).find("objects")->value->data;
  if (std::get<syntax::List>(objects).empty() || diagnostics.errors() > errors) return std::nullopt;
  return ReadText{std::move(file), std::move(evaluated)};
}

// Returns how many of the comments speak of the whole file: those before its first statement, up to the last that the
// head `fathom 1` or a blank line follows.
std::size_t comments_of_file(std::string_view text, const text::Tokens& tokens) {
  constexpr std::size_t kHead = 2;  // tokens
  std::size_t count = 0;
  for (std::size_t i = 0; i < tokens.comments.size() && tokens.comments[i].before <= kHead; ++i) {
    const text::Comment& comment = tokens.comments[i];
    const bool last = i + 1 == tokens.comments.size() || tokens.comments[i + 1].before > comment.before;
    const std::uint32_t next = last ? tokens.tokens[comment.before].span.begin : tokens.comments[i + 1].span.begin;
    const std::string_view between = text.substr(comment.span.end, next - comment.span.end);
    if (comment.before < kHead || std::ranges::count(between, '\n') > 1) count = i + 1;
  }
  return count;
}

}  // namespace

bool is_text_scene(std::string_view text) { return text::first_word(text) == "fathom"; }

bool is_meant_as_text(const Source& source) {
  const std::string_view name = source.name(), first = text::first_word(source.text());
  if (first == "fathom" || name.ends_with(".vm")) return first == "fathom";
  if (name.ends_with(".fathom")) return !first.empty();
  return std::ranges::find(text::kStatementWords, first) != std::end(text::kStatementWords);
}

std::optional<std::pair<syntax::File, Scope>> read_text_scene(Source& source, const Definitions& definitions,
                                                              const Limits& limits, Diagnostics& diagnostics,
                                                              const ImportedFiles& files) {
  std::optional<ReadText> made = read(source, files, definitions, limits, false, diagnostics);
  if (!made) return std::nullopt;
  return std::pair(std::move(made->file), std::move(made->evaluated.parameters));
}

JsonComments comments_of_text(const Source& source, const syntax::File& file) {
  // Offsets of properties and list elements that can have comments.
  std::set<std::uint32_t> places;
  for (const syntax::Property& property : std::get<syntax::Record>(file.root.data).properties) {
    if (property.name_span.end > 0) places.insert(property.name_span.begin);
    if (property.name == "objects") {
      for (const syntax::Value& part : std::get<syntax::List>(property.value->data)) places.insert(part.span.begin);
    }
    const auto* record = std::get_if<syntax::Record>(&property.value->data);
    for (std::size_t i = 0; record && i < record->properties.size(); ++i) {
      places.insert(record->properties[i].name_span.begin);
    }
  }
  places.erase(0);
  JsonComments comments;
  Diagnostics none;
  const text::Tokens tokens = text::read_tokens(source, none);
  const std::size_t of_file = comments_of_file(source.text(), tokens);
  for (std::size_t i = 0; i < tokens.comments.size(); ++i) {
    const text::Comment& comment = tokens.comments[i];
    std::uint32_t place = 0;  // of the first property, which no part of the text gives
    if (i >= of_file && !places.empty()) {
      const auto next = places.lower_bound(comment.span.begin);
      const bool beside = !comment.first_on_line && next != places.begin();
      place = beside || next == places.end() ? *std::prev(next) : *next;
    }
    comments.emplace(place, source.text().substr(comment.span.begin, comment.span.end - comment.span.begin));
  }
  return comments;
}

std::optional<SceneWithFormulas> read_text_with_formulas(Source& source, const Limits& limits,
                                                         Diagnostics& diagnostics, const ImportedFiles& files) {
  std::optional<ReadText> made = read(source, files, {}, limits, true, diagnostics);
  if (!made || diagnostics.has_errors()) return std::nullopt;
  return SceneWithFormulas{std::move(made->file), std::move(made->evaluated.frozen)};
}

}  // namespace fathom::compiler
