#include "runtime/cli/view/keep_parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "compiler/frontend/syntax/json.h"
#include "compiler/frontend/text/parse/parser.h"
#include "compiler/frontend/text/read_text.h"

namespace fathom::cli {
namespace {

using compiler::Span;

// A number in the text, to be replaced.
struct Replacement {
  Span span;
  double value;
};
using Found = std::variant<Span, KeepError>;

KeepError is_formula(std::string_view name) {
  return {fmt::format("the default of `{}` is a formula; change it in the file", name)};
}

Found find_in_text(const compiler::text::ParsedFile& file, std::string_view name) {
  using compiler::text::Expr, compiler::text::Statement;
  for (const Statement& statement : file.statements) {
    if (statement.kind != Statement::Kind::Param || statement.name != name || statement.value == nullptr) continue;
    const Expr& value = *statement.value;
    if (value.groups > 0) return is_formula(name);
    if (value.kind == Expr::Kind::Number) return value.span;
    const bool negative = value.kind == Expr::Kind::Negate && value.of[0]->kind == Expr::Kind::Number;
    if (!negative || value.of[0]->groups > 0) return is_formula(name);
    return Span{std::min(value.span.begin, value.of[0]->span.begin), value.of[0]->span.end};
  }
  return KeepError{fmt::format("the file has no parameter `{}`", name)};
}

Found find_in_json(const compiler::syntax::File& file, std::string_view name) {
  using compiler::syntax::Property, compiler::syntax::Record;
  const auto* root = std::get_if<Record>(&file.root.data);
  const Property* parameters = root ? root->find("params") : nullptr;
  const auto* record = parameters ? std::get_if<Record>(&parameters->value->data) : nullptr;
  const Property* property = record ? record->find(name) : nullptr;
  if (const auto* own = property ? std::get_if<Record>(&property->value->data) : nullptr) {
    property = own->find("default");
  }
  if (property == nullptr) return KeepError{fmt::format("the file has no parameter `{}`", name)};
  if (!std::holds_alternative<double>(property->value->data)) return is_formula(name);
  return property->value->span;
}

// Returns the span of each value, in the order of `values`.
template <class Find>
std::variant<std::vector<Replacement>, KeepError> find_all(const compiler::Definitions& values, const Find& find) {
  std::vector<Replacement> replacements;
  for (const auto& [name, value] : values) {
    const Found found = find(name);
    if (const auto* error = std::get_if<KeepError>(&found)) return *error;
    replacements.push_back({std::get<Span>(found), value});
  }
  return replacements;
}

}  // namespace

std::variant<std::string, KeepError> keep_parameters(const compiler::Source& source,
                                                     const compiler::Definitions& values) {
  compiler::Diagnostics diagnostics;
  std::variant<std::vector<Replacement>, KeepError> found = KeepError{"the file has errors"};
  if (compiler::is_meant_as_text(source)) {
    const compiler::text::ParsedFile file = compiler::text::parse(source, diagnostics, {});
    if (diagnostics.has_errors()) return KeepError{"the file has errors"};
    found = find_all(values, [&](std::string_view name) { return find_in_text(file, name); });
  } else {
    const std::optional<compiler::syntax::File> file = compiler::read_json(source, diagnostics);
    if (!file) return KeepError{"the file has errors"};
    found = find_all(values, [&](std::string_view name) { return find_in_json(*file, name); });
  }
  if (const auto* error = std::get_if<KeepError>(&found)) return *error;
  auto& replacements = std::get<std::vector<Replacement>>(found);
  std::ranges::sort(replacements, {}, [](const Replacement& r) { return r.span.begin; });
  std::string text = source.text();
  for (auto r = replacements.rbegin(); r != replacements.rend(); ++r) {
    text.replace(r->span.begin, r->span.end - r->span.begin, fmt::format("{}", r->value));
  }
  return text;
}

}  // namespace fathom::cli
