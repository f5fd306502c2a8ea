#include "compiler/frontend/elaborate/check_node.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <glm/geometric.hpp>

#include "compiler/frontend/elaborate/placement.h"
#include "compiler/frontend/formula/formula_nodes.h"
#include "compiler/frontend/formula/read_formula.h"
#include "compiler/frontend/records/record_reader.h"
#include "compiler/frontend/syntax/suggest.h"
#include "compiler/shapes/node_table.h"

namespace fathom::compiler {
namespace {

const std::string* text_of(const syntax::Value* value) {
  return value ? std::get_if<std::string>(&value->data) : nullptr;
}

std::vector<std::string_view> node_types() {
  std::vector<std::string_view> names;
  for (const NodeSpec& row : node_table()) {
    if (row.category != Category::Internal && row.category != Category::Function) names.push_back(row.name);
  }
  return names;
}

}  // namespace

void Names::add(const syntax::Property& property) {
  numbers_.emplace(property.name, static_cast<std::uint32_t>(names_.size()));
  names_.push_back(property.name);
  spans_.push_back(property.name_span);
  used_.push_back(false);
}

std::optional<std::uint32_t> Names::resolve(std::string_view name, std::string_view what, const char* code, Span span,
                                            Diagnostics& diagnostics) {
  const auto found = numbers_.find(name);
  if (found != numbers_.end()) {
    used_[found->second] = true;
    return found->second;
  }
  std::string help = did_you_mean(name, names_);
  if (help.empty())
    help = diagnostics.spelled(fmt::format("the scene has no `{0}`; add \"{0}\": {{\"{1}\": {{...}}}}",
                                           code == std::string_view("E0202") ? "materials" : "nodes", name),
                               "such as .material(diffuse(color = 0.5)), or that by a name of `let`");
  diagnostics.error(code, span, fmt::format("unknown {} `{}`", what, name), "", {std::move(help)});
  return std::nullopt;
}

CheckedNode NodeChecker::check(const syntax::Value& value) {
  CheckedNode node;
  pending_.push_back({&value, &node});
  check_pending();
  return node;
}

std::vector<CheckedNode> NodeChecker::check_list(const syntax::Value& value, std::string_view whose) {
  std::vector<CheckedNode> nodes;
  add_list(value, whose, nodes);
  check_pending();
  return nodes;
}

void NodeChecker::check_pending() {
  while (!pending_.empty() && !diagnostics_.full()) {
    const Pending next = pending_.back();
    pending_.pop_back();
    check_node(*next.value, *next.node);
  }
}

void NodeChecker::check_node(const syntax::Value& value, CheckedNode& node) {
  node.span = value.span;
  const auto* record = std::get_if<syntax::Record>(&value.data);
  if (record == nullptr) {
    std::vector<std::string> help = {"such as {\"type\": \"sphere\", \"radius\": 1}"};
    if (const std::string* name = text_of(&value)) {
      const bool type = find_node(*name) != nullptr;
      help = {type ? fmt::format("write {{\"type\": \"{}\", ...}}", *name)
                   : fmt::format("write {{\"use\": \"{}\"}} to refer to a named node", *name)};
    }
    diagnostics_.error("E0101", value.span, fmt::format("a node must be an object {{...}}, not {}", describe(value)),
                       "", std::move(help));
    return;
  }
  const syntax::Property* type = record->find("type");
  const syntax::Property* use = record->find("use");
  if (type && use) {
    diagnostics_.error("E0106", use->name_span, "a node has either `type` or `use`, not both", "",
                       {"keep `use` to place a named node, or `type` to make a new one"});
    return;
  }
  if (type) {
    check_type(*record, *type, node);
  } else if (use) {
    check_use(*record, *use, node);
  } else {
    std::string help = "such as {\"type\": \"sphere\", \"radius\": 1} or {\"use\": \"a name from `nodes`\"}";
    for (const syntax::Property& property : record->properties) {
      const std::string_view meant = suggest(property.name, {"type", "use"});
      if (!meant.empty()) help = fmt::format("write \"{}\" in place of \"{}\"", meant, property.name);
    }
    diagnostics_.error("E0103", opening(value.span), "a node needs a `type` or a `use`", "", {help});
  }
}

void NodeChecker::add_list(const syntax::Value& value, std::string_view whose, std::vector<CheckedNode>& nodes) {
  const auto& list = std::get<syntax::List>(value.data);
  if (list.empty()) {
    diagnostics_.error("E0107", value.span, fmt::format("{} is empty", whose), "needs at least one node",
                       {"such as [{\"type\": \"sphere\", \"radius\": 1}]"});
  }
  // Check an item that is not a record immediately, because it needs no CheckedNode. A list may have a million of
  // them.
  const auto is_record = [](const syntax::Value& item) { return std::holds_alternative<syntax::Record>(item.data); };
  nodes.resize(static_cast<std::size_t>(std::count_if(list.begin(), list.end(), is_record)));
  CheckedNode none;
  std::size_t next = 0;
  const std::ptrdiff_t before = std::ssize(pending_);
  for (const syntax::Value& item : list) {
    if (is_record(item)) {
      pending_.push_back({&item, &nodes[next++]});
    } else if (!diagnostics_.full()) {
      check_node(item, none);
    }
  }
  // The first item is checked first, because the number of errors is limited.
  std::reverse(pending_.begin() + before, pending_.end());
}

void NodeChecker::add_one(const syntax::Value& value, std::vector<CheckedNode>& nodes) {
  nodes.resize(1);
  pending_.push_back({&value, &nodes[0]});
}

void NodeChecker::check_use(const syntax::Record& record, const syntax::Property& use, CheckedNode& node) {
  const RecordReader reader(use_record(), record, use.name_span, scope_, diagnostics_, "E0301");
  if (const std::string* name = text_of(reader.value("use"))) {
    node.word = *name;
    node.use = nodes_.resolve(*name, "named node", "E0203", use.value->span, diagnostics_);
  }
  check_common(reader, node);
}

void NodeChecker::check_type(const syntax::Record& record, const syntax::Property& type, CheckedNode& node) {
  const std::string* name = text_of(type.value.get());
  const NodeSpec* row = name ? find_node(*name) : nullptr;
  if (name == nullptr) {
    diagnostics_.error("E0101", type.value->span,
                       fmt::format("`type` must be a string, not {}", describe(*type.value)), "",
                       {fmt::format("known: {}", fmt::join(node_types(), ", "))});
    return;
  }
  if (row == nullptr) return report_unknown_type(record, type, *name, node);
  node.word = *name;
  node.kind = row->kind;
  node.type_span = type.value->span;
  const RecordReader reader(node_record(row->kind), record, type.value->span, scope_, diagnostics_, "E0301");
  for (const ParamSpec& param : row->params) {
    if (param.type == ParamType::Formula) {
      const syntax::Value* formula = reader.value(param.name);
      if (formula) node.formula = read_formula(*formula, scope_, machine_functions(), diagnostics_);
      continue;
    }
    const std::vector<double> numbers = reader.numbers(param.name);
    node.params.insert(node.params.end(), numbers.begin(), numbers.end());
  }
  if (row->between) check_between(reader, record, *row, node);
  if (const syntax::Value* of = reader.value("of")) check_children(*of, *row, node);
  check_common(reader, node);
  if (!reader.good() || row->check == nullptr) return;
  if (const std::optional<std::string> problem = row->check(node.params)) {
    diagnostics_.error("E0302", type.value->span, *problem, "", {fmt::format("`{}`: {}", row->name, row->doc)});
  }
}

// Reads the two end points given instead of a length. The ends determine the length and the placement of the node.
void NodeChecker::check_between(const RecordReader& reader, const syntax::Record& record, const NodeSpec& row,
                                CheckedNode& node) {
  const Between& between = *row.between;
  const std::string ends = fmt::format("give `{}`, or both ends `a` and `b`", between.length);
  const syntax::Property *a = record.find("a"), *b = record.find("b"), *length = record.find(between.length);
  if (!a && !b && !length) {
    diagnostics_.error("E0103", node.type_span, fmt::format("`{}` has no `{}`", row.name, between.length), "",
                       {ends});
  } else if ((a || b) && length) {
    diagnostics_.error("E0106", length->name_span, fmt::format("both `{}` and ends are given", between.length),
                       "the ends say how long it is", {ends});
  } else if ((a != nullptr) != (b != nullptr)) {
    diagnostics_.error("E0103", (a ? a : b)->name_span, fmt::format("`{}` has one end", row.name), "", {ends});
  }
  if (!reader.value("a") || !reader.value("b")) return;
  const glm::dvec3 from = reader.vec3("a"), to = reader.vec3("b");
  if (from == to) {
    diagnostics_.error("E0302", b->value->span, "the ends `a` and `b` are the same point", "", {ends});
    return;
  }
  std::size_t at = 0;
  for (const ParamSpec& param : row.params) {
    if (param.name == between.length) break;
    at += static_cast<std::size_t>(width(param.type));
  }
  node.params[at] = between.share * glm::length(to - from);
  node.between = placed_between(from, to, between.share);
}

void NodeChecker::check_children(const syntax::Value& of, const NodeSpec& row, CheckedNode& node) {
  if (row.category == Category::Combinator) {
    add_list(of, fmt::format("`of` of `{}`", row.name), node.children);
  } else {
    add_one(of, node.children);
  }
}

void NodeChecker::check_common(const RecordReader& reader, CheckedNode& node) {
  if (const std::string* name = text_of(reader.value("name"))) node.name = *name;
  if (const syntax::Value* material = reader.value("material")) {
    node.material = materials_.resolve(*text_of(material), "material", "E0202", material->span, diagnostics_);
  }
  node.transform = read_placement(reader, scope_, diagnostics_);
  if (const syntax::Value* translate = reader.value("translate")) {
    if (std::get<syntax::List>(translate->data).size() == 2) node.flat_translate = translate->span;
  }
}

void NodeChecker::report_unknown_type(const syntax::Record& record, const syntax::Property& type,
                                      std::string_view name, CheckedNode& node) {
  diagnostics_.error("E0201", type.value->span, fmt::format("unknown type of node `{}`", name), "",
                     {did_you_mean(name, node_types())});
  // The children and the material can still be checked.
  if (const syntax::Property* of = record.find("of")) {
    if (std::holds_alternative<syntax::List>(of->value->data)) add_list(*of->value, "`of`", node.children);
    if (std::holds_alternative<syntax::Record>(of->value->data)) add_one(*of->value, node.children);
  }
  const syntax::Property* material = record.find("material");
  if (const std::string* wanted = material ? text_of(material->value.get()) : nullptr) {
    materials_.resolve(*wanted, "material", "E0202", material->value->span, diagnostics_);
  }
}

}  // namespace fathom::compiler
