#include "compiler/frontend/records/written_numbers.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "compiler/frontend/formula/formula.h"
#include "compiler/frontend/formula/formula_lexer.h"
#include "compiler/frontend/formula/read_formula.h"

namespace fathom::compiler {
namespace {

using syntax::Value;

bool may_be_number(ValueType type) {
  return type == ValueType::Number || type == ValueType::Integer || type == ValueType::Seed ||
         type == ValueType::Scale || type == ValueType::Color || type == ValueType::Background;
}

bool may_be_numbers(ValueType type) {
  return type == ValueType::Vec2 || type == ValueType::Vec3 || type == ValueType::Points ||
         type == ValueType::Color || type == ValueType::Scale || type == ValueType::Translation ||
         type == ValueType::Rotation || type == ValueType::Background;
}

bool has_text(const Value& value) {
  const auto* list = std::get_if<syntax::List>(&value.data);
  return list ? std::any_of(list->begin(), list->end(), has_text) : is_formula_text(value);
}

// True if the value consists of numbers and formulas only, possibly in lists.
bool is_arithmetic(const Value& value) {
  if (const auto* list = std::get_if<syntax::List>(&value.data)) {
    return std::all_of(list->begin(), list->end(), is_arithmetic);
  }
  return is_formula_text(value) || std::holds_alternative<double>(value.data);
}

// Returns the scalar of the value whose span begins at `begin`, or nullptr if no scalar begins there.
const Value* scalar_at(const Value& value, std::uint32_t begin) {
  const auto* list = std::get_if<syntax::List>(&value.data);
  if (list == nullptr) return value.span.begin == begin ? &value : nullptr;
  for (const Value& item : *list) {
    if (const Value* found = scalar_at(item, begin)) return found;
  }
  return nullptr;
}

}  // namespace

bool has_formulas(const Value& value, ValueType type) {
  if (is_formula_text(value)) return may_be_number(type);
  return may_be_numbers(type) && has_text(value) && is_arithmetic(value);
}

std::optional<Value> evaluated(const Value& value, const Scope& scope, Diagnostics& diagnostics, bool may_vary) {
  if (const double* number = std::get_if<double>(&value.data)) return Value{value.span, *number};
  const auto* list = std::get_if<syntax::List>(&value.data);
  if (list == nullptr) {
    const std::optional<double> number = read_number(value, scope, diagnostics, may_vary);
    const auto* text = std::get_if<std::string>(&value.data);
    return number ? std::optional(Value{value.span, *number, text ? integer_of(*text) : 0}) : std::nullopt;
  }
  syntax::List numbers;
  for (const Value& item : *list) {
    if (auto number = evaluated(item, scope, diagnostics, may_vary)) numbers.push_back(std::move(*number));
  }
  if (numbers.size() != list->size()) return std::nullopt;
  return Value{value.span, std::move(numbers)};
}

bool varies(const Value& value) {
  if (const auto* list = std::get_if<syntax::List>(&value.data))
    return std::any_of(list->begin(), list->end(), varies);
  if (std::holds_alternative<syntax::ReadFormula>(value.data)) return true;
  const auto* text = std::get_if<std::string>(&value.data);
  if (text == nullptr) return std::holds_alternative<syntax::Record>(value.data);
  FormulaLexer lexer(*text);
  for (Token token = lexer.next(); token.kind != Token::Kind::End; token = lexer.next()) {
    if (token.kind == Token::Kind::Name && (token.text == "x" || token.text == "y" || token.text == "z")) return true;
  }
  return false;
}

std::string explain(const Value& written, const Value& part) {
  if (!std::holds_alternative<double>(part.data)) return "";
  const Value* place = scalar_at(written, part.span.begin);
  const auto* text = place ? std::get_if<std::string>(&place->data) : nullptr;
  return text ? fmt::format("; `{}` is {}", *text, describe(part)) : "";
}

}  // namespace fathom::compiler
