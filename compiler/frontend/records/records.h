// The tables of properties: what each record of a scene file may hold. Checking, "did you mean" and the
// defaults read them; the parameters of nodes come from compiler/shapes/node_table.h.
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

// One row for each value of `type`; the first is used when `type` is absent and not required.
const std::vector<RecordSpec>& camera_records();
const std::vector<RecordSpec>& light_records();  // light_records.cpp
const std::vector<RecordSpec>& background_records();
const std::vector<RecordSpec>& material_records();  // material_records.cpp
const std::vector<RecordSpec>& pattern_records();   // told apart by `pattern`

const RecordSpec& node_record(Kind kind);  // its parameters and what every node may have
const RecordSpec& use_record();            // {"use": "name"} and what every node may have

}  // namespace fathom::compiler
