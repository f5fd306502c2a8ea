#include "compiler/frontend/elaborate/check_sorts.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <string>

#include "compiler/frontend/elaborate/fold_nodes.h"
#include "compiler/shapes/node_table.h"

namespace fathom::compiler {
namespace {

Span word_span(const CheckedNode& node) { return node.use ? node.span : node.type_span; }

std::string known_outlines() {
  std::vector<std::string_view> names;
  for (const NodeSpec& row : node_table()) {
    if (row.category == Category::Primitive && row.sort == Sort::Outline) names.push_back(row.name);
  }
  return fmt::format("outlines are {}", fmt::join(names, ", "));
}

class SortChecker {
 public:
  SortChecker(std::size_t names, Diagnostics& diagnostics) : sorts_(names, Sort::Solid), diagnostics_(diagnostics) {}

  void check_named(std::uint32_t name, CheckedNode& node) { sorts_[name] = sort_of(node); }

  void check_object(CheckedNode& node) {
    if (sort_of(node) == Sort::Outline) report(node, Sort::Outline, help_for_outline());
  }

 private:
  Sort sort_of(CheckedNode& root) {
    const auto nothing = [](CheckedNode&, std::nullptr_t) { return nullptr; };
    return fold_nodes<Sort>(root, nullptr, nothing,
                            [this](CheckedNode& node, std::nullptr_t, std::span<const Sort> children) {
                              const Sort sort = node.use ? sorts_[*node.use] : sort_over(node, children);
                              if (sort == Sort::Outline && node.transform) flatten(node);
                              if (sort != Sort::Outline && node.flat_translate) report_flat_translate(node);
                              return sort;
                            });
  }

  Sort sort_over(const CheckedNode& node, std::span<const Sort> children) {
    const NodeSpec& row = spec(node.kind);
    std::optional<Sort> wanted = row.operand;
    for (std::size_t i = 0; i < children.size(); ++i) {
      const Sort sort = children[i];
      if (sort == Sort::Number) continue;
      if (!wanted) wanted = sort;  // the first child with a sort decides
      if (sort == *wanted) continue;
      if (!row.operand) {
        report(node.children[i], sort,
               fmt::format("the nodes of a `{}` are all solids or all outlines, as the first is", row.name));
      } else {
        report(node.children[i], sort, sort == Sort::Outline ? help_for_outline() : known_outlines());
      }
    }
    return row.operand ? row.sort : wanted.value_or(row.sort);
  }

  void report(const CheckedNode& node, Sort sort, std::string help) {
    const char* message = sort == Sort::Outline ? "`{}` is an outline in the xy plane; a solid is needed here"
                                                : "`{}` is a solid; an outline is needed here";
    diagnostics_.error("E0306", word_span(node), fmt::format(fmt::runtime(message), node.word), "",
                       {std::move(help)});
  }

  void report_flat_translate(const CheckedNode& node) {
    diagnostics_.error("E0306", *node.flat_translate,
                       fmt::format("`translate` must be three numbers [x, y, z]: `{}` is a solid", node.word), "",
                       {"only outlines are moved by two numbers [x, y]"});
  }

  std::string help_for_outline() const {
    return diagnostics_.spelled(
        "draw it out with {\"type\": \"extrude\", \"half_depth\": 0.1, \"of\": {...}}, or turn it about the y axis "
        "with {\"type\": \"revolve\", \"of\": {...}}",
        "draw it out with .extrude(0.1), or turn it about the y axis with .revolve()");
  }

  void flatten(CheckedNode& node) {
    auto& k = *node.transform;  // rows of the inverse: their lengths are the inverse scales
    const auto row = [&](std::size_t i) { return glm::dvec3(k[4 * i], k[4 * i + 1], k[4 * i + 2]); };
    const double x = 1 / glm::length(row(0)), y = 1 / glm::length(row(1)), z = 1 / glm::length(row(2));
    const auto same = [](double a, double b) { return std::abs(a - b) <= 1e-9 * b; };
    const auto complain = [&](std::string_view how, std::string_view help) {
      diagnostics_.error("E0307", word_span(node), fmt::format("the outline `{}` is {}", node.word, how), "",
                         {std::string(help)});
    };
    if (k[2] != 0 || k[6] != 0 || k[8] != 0 || k[9] != 0) {
      return complain("turned out of the xy plane",
                      "turn it about the z axis, or turn what extrude or revolve makes of it");
    }
    if (k[11] != 0) {
      return complain("moved out of the xy plane",
                      "give `translate` a third number of 0, or move what extrude or revolve makes of it");
    }
    if (same(x, z) && same(y, z)) return;
    if (!same(z, 1)) {
      return complain("scaled along z, where it has no end", "give `scale` one number, or a third number of 1");
    }
    if (k[12] == 1) k[12] = std::min(x, y);  // otherwise k[12] is the x or y scale already
    k[10] = 1 / k[12];
  }

  std::vector<Sort> sorts_;  // [named node]
  Diagnostics& diagnostics_;
};

}  // namespace

void check_sorts(std::vector<CheckedNode>& named, const std::vector<std::uint32_t>& order,
                 std::vector<CheckedNode>& objects, Diagnostics& diagnostics) {
  SortChecker checker(named.size(), diagnostics);
  for (const std::uint32_t name : order) checker.check_named(name, named[name]);
  for (CheckedNode& object : objects) checker.check_object(object);
}

}  // namespace fathom::compiler
