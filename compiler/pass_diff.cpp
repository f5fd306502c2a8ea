#include "compiler/pass_diff.h"

#include <fmt/format.h>

#include "compiler/shapes/print_graph.h"
#include "compiler/source/line_diff.h"

namespace fathom::compiler {
namespace {

std::string heading(std::string_view pass, const std::optional<GraphSize>& before,
                    const std::optional<GraphSize>& after) {
  if (!before || !after) return fmt::format("; pass {}: too large for the machine before or after it\n", pass);
  return fmt::format("; pass {}: {} -> {} nodes, {} -> {} ops, cost {} -> {}\n", pass, before->nodes, after->nodes,
                     before->instructions, after->instructions, before->cost, after->cost);
}

}  // namespace

void PassDiff::add(std::string_view pass, const Scene& scene) {
  std::string graph = print_graph(scene, source_, NodeNames::Places);
  if (graph == last_graph_) return;
  const std::optional<GraphSize> size = measure(scene, source_);
  if (!last_pass_.empty()) {
    text_ += fmt::format("{}--- {}\n+++ {}\n{}", heading(pass, last_size_, size), last_pass_, pass,
                         unified_diff(last_graph_, graph));
  }
  last_pass_ = pass;
  last_graph_ = std::move(graph);
  last_size_ = size;
}

void PassDiff::add_fused(const vm::VerifiedProgram& program) {
  if (!last_size_ || program.instructions() == last_size_->instructions) return;
  const GraphSize size{last_size_->nodes, program.instructions(), program.cost()};
  text_ += heading("fuse", last_size_, size);
}

std::string PassDiff::text() const { return text_.empty() ? "; no pass changed anything\n" : text_; }

}  // namespace fathom::compiler
