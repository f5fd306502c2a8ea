#include "compiler/frontend/text/parse/order.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

namespace fathom::compiler::text {
namespace {

// Depth-first topological sort without recursion, because chains of names may be as long as the file.
class Sorter {
 public:
  Sorter(const Tree& tree, const std::vector<std::vector<UseOf>>& uses, Diagnostics& diagnostics)
      : tree_(tree), uses_(uses), diagnostics_(diagnostics), states_(uses.size(), State::New) {}

  std::optional<std::vector<std::uint32_t>> run() {
    std::size_t needed = 0;
    for (std::uint32_t root = 0; root < uses_.size(); ++root) {
      if (states_[root] == State::New) visit(root);
      if (root + 1 == tree_.modules[0].end) needed = order_.size();
    }
    order_.resize(needed);
    return has_circle_ ? std::nullopt : std::optional(std::move(order_));
  }

 private:
  enum class State : std::uint8_t { New, Open, Done };
  struct Visit {
    std::uint32_t statement;
    std::size_t next;
  };

  void visit(std::uint32_t root) {
    std::vector<Visit> open;
    const auto begin = [&](std::uint32_t statement) {
      states_[statement] = State::Open;
      open.push_back({statement, 0});
    };
    begin(root);
    while (!open.empty()) {
      Visit& top = open.back();
      if (top.next == uses_[top.statement].size()) {
        states_[top.statement] = State::Done;
        order_.push_back(top.statement);
        open.pop_back();
        continue;
      }
      const UseOf use = uses_[top.statement][top.next++];
      if (states_[use.statement] == State::New) {
        begin(use.statement);
      } else if (states_[use.statement] == State::Open) {
        std::vector<std::uint32_t> circle;
        for (const Visit& visit : open) circle.push_back(visit.statement);
        circle.erase(circle.begin(), std::ranges::find(circle, use.statement));
        report(circle, use.span);
      }
    }
  }

  void report(const std::vector<std::uint32_t>& circle, Span span) {
    const Statement& first = tree_.statements[circle[0]];
    const bool by_import = std::ranges::any_of(
        circle, [&](std::uint32_t number) { return tree_.statements[number].kind == Statement::Kind::Import; });
    const bool known = std::exchange(has_circle_, true) && by_import;
    if (known || tree_.modules[first.module].again) return;
    std::string names;
    for (const std::uint32_t number : circle) names += fmt::format("`{}` uses ", tree_.statements[number].name);
    names += fmt::format("`{}`", first.name);
    diagnostics_.error("E0806", span,
                       fmt::format("`{}` {} itself", first.name,
                                   first.kind == Statement::Kind::Def ? "calls" : "is made of"),
                       names,
                       {by_import ? "what a file is given for its parameters cannot come from it"
                                  : "what is done again and again is a list, [for i in 0..10: ...], or a `fold`"});
  }

  const Tree& tree_;
  const std::vector<std::vector<UseOf>>& uses_;
  Diagnostics& diagnostics_;
  std::vector<State> states_;  // [statement]
  std::vector<std::uint32_t> order_;
  bool has_circle_ = false;
};

}  // namespace

std::optional<std::vector<std::uint32_t>> in_order(const Tree& tree, const std::vector<std::vector<UseOf>>& uses,
                                                   Diagnostics& diagnostics) {
  return Sorter(tree, uses, diagnostics).run();
}

}  // namespace fathom::compiler::text
