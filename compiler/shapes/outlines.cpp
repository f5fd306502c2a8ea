// Rows of the outlines: shapes in the xy plane, for extrude and revolve.
#include "compiler/shapes/rows.h"

namespace fathom::compiler {

std::vector<NodeSpec> outline_rows() { return {}; }

}  // namespace fathom::compiler
