// Tables of properties that each record of a scene file may hold. The checks, the "did you mean" hints and the
// defaults use these tables. The parameters of nodes come from compiler/shapes/node_table.h.
// Tested by: tests/compiler/frontend/elaborate/elaborate_test.cpp
#pragma once

#include <vector>

#include "compiler/frontend/records/record_spec.h"
#include "compiler/graph/graph.h"

namespace fathom::compiler {

const RecordSpec& scene_record();
const RecordSpec& parameter_record();  // of `params`
const RecordSpec& film_record();
const RecordSpec& render_record();
const RecordSpec& rotation_record();  // of a node

// One row per value of `type`. The first row is the default if `type` is optional.
const std::vector<RecordSpec>& camera_records();
const std::vector<RecordSpec>& light_records();  // light_records.cpp
const std::vector<RecordSpec>& background_records();
const std::vector<RecordSpec>& material_records();  // material_records.cpp
const std::vector<RecordSpec>& pattern_records();   // distinguished by `pattern`

const RecordSpec& node_record(Kind kind);  // the node's parameters and the properties common to all nodes
const RecordSpec& use_record();            // {"use": "name"} and the properties common to all nodes

}  // namespace fathom::compiler
