#include "compiler/frontend/elaborate/name_order.h"

#include <fmt/format.h>

namespace fathom::compiler {
namespace {

void collect(const CheckedNode& node, std::optional<std::uint32_t> material, std::vector<Use>& out) {
  if (node.material) material = node.material;
  if (node.use) out.push_back({*node.use, material, node.span});
  for (const CheckedNode& child : node.children) collect(child, material, out);
}

struct Visit {
  std::uint32_t name;
  std::size_t next_use;
};

// Reports a cycle: the walk goes from `first` to the end of the stack, and the use `closing` leads back to `first`.
void report_cycle(const std::vector<Visit>& stack, std::size_t first, const Use& closing, const Names& names,
                  Diagnostics& diagnostics) {
  constexpr std::size_t kMaxNamed = 8;
  std::string path;
  for (std::size_t i = first; i < stack.size(); ++i) {
    if (i - first == kMaxNamed) {
      path += fmt::format("... ({} more) -> ", stack.size() - i);
      break;
    }
    path += fmt::format("{} -> ", names.name(stack[i].name));
  }
  path += names.name(closing.target);
  diagnostics.error("E0204", closing.span, fmt::format("a named node is part of itself: {}", path),
                    fmt::format("`{}` is used within itself", names.name(closing.target)),
                    {"a node may be used many times, but not within itself; break the circle at one of the uses"});
}

}  // namespace

std::vector<Use> uses_of(const CheckedNode& node) {
  std::vector<Use> out;
  collect(node, std::nullopt, out);
  return out;
}

std::vector<std::uint32_t> order_names(const std::vector<std::vector<Use>>& uses, const Names& names,
                                       Diagnostics& diagnostics) {
  enum class State : std::uint8_t { New, Open, Done };
  std::vector<State> states(uses.size(), State::New);
  std::vector<std::size_t> depths(uses.size(), 0);  // [open name] position in the stack
  std::vector<std::uint32_t> order;
  for (std::uint32_t start = 0; start < uses.size(); ++start) {
    if (states[start] != State::New) continue;
    // Explicit stack: names can use each other in a chain as long as the file.
    std::vector<Visit> stack = {{start, 0}};
    states[start] = State::Open;
    depths[start] = 0;
    while (!stack.empty()) {
      Visit& top = stack.back();
      if (top.next_use == uses[top.name].size()) {
        states[top.name] = State::Done;
        order.push_back(top.name);
        stack.pop_back();
        continue;
      }
      const Use& use = uses[top.name][top.next_use++];
      if (states[use.target] == State::Open) {
        report_cycle(stack, depths[use.target], use, names, diagnostics);
      } else if (states[use.target] == State::New) {
        states[use.target] = State::Open;
        depths[use.target] = stack.size();
        stack.push_back({use.target, 0});
      }
    }
  }
  return order;
}

}  // namespace fathom::compiler
