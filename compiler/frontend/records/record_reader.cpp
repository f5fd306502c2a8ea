#include "compiler/frontend/records/record_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "compiler/frontend/records/color_text.h"
#include "compiler/frontend/records/written_numbers.h"
#include "compiler/frontend/syntax/suggest.h"
#include "vm/program/check.h"

namespace fathom::compiler {
namespace {

using syntax::Value;

std::string expected(ValueType type, const Diagnostics& diagnostics) {
  switch (type) {
    case ValueType::Number:
    case ValueType::Version:
      return "a number";
    case ValueType::Integer:
    case ValueType::Seed:
      return "a whole number";
    case ValueType::Vec2:
      return "two numbers [x, y]";
    case ValueType::Vec3:
      return "three numbers [x, y, z]";
    case ValueType::Points:
      return "a list of three or more points [[x, y], ...]";
    case ValueType::Formula:
      return diagnostics.spelled("a formula \"...\" or a list of them", "a number or a formula of x, y and z");
    case ValueType::Color:
      return "a number or three numbers [red, green, blue]";
    case ValueType::Boolean:
      return "true or false";
    case ValueType::Text:
    case ValueType::Choice:
      return "a string";
    case ValueType::Record:
      return diagnostics.spelled("an object {...}", "a record (name = value, ...)");
    case ValueType::Named:
      return "an object {\"name\": {...}, ...}";
    case ValueType::Node:
      return diagnostics.spelled("a node {...}", "a node");
    case ValueType::Nodes:
      return diagnostics.spelled("a list of nodes [{...}, ...]", "a list of nodes");
    case ValueType::Scale:
      return "a number or three numbers [x, y, z]";
    case ValueType::Translation:
      return "three numbers [x, y, z], or two of an outline";
    case ValueType::Rotation:
      return diagnostics.spelled("three angles [x, y, z] or {\"axis\": [x, y, z], \"angle\": degrees}",
                                 "three angles [x, y, z] or axis = [x, y, z], angle = degrees");
    case ValueType::Background:
      return diagnostics.spelled(
          "a colour [red, green, blue], a number or {\"bottom\": colour, \"top\": colour}, a sky or an image",
          "a colour [red, green, blue], a number, (bottom = colour, top = colour), a sky or an image");
    case ValueType::Anything:
      break;
  }
  return "anything";
}

template <typename Each>
bool is_list(const Value& value, std::size_t least, const Each& each) {
  const auto* list = std::get_if<syntax::List>(&value.data);
  return list != nullptr && list->size() >= least && std::all_of(list->begin(), list->end(), each);
}
bool is_pair(const Value& value) {
  const auto number = [](const Value& item) { return std::holds_alternative<double>(item.data); };
  return is_list(value, 2, number) && std::get<syntax::List>(value.data).size() == 2;
}
bool is_points(const Value& value) { return is_list(value, 3, is_pair); }
bool is_formula(const Value& value) {
  const auto text = [](const Value& item) { return std::holds_alternative<std::string>(item.data); };
  return is_formula_text(value) || is_list(value, 1, text);
}

bool has_type(const Value& value, ValueType type) {
  const double* number = std::get_if<double>(&value.data);
  const bool record = std::holds_alternative<syntax::Record>(value.data);
  const bool three = number == nullptr && three_numbers(value).has_value();
  switch (type) {
    case ValueType::Number:
    case ValueType::Version:
      return number != nullptr;
    case ValueType::Integer:
    case ValueType::Seed:
      return number != nullptr && (!std::isfinite(*number) || *number == std::floor(*number));
    case ValueType::Vec2:
      return is_pair(value);
    case ValueType::Vec3:
      return three;
    case ValueType::Translation:
      return three || is_pair(value);
    case ValueType::Color:
      return number != nullptr || three;
    case ValueType::Boolean:
      return std::holds_alternative<bool>(value.data);
    case ValueType::Points:
      return is_points(value);
    case ValueType::Formula:
      return is_formula(value);
    case ValueType::Text:
    case ValueType::Choice:
      return std::holds_alternative<std::string>(value.data);
    case ValueType::Record:
    case ValueType::Named:
    case ValueType::Node:
      return record;
    case ValueType::Nodes:
      return std::holds_alternative<syntax::List>(value.data);
    case ValueType::Scale:
      return number != nullptr || three;
    case ValueType::Rotation:
      return record || three;
    case ValueType::Background:
      return record || three || number != nullptr;
    case ValueType::Anything:
      break;
  }
  return true;
}

// Returns the rule that the number breaks, as in "must be ...", or "" if the number is valid.
std::string broken_rule(double number, const PropertySpec& spec, const Limits& limits) {
  const Range& range = spec.range;
  if (!std::isfinite(number)) return "finite";
  if (spec.rule == Rule::Positive && !(number > 0)) return "positive";
  if (spec.rule == Rule::NotNegative && !(number >= 0)) return "zero or positive";
  const bool inside =
      range.open ? number > range.least && number < range.most : number >= range.least && number <= range.most;
  if (range.most == kLargest && range.least == -kLargest) {
    return std::abs(number) <= limits.coordinate ? "" : fmt::format("at most {} in magnitude", limits.coordinate);
  }
  if (inside) return "";
  if (range.open) return fmt::format("greater than {} and less than {}", range.least, range.most);
  return fmt::format("between {} and {}", range.least, range.most);
}

// As broken_rule(), for a seed. A number that is not written in digits is a double, which may be a neighbour's from
// 2^53 on.
std::string broken_rule_of_seed(const Value& value) {
  const double number = std::get<double>(value.data);
  if (!std::isfinite(number)) return "finite";
  if (value.integer != 0 || (number >= 0 && number < 0x1p53)) return "";
  if (number > 0 && number < 0x1p64) return "below 2^53 or written in digits alone, as 18446744073709551615";
  return "between 0 and 18446744073709551615";
}

struct ReadFailure {
  std::string rule;
  const Value* value;
};

// Returns the first number of the value that breaks a rule of its property.
std::optional<ReadFailure> first_broken(const Value& value, const PropertySpec& spec, const Limits& limits) {
  if (const double* number = std::get_if<double>(&value.data)) {
    const std::string rule =
        spec.type == ValueType::Seed ? broken_rule_of_seed(value) : broken_rule(*number, spec, limits);
    return rule.empty() ? std::nullopt : std::optional(ReadFailure{rule, &value});
  }
  const auto* list = std::get_if<syntax::List>(&value.data);
  if (list == nullptr) return std::nullopt;
  bool all_zero = true;
  for (const Value& item : *list) {
    if (std::holds_alternative<syntax::List>(item.data)) {
      if (auto broken = first_broken(item, spec, limits)) return broken;
    }
    const double* number = std::get_if<double>(&item.data);
    if (number == nullptr) continue;
    const std::string rule = broken_rule(*number, spec, limits);
    if (!rule.empty()) return ReadFailure{rule, &item};
    all_zero = all_zero && *number == 0;
  }
  if (spec.rule == Rule::NotZero && all_zero) return ReadFailure{"a direction, not the zero vector", &value};
  return std::nullopt;
}

// Returns the index of the word among the row's choices, or nullopt if the word is not a choice.
std::optional<std::size_t> choice_of(const Value& value, const PropertySpec& row) {
  const auto found = std::find(row.choices.begin(), row.choices.end(), std::get<std::string>(value.data));
  if (found == row.choices.end()) return std::nullopt;
  return static_cast<std::size_t>(found - row.choices.begin());
}

std::vector<std::string> about(const PropertySpec& spec) { return {fmt::format("`{}`: {}", spec.name, spec.doc)}; }

// Returns help for a value of the wrong type.
std::vector<std::string> retype(const Value& value, const Value& written, const PropertySpec& spec) {
  const bool number = std::holds_alternative<double>(value.data);
  const bool whole = spec.type == ValueType::Integer || spec.type == ValueType::Seed;
  if (whole && number && std::holds_alternative<std::string>(written.data)) {
    return {about(spec)[0], "round(...), floor(...) and ceil(...) make whole numbers"};
  }
  if (spec.type == ValueType::Rotation && number) {
    return {fmt::format("[0, {}, 0] turns about y", std::get<double>(value.data))};
  }
  if (spec.type == ValueType::Nodes && std::holds_alternative<syntax::Record>(value.data)) {
    return {"put the node in brackets: [{...}]"};
  }
  if (spec.type == ValueType::Node && std::holds_alternative<syntax::List>(value.data)) {
    return {"make one node of several with {\"type\": \"union\", \"of\": [...]}"};
  }
  return about(spec);
}

// Returns help for a value out of range.
std::vector<std::string> correct(const Value& value, const PropertySpec& spec) {
  std::vector<std::string> help = about(spec);
  const std::string text = spec.type == ValueType::Color ? color_text_of(value) : "";
  if (!text.empty()) help.push_back(fmt::format("a colour as a screen shows it is \"{}\"", text));
  return help;
}

// Returns the name under which values are looked up.
std::string_view own_name(const PropertySpec& row) { return row.alias_of.empty() ? row.name : row.alias_of; }

std::vector<std::string_view> known_properties(const RecordSpec& spec) {
  std::vector<std::string_view> known;
  for (const PropertySpec& row : spec.properties) {
    if (row.name[0] != '$') known.push_back(row.name);
  }
  return known;
}

// True if an unknown property of the record is probably a misspelling of this one, so that reporting a missing
// property would be wrong.
bool misnamed(const PropertySpec& missing, const RecordSpec& spec, const syntax::Record& record) {
  return std::any_of(record.properties.begin(), record.properties.end(), [&](const syntax::Property& property) {
    return !spec.find(property.name) && suggest(property.name, known_properties(spec)) == missing.name;
  });
}

// Returns a hint that another row of the family has the property, such as: `ior` goes with "type": "transparent".
std::string owner(const RecordSpec& spec, std::string_view property, const Diagnostics& diagnostics) {
  for (const auto* family : {&camera_records(), &material_records(), &light_records(), &background_records()}) {
    const auto same = [&](const RecordSpec& row) { return &row == &spec; };
    if (std::none_of(family->begin(), family->end(), same)) continue;
    for (const RecordSpec& row : *family) {
      if (!row.find(property)) continue;
      return diagnostics.spelled(fmt::format("`{}` goes with \"type\": \"{}\"", property, row.type),
                                 fmt::format("`{}` goes with {}(...)", property, row.type));
    }
  }
  return "";
}

bool is_numeric(ValueType type) {
  return type == ValueType::Number || type == ValueType::Integer || type == ValueType::Vec2 ||
         type == ValueType::Vec3 || type == ValueType::Color || type == ValueType::Points ||
         type == ValueType::Translation;
}

}  // namespace

// Appends the numbers of a number, a list or a list of lists, in order.
void append_numbers(const Value& value, std::vector<double>& out) {
  if (const double* number = std::get_if<double>(&value.data)) out.push_back(*number);
  if (const auto* list = std::get_if<syntax::List>(&value.data)) {
    for (const Value& item : *list) append_numbers(item, out);
  }
}

RecordReader::RecordReader(const RecordSpec& spec, const syntax::Record& record, Span place, const Scope& scope,
                           Diagnostics& diagnostics, const char* range_code)
    : spec_(spec), scope_(scope), diagnostics_(diagnostics), range_code_(range_code) {
  const std::size_t before = diagnostics.errors();
  for (const syntax::Property& property : record.properties) {
    if (!diagnostics.full()) check(property);
  }
  for (const PropertySpec& row : spec.properties) {
    if (diagnostics.full() || !row.required || record.find(row.name) || misnamed(row, spec, record)) continue;
    diagnostics.error("E0103", place, fmt::format("{} has no `{}`", spec.title, row.name),
                      fmt::format("needs `{}`: {}", row.name, expected(row.type, diagnostics)), about(row));
  }
  check_aliases(record);
  good_ = good_ && diagnostics.errors() == before;
}

void RecordReader::check(const syntax::Property& property) {
  const PropertySpec* row = spec_.find(property.name);
  if (row == nullptr) {
    std::vector<std::string> help = {did_you_mean(property.name, known_properties(spec_))};
    const std::string elsewhere = owner(spec_, property.name, diagnostics_);
    if (!elsewhere.empty()) help.insert(help.begin(), elsewhere);
    diagnostics_.error("E0102", property.name_span,
                       property.name.empty() ? fmt::format("a property without a name in {}", spec_.title)
                                             : fmt::format("unknown property `{}` in {}", property.name, spec_.title),
                       fmt::format("not a {} property", spec_.noun), std::move(help));
  } else if (is_color_text(*property.value, row->type, scope_)) {
    check_color_text(*property.value, *row);
  } else if (row->varies && varies(*property.value)) {
    fit_.push_back({own_name(*row), property.value.get()});
  } else if (!has_formulas(*property.value, row->type)) {
    check_value(*property.value, *property.value, *row);
  } else if (auto numbers = evaluated(*property.value, scope_, diagnostics_, row->varies)) {
    evaluated_.push_back(std::make_unique<const Value>(std::move(*numbers)));
    check_value(*evaluated_.back(), *property.value, *row);
  } else {
    good_ = false;
  }
}

void RecordReader::check_color_text(const Value& value, const PropertySpec& row) {
  if (auto numbers = read_color_text(value, diagnostics_)) {
    evaluated_.push_back(std::make_unique<const Value>(std::move(*numbers)));
    check_value(*evaluated_.back(), value, row);
  } else {
    good_ = false;
  }
}

void RecordReader::check_value(const Value& value, const Value& written, const PropertySpec& row) {
  if (!has_type(value, row.type)) {
    const std::string formula = explain(written, value);
    const std::string instead = formula.empty() ? ", not " + describe(value) : formula;
    diagnostics_.error("E0101", value.span,
                       fmt::format("`{}` must be {}{}", row.name, expected(row.type, diagnostics_), instead), "",
                       retype(value, written, row));
  } else if (const std::optional<ReadFailure> broken = first_broken(value, row, scope_.limits())) {
    diagnostics_.error(range_code_, broken->value->span,
                       fmt::format("`{}` must be {}{}", row.name, broken->rule, explain(written, *broken->value)), "",
                       correct(value, row));
  } else if (row.type == ValueType::Choice && !choice_of(value, row)) {
    const std::string& word = std::get<std::string>(value.data);
    diagnostics_.error("E0108", value.span, fmt::format("unknown {} of {} `{}`", row.name, spec_.title, word), "",
                       {did_you_mean(word, row.choices), about(row)[0]});
  } else {
    fit_.push_back({own_name(row), &value});
  }
}

void RecordReader::check_aliases(const syntax::Record& record) {
  for (const PropertySpec& alias : spec_.properties) {
    const syntax::Property* given = alias.alias_of.empty() ? nullptr : record.find(alias.name);
    if (given == nullptr || !record.find(alias.alias_of)) continue;
    diagnostics_.error("E0106", given->name_span,
                       fmt::format("both `{}` and `{}` are given", alias.alias_of, alias.name),
                       "two names of one property", {fmt::format("keep one of them; {}", about(alias)[0])});
    good_ = false;
  }
}

const Value* RecordReader::value(std::string_view name) const {
  for (const Fit& fit : fit_) {
    if (fit.name == name) return fit.value;
  }
  return nullptr;
}

std::vector<double> RecordReader::numbers(std::string_view name) const {
  const PropertySpec* row = spec_.find(name);
  CHECK(row != nullptr && is_numeric(row->type), "a property of the table, with numbers");
  const Value* given = value(name);
  const bool single = row->type == ValueType::Number || row->type == ValueType::Integer;
  if (given == nullptr || (row->varies && varies(*given)))
    return !row->fallback.empty() ? row->fallback : std::vector<double>(single ? 1 : 3, 0.0);
  std::vector<double> all;
  append_numbers(*given, all);
  if (row->type == ValueType::Color && all.size() == 1) all.assign(3, all[0]);
  return all;
}

std::uint64_t RecordReader::seed(std::string_view name) const {
  const Value* given = value(name);
  if (given == nullptr) return 0;
  return given->integer != 0 ? given->integer : static_cast<std::uint64_t>(std::get<double>(given->data));
}

std::size_t RecordReader::choice(std::string_view name) const {
  const PropertySpec* row = spec_.find(name);
  CHECK(row != nullptr && row->type == ValueType::Choice, "a property of the table, one of some words");
  const Value* given = value(name);
  return given == nullptr ? 0 : *choice_of(*given, *row);
}

bool RecordReader::flag(std::string_view name, bool fallback) const {
  const Value* given = value(name);
  return given != nullptr ? std::get<bool>(given->data) : fallback;
}

glm::dvec3 RecordReader::vec3(std::string_view name) const {
  const std::vector<double> v = numbers(name);
  return {v[0], v[1], v.size() == 2 ? 0 : v[2]};
}

}  // namespace fathom::compiler
