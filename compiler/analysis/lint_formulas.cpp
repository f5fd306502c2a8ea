#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "compiler/analysis/lints.h"
#include "compiler/analysis/report.h"
#include "compiler/derive/formula_field.h"

namespace fathom::compiler {

void warn_of_unbounded_formulas(const Scene& scene, Diagnostics& diagnostics) {
  bool any = false;
  for (NodeId id = 0; id <= scene.root; ++id) {
    any = any || (scene.graph.kind(id) == Kind::Bounded && !holds_everywhere(proof_of(scene.graph, id)));
  }
  if (!any) return;
  const FieldGraph field(scene);
  if (field.in_cells()) return;
  const Graph& graph = field.graph();
  std::set<std::uint32_t> warned;
  for (NodeId id = 0; id <= field.root(); ++id) {
    if (!field.reached(id) || graph.kind(id) != Kind::Bounded || !field.estimates(id)) continue;
    const Span span = graph.origin(id).span;
    if (!warned.insert(span.begin).second) continue;
    const bool searched = warned.size() <= Report::kMaxSearched;
    diagnostics.warning(
        "W0509", searched ? field.unbounded_operation(id).value_or(span) : span,
        fmt::format("no bound on how fast this {} changes: the picture may be wrong", field.place(id).type),
        fmt::format("{}steps trust {:.3g}, a guess from slopes that were seen",
                    searched ? "the slope of this has none; " : "", field.known(id).lipschitz),
        {"rays can pass through what is steeper; avoid jumps (floor, step, sign, mod) all over the box and infinite "
         "slopes (sqrt or log at 0, tan), or keep them out of the box"});
  }
}

}  // namespace fathom::compiler
