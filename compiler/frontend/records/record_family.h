// Records that are told apart by a property: cameras and materials by `type`, patterns by `pattern`.
// Tested by: tests/golden/diagnostics (E0101, E0103, E0108)
#pragma once

#include <string_view>
#include <vector>

#include "compiler/frontend/records/records.h"
#include "compiler/frontend/syntax/syntax.h"
#include "compiler/source/diagnostics.h"

namespace fathom::compiler {

// The row of the family that the record's property `key` names; the first when the key is absent and need not be
// given. nullptr after reporting that there is none. `what` is a member of the family in messages; `place` is where a
// missing key is reported.
const RecordSpec* row_by_type(const std::vector<RecordSpec>& family, std::string_view what,
                              const syntax::Record& record, Span place, Diagnostics& diagnostics,
                              std::string_view key = "type");

// Reports properties of which at most one may be given.
void check_exclusions(const RecordSpec& row, const syntax::Record& record, Diagnostics& diagnostics);

// The record of a named material or light, as `what` says; nullptr after reporting that it is none.
const syntax::Record* record_of(const syntax::Property& named, std::string_view what, std::string_view example,
                                Diagnostics& diagnostics);

}  // namespace fathom::compiler
