// Formulas that numbers come from, for JSON scenes: "2*r + 1" for a number that is 5 because the parameter r is 2.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "compiler/frontend/text/evaluate/evaluator.h"

namespace fathom::compiler::text {
namespace {

constexpr int kSumLevel = 1, kProductLevel = 2, kSignLevel = 3, kPowerLevel = 4, kAtomLevel = 5;
// Maximum length in characters. Longer spellings come from loops, and the plain number is as informative.
constexpr std::size_t kLongestSpelling = 4000;
// Maximum length in characters of all spellings of a scene: two thousand folds of 300 steps took 4 GB.
constexpr std::size_t kMostSpelled = 64 << 20;

int level_of(char mark) {
  return mark == '+' || mark == '-' ? kSumLevel : mark == '*' || mark == '/' ? kProductLevel : kPowerLevel;
}

// Adds parentheses to an operand that binds less tightly than `level`.
std::string operand(const std::string& text, int precedence, int level) {
  return precedence >= level ? text : "(" + text + ")";
}

// Adds the lines that `from` needs to `into`, and its dependence on parameters.
void merge(Spelling& into, const Spelling& from) {
  into.is_parametric = into.is_parametric || from.is_parametric;
  for (const Spelling::Line* line : from.lines) {
    if (std::ranges::find(into.lines, line) == into.lines.end()) into.lines.push_back(line);
  }
  std::ranges::sort(into.lines, {}, &Spelling::Line::number);
}

// True if two lines of the same name come from different places.
bool is_ambiguous(const Spelling& spelling) {
  for (std::size_t i = 0; i < spelling.lines.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (spelling.lines[i]->name == spelling.lines[j]->name) return true;
    }
  }
  return false;
}

// Writes the lines of an ambiguous spelling out where they are used.
void without_ambiguity(Spelling& spelling) {
  if (!is_ambiguous(spelling)) return;
  spelling.text = spelling.inlined;
  spelling.lines.clear();
}

}  // namespace

// Returns the spelling of a value. A number without a spelling is spelled as its digits.
const Spelling* Evaluator::spelling_of(const Value& value) {
  if (value.spelling || !value.is(Type::Number)) return value.spelling;
  Spelling made;
  made.text = made.inlined = fmt::format("{}", value.number);
  made.precedence = made.text[0] == '-' ? kSignLevel : kAtomLevel;
  return &out_.store.spellings.emplace_back(std::move(made));
}

// Gives the value a spelling, unless those of the scene take too much memory by now.
void Evaluator::spell(Value& value, Spelling made) {
  out_.store.spelled += made.text.size() + made.inlined.size();
  const bool room = out_.store.spelled <= kMostSpelled;
  if (!room && made.is_parametric) note_frozen(value.span);
  value.spelling = room ? &out_.store.spellings.emplace_back(std::move(made)) : nullptr;
}

void Evaluator::spell_name(Value& value, std::string_view name, bool parametric) {
  if (!keep_formulas_) return;
  Spelling made;
  made.text = made.inlined = name;
  made.precedence = kAtomLevel, made.is_parametric = parametric;
  spell(value, std::move(made));
}

void Evaluator::spell_number(Value& value, std::string_view text) {
  if (!keep_formulas_) return;
  Spelling made;
  made.text = made.inlined = text;
  made.precedence = kAtomLevel, made.is_literal = true;
  spell(value, std::move(made));
}

void Evaluator::spell_sign(Value& value, const Value& of) {
  if (!keep_formulas_ || of.spelling == nullptr) return;
  Spelling made;
  made.text = "-" + operand(of.spelling->text, of.spelling->precedence, kSignLevel);
  made.inlined = "-" + operand(of.spelling->inlined, of.spelling->precedence, kSignLevel);
  made.precedence = kSignLevel, made.is_literal = of.spelling->is_literal;
  merge(made, *of.spelling);
  spell(value, std::move(made));
}

