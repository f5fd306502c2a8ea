// Checker for nodes as written. Resolves the names in them.
// Tested by: tests/golden/diagnostics (E01xx, E02xx, E03xx), tests/compiler/frontend/elaborate/elaborate_test.cpp
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "compiler/frontend/elaborate/checked_node.h"
#include "compiler/frontend/records/record_reader.h"
#include "compiler/frontend/syntax/scope.h"
#include "compiler/frontend/syntax/syntax.h"
#include "compiler/source/diagnostics.h"

namespace fathom::compiler {

// Names that one kind of definition (materials or nodes) has in a scene file, numbered in file order, and which of
// them are used.
class Names {
 public:
  void add(const syntax::Property& property);
  std::size_t size() const { return spans_.size(); }
  std::string_view name(std::uint32_t number) const { return names_[number]; }
  Span span(std::uint32_t number) const { return spans_[number]; }
  bool used(std::uint32_t number) const { return used_[number]; }

  // Returns the number of `name` and marks the name as used. Returns nullopt after reporting `what` as unknown.
  std::optional<std::uint32_t> resolve(std::string_view name, std::string_view what, const char* code, Span span,
                                       Diagnostics& diagnostics);

 private:
  std::vector<std::string_view> names_;  // point into the syntax tree
  std::vector<Span> spans_;
  std::vector<bool> used_;
  std::unordered_map<std::string_view, std::uint32_t> numbers_;
};

class NodeChecker {
 public:
  NodeChecker(Names& materials, Names& nodes, const Scope& scope, Diagnostics& diagnostics)
      : materials_(materials), nodes_(nodes), scope_(scope), diagnostics_(diagnostics) {}

  // Returns the node, which is valid for building unless the checker reported an error.
  CheckedNode check(const syntax::Value& value);

  // Returns the nodes of a list. `whose` names the list in the error message for an empty list.
  std::vector<CheckedNode> check_list(const syntax::Value& value, std::string_view whose);

 private:
  // Node still to be checked, and the place for its result.
  struct Pending {
    const syntax::Value* value;
    CheckedNode* node;
  };

  void check_pending();
  void check_node(const syntax::Value& value, CheckedNode& node);
  void add_list(const syntax::Value& value, std::string_view whose, std::vector<CheckedNode>& nodes);
  void add_one(const syntax::Value& value, std::vector<CheckedNode>& nodes);
  void check_use(const syntax::Record& record, const syntax::Property& use, CheckedNode& node);
  void check_type(const syntax::Record& record, const syntax::Property& type, CheckedNode& node);
  void check_between(const RecordReader& reader, const syntax::Record& record, const NodeSpec& row,
                     CheckedNode& node);
  void check_children(const syntax::Value& of, const NodeSpec& row, CheckedNode& node);
  void check_common(const RecordReader& reader, CheckedNode& node);
  void report_unknown_type(const syntax::Record& record, const syntax::Property& type, std::string_view name,
                           CheckedNode& node);

  Names& materials_;
  Names& nodes_;
  const Scope& scope_;
  Diagnostics& diagnostics_;
  std::vector<Pending> pending_;  // in place of recursion, because nodes may be nested thousands deep
};

}  // namespace fathom::compiler
