#include "compiler/frontend/records/parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compiler/frontend/formula/formula.h"
#include "compiler/frontend/formula/formula_evaluate.h"
#include "compiler/frontend/formula/formula_functions.h"
#include "compiler/frontend/formula/formula_parser.h"
#include "compiler/frontend/formula/read_formula.h"
#include "compiler/frontend/records/record_reader.h"
#include "compiler/frontend/syntax/suggest.h"

namespace fathom::compiler {
namespace {

// Returns the default of a record {"default": ..., ...} and stores the allowed range. Returns nullopt after a report.
std::optional<double> read_record(const syntax::Record& record, Span place, const Scope& scope, Parameter& parameter,
                                  Diagnostics& diagnostics) {
  const RecordReader reader(parameter_record(), record, place, scope, diagnostics);
  if (reader.value("min")) parameter.min = reader.number("min");
  if (reader.value("max")) parameter.max = reader.number("max");
  if (const syntax::Value* doc = reader.value("doc")) parameter.doc = std::get<std::string>(doc->data);
  return reader.good() ? std::optional(reader.number("default")) : std::nullopt;
}

// Returns the value that the scene gives, or nullopt after a report.
std::optional<double> read_value(const syntax::Property& property, const Scope& scope, Parameter& parameter,
                                 Diagnostics& diagnostics) {
  const syntax::Value& value = *property.value;
  if (const double* number = std::get_if<double>(&value.data)) return *number;
  if (std::holds_alternative<std::string>(value.data)) return read_number(value, scope, diagnostics);
  if (const auto* record = std::get_if<syntax::Record>(&value.data)) {
    return read_record(*record, property.name_span, scope, parameter, diagnostics);
  }
  diagnostics.error(
      "E0101", value.span, fmt::format("parameter `{}` must be a number, not {}", property.name, describe(value)), "",
      {"such as 0.5, \"2*r\" or {\"default\": 0.5, \"min\": 0, \"max\": 1, \"doc\": \"what it does\"}"});
  return std::nullopt;
}

std::string describe_range(const Parameter& parameter) {
  if (std::isinf(parameter.max)) return fmt::format("at least {}", parameter.min);
  if (std::isinf(parameter.min)) return fmt::format("at most {}", parameter.max);
  return fmt::format("between {} and {}", parameter.min, parameter.max);
}

// Returns the rule that the parameter's value breaks, or "" if the value is valid.
std::string broken_rule(const Parameter& parameter) {
  if (!std::isfinite(parameter.value)) return "finite";
  if (!(std::abs(parameter.value) <= kLargest)) return fmt::format("at most {} in magnitude", kLargest);
  if (parameter.value < parameter.min || parameter.value > parameter.max) return describe_range(parameter);
  return "";
}

bool check_name(const syntax::Property& property, Diagnostics& diagnostics) {
  const std::string misfit = misfit_name(property.name, formula_functions(constant_functions()));
  if (misfit.empty()) return true;
  diagnostics.error("E0407", property.name_span, fmt::format("the name `{}` {}", property.name, misfit), "",
                    {"choose another name; formulas call the parameter by it"});
  return false;
}

const double* find(const Definitions& definitions, std::string_view name) {
  const auto same = [&](const auto& definition) { return definition.first == name; };
  const auto found = std::find_if(definitions.rbegin(), definitions.rend(), same);
  return found == definitions.rend() ? nullptr : &found->second;
}

void read_entry(const syntax::Property& property, const Definitions& definitions, const Scope& scope,
                Scope::Entry& entry, Diagnostics& diagnostics) {
  const bool good_name = check_name(property, diagnostics);
  Parameter& parameter = entry.parameter;
  const std::optional<double> own = read_value(property, scope, parameter, diagnostics);
  const double* given = find(definitions, property.name);
  entry.state = Scope::State::Unusable;
  if (!own || !good_name) return;
  if (parameter.min > parameter.max) {
    diagnostics.error("E0408", property.value->span,
                      fmt::format("no number is at least {} and at most {}", parameter.min, parameter.max), "",
                      {"exchange `min` and `max`"});
    return;
  }
  parameter.value = given ? *given : *own;
  const std::string rule = broken_rule(parameter);
  if (rule.empty()) {
    entry.state = Scope::State::Known;
    return;
  }
  std::vector<std::string> help;
  if (!parameter.doc.empty()) help = {fmt::format("`{}`: {}", parameter.name, parameter.doc)};
  diagnostics.error(
      given ? "E0502" : "E0408", given ? property.name_span : property.value->span,
      fmt::format("`{}` must be {}; it is {}", parameter.name, rule, describe(syntax::Value{{}, parameter.value})),
      "", std::move(help));
}

}  // namespace

void check_definitions(const Definitions& definitions, const Scope& scope, Diagnostics& diagnostics) {
  std::vector<std::string_view> known;
  for (const Scope::Entry& entry : scope.entries()) known.push_back(entry.parameter.name);
  for (const auto& [name, value] : definitions) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    diagnostics.error(
        "E0501", {}, fmt::format("the scene has no parameter `{}`, which is given a value", name), "",
        {known.empty() ? diagnostics.spelled("parameters are declared in the scene: \"params\": {\"r\": 0.5}",
                                             "parameters are declared in the scene: param r = 0.5")
                       : did_you_mean(name, known)});
  }
}

const Scope::Entry& read_parameter(const syntax::Property& property, const Definitions& definitions, Scope& scope,
                                   Diagnostics& diagnostics) {
  scope.declare(property.name, property.name_span);
  Scope::Entry& entry = scope.at(scope.entries().size() - 1);
  read_entry(property, definitions, scope, entry, diagnostics);
  return entry;
}

Scope read_parameters(const syntax::Value* params, const Definitions& definitions, const Limits& limits,
                      Diagnostics& diagnostics) {
  Scope scope(limits);
  // Any other type of `params` is reported with the scene's other properties.
  const auto* record = params ? std::get_if<syntax::Record>(&params->data) : nullptr;
  if (record) {
    for (const syntax::Property& property : record->properties) scope.declare(property.name, property.name_span);
    for (std::size_t i = 0; i < record->properties.size(); ++i) {
      read_entry(record->properties[i], definitions, scope, scope.at(i), diagnostics);
    }
  }
  check_definitions(definitions, scope, diagnostics);
  return scope;
}

void warn_of_unused(const Scope& scope, Diagnostics& diagnostics) {
  for (const Scope::Entry& entry : scope.entries()) {
    if (entry.used) continue;
    const std::string& name = entry.parameter.name;
    diagnostics.warning(
        "W0404", entry.span, fmt::format("unused parameter `{}`", name), "no formula has it",
        {diagnostics.spelled(fmt::format("a number of the scene can be a formula, as in \"radius\": \"2*{}\"", name),
                             fmt::format("it stands for its value, as in sphere(2*{})", name))});
  }
}

bool declares(const Scope& parameters, std::string_view name) {
  const auto& entries = parameters.entries();
  return std::any_of(entries.begin(), entries.end(), [&](const auto& entry) { return entry.parameter.name == name; });
}

}  // namespace fathom::compiler