void Evaluator::spell_pair(Value& value, char mark, const Value& a, const Value& b) {
  const Value operands[] = {a, b};
  if (!keep_formulas_) return;
  const bool plain = a.spelling == nullptr || b.spelling == nullptr;
  const Spelling *left = spelling_of(a), *right = spelling_of(b);
  if (left == nullptr || right == nullptr) return;
  if (plain && value.is(Type::Number) && !left->is_parametric && !right->is_parametric) return;
  const int level = level_of(mark);
  const std::string_view joint = mark == '+' ? " + " : mark == '-' ? " - " : mark == '*' ? "*" : mark == '/' ? "/" : "^";
  // The base of a power must be an atom, and the exponent may have a sign.
  const int left_level = mark == '^' ? kAtomLevel : level, right_level = mark == '^' ? kSignLevel : level + 1;
  Spelling made;
  made.text = operand(left->text, left->precedence, left_level) + std::string(joint) +
              operand(right->text, right->precedence, right_level);
  made.inlined = operand(left->inlined, left->precedence, left_level) + std::string(joint) +
                 operand(right->inlined, right->precedence, right_level);
  made.precedence = level;
  for (const Spelling* part : {left, right}) merge(made, *part);
  if (made.inlined.size() > kLongestSpelling) {
    for (const Value& one : operands) freeze(one, value.span);
    return;
  }
  without_ambiguity(made);
  spell(value, std::move(made));
}

void Evaluator::spell_call(Value& value, std::string_view function, Values arguments) {
  if (!keep_formulas_) return;
  Spelling made;
  made.text = made.inlined = function;
  bool plain = false;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    plain = plain || arguments[i].spelling == nullptr;
    const Spelling* part = spelling_of(arguments[i]);
    if (part == nullptr) return;
    made.text += (i == 0 ? "(" : ", ") + part->text;
    made.inlined += (i == 0 ? "(" : ", ") + part->inlined;
    merge(made, *part);
  }
  made.text += ")", made.inlined += ")";
  made.precedence = kAtomLevel;
  if (plain && value.is(Type::Number) && !made.is_parametric) return;
  if (made.inlined.size() > kLongestSpelling) {
    for (const Value& one : arguments) freeze(one, value.span);
    return;
  }
  without_ambiguity(made);
  spell(value, std::move(made));
}

void Evaluator::spell_group(Value& value) {
  if (value.spelling == nullptr || !is_number(value)) return;
  Spelling made = *value.spelling;
  made.text = "(" + made.text + ")", made.inlined = "(" + made.inlined + ")";
  made.precedence = kAtomLevel, made.is_literal = false;
  spell(value, std::move(made));
}

// Turns `let name = value in ...` into a line of its own in a JSON scene's formula.
void Evaluator::spell_line(Value& value, std::string_view name) {
  if (value.spelling == nullptr || !is_number(value)) return;
  Spelling made = *value.spelling;
  made.lines.push_back(&out_.store.lines.emplace_back(Spelling::Line{name, made.text, out_.store.lines.size()}));
  made.text = name;
  if (made.precedence < kAtomLevel) made.inlined = "(" + made.inlined + ")";
  made.precedence = kAtomLevel;
  spell(value, std::move(made));
}

// Keeps the lines of a formula's `let` even if the formula does not use them.
void Evaluator::keep_lines(Value& value, Values bindings) {
  if (value.spelling == nullptr || !value.is(Type::Formula)) return;
  Spelling made = *value.spelling;
  for (const Value& binding : bindings) {
    if (binding.spelling) merge(made, *binding.spelling);
  }
  if (!is_ambiguous(made)) spell(value, std::move(made));
}

void Evaluator::note_frozen(Span span) {
  const bool again = !out_.frozen.empty() && out_.frozen.back().begin == span.begin;
  if (!again) out_.frozen.push_back(span);
}

void Evaluator::freeze(const Value& value, Span span) {
  if (value.spelling && value.spelling->is_parametric) note_frozen(span);
}

}  // namespace fathom::compiler::text
