#include "tests/support/schema_check.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <regex>
#include <stdexcept>

namespace fathom::test {
namespace {

using Json = nlohmann::json;

bool has_type(const Json& value, const std::string& type) {
  if (type == "object") return value.is_object();
  if (type == "array") return value.is_array();
  if (type == "string") return value.is_string();
  if (type == "boolean") return value.is_boolean();
  if (type == "number") return value.is_number();
  if (type == "boolean") return value.is_boolean();
  if (type == "integer") return value.is_number() && std::floor(value.get<double>()) == value.get<double>();
  throw std::runtime_error("unknown type " + type);
}

struct Context {
  const Json& value;
  const Json& schema;  // the schema that contains the keyword
  const Json& whole;
};
// Returns true if the keyword's `rule` holds. A rule about objects holds for every value that is not an object, and
// similarly for the other types.
using Keyword = std::function<bool(const Context&, const Json& rule)>;

// Returns the name of the first keyword of the schema that does not hold, or nullptr.
const std::string* broken_keyword(const Json& value, const Json& schema, const Json& whole);

bool fits(const Json& value, const Json& schema, const Json& whole) {
  return broken_keyword(value, schema, whole) == nullptr;
}

std::size_t count_fitting(const Context& at, const Json& schemas) {
  std::size_t count = 0;
  for (const Json& schema : schemas) count += fits(at.value, schema, at.whole);
  return count;
}

bool check_properties(const Context& at, const Json& rule) {
  if (!at.value.is_object()) return true;
  // Checks `const` properties first. These properties reject all kinds of nodes except the right one at once. Without
  // them deep nesting would take forever.
  for (const bool constants : {true, false}) {
    for (const auto& [name, schema] : rule.items()) {
      if (schema.contains("const") != constants || !at.value.contains(name)) continue;
      if (!fits(at.value[name], schema, at.whole)) return false;
    }
  }
  return true;
}

bool check_additional(const Context& at, const Json& rule) {
  if (!at.value.is_object()) return true;
  for (const auto& [name, value] : at.value.items()) {
    if (at.schema.contains("properties") && at.schema["properties"].contains(name)) continue;
    if (rule.is_boolean() ? !rule.get<bool>() : !fits(value, rule, at.whole)) return false;
  }
  return true;
}

bool check_required(const Context& at, const Json& rule) {
  if (!at.value.is_object()) return true;
  for (const Json& name : rule) {
    if (!at.value.contains(name.get<std::string>())) return false;
  }
  return true;
}

bool check_items(const Context& at, const Json& rule) {
  if (!at.value.is_array()) return true;
  for (const Json& item : at.value) {
    if (!fits(item, rule, at.whole)) return false;
  }
  return true;
}

template <typename Compare>
Keyword limit(Compare compare) {
  return [compare](const Context& at, const Json& rule) {
    return !at.value.is_number() || compare(at.value.get<double>(), rule.get<double>());
  };
}

bool resolve(const Context& at, const Json& rule) {
  const std::string path = rule.get<std::string>();
  if (path.empty() || path[0] != '#') throw std::runtime_error("a reference to elsewhere: " + path);
  return fits(at.value, at.whole.at(Json::json_pointer(path.substr(1))), at.whole);
}

const std::map<std::string, Keyword>& keywords() {
  const Keyword note = [](const Context&, const Json&) { return true; };
  static const std::map<std::string, Keyword> table = {
      {"$schema", note},
      {"$defs", note},
      {"title", note},
      {"description", note},
      {"default", note},
      {"$ref", resolve},
      {"type", [](const Context& at, const Json& rule) { return has_type(at.value, rule.get<std::string>()); }},
      {"const", [](const Context& at, const Json& rule) { return at.value == rule; }},
      {"enum", [](const Context& at,
                  const Json& rule) { return std::find(rule.begin(), rule.end(), at.value) != rule.end(); }},
      {"properties", check_properties},
      {"additionalProperties", check_additional},
      {"required", check_required},
      {"items", check_items},
      {"pattern",
       [](const Context& at, const Json& rule) {
         return !at.value.is_string() || std::regex_search(at.value.get<std::string>(), std::regex(rule.get<std::string>()));
       }},
      {"minItems",
       [](const Context& at, const Json& rule) { return !at.value.is_array() || at.value.size() >= rule; }},
      {"maxItems",
       [](const Context& at, const Json& rule) { return !at.value.is_array() || at.value.size() <= rule; }},
      {"minimum", limit(std::greater_equal<double>())},
      {"maximum", limit(std::less_equal<double>())},
      {"exclusiveMinimum", limit(std::greater<double>())},
      {"exclusiveMaximum", limit(std::less<double>())},
      {"anyOf", [](const Context& at, const Json& rule) { return count_fitting(at, rule) > 0; }},
      {"oneOf", [](const Context& at, const Json& rule) { return count_fitting(at, rule) == 1; }},
      {"not", [](const Context& at, const Json& rule) { return !fits(at.value, rule, at.whole); }},
  };
  return table;
}

const std::string* broken_keyword(const Json& value, const Json& schema, const Json& whole) {
  for (auto item = schema.begin(); item != schema.end(); ++item) {
    const auto found = keywords().find(item.key());
    if (found == keywords().end()) throw std::runtime_error("unknown keyword " + item.key());
    if (!found->second({value, schema, whole}, item.value())) return &found->first;
  }
  return nullptr;
}

}  // namespace

std::string schema_problem(const Json& value, const Json& schema, const Json& whole) {
  const std::string* keyword = broken_keyword(value, schema, whole);
  if (!keyword) return "";
  return *keyword + " " + schema[*keyword].dump().substr(0, 80) + " does not hold for " + value.dump().substr(0, 80);
}

}  // namespace fathom::test
