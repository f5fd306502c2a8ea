// Families of records that one property distinguishes: cameras and materials by `type`, patterns by `pattern`.
// Tested by: tests/golden/diagnostics (E0101, E0103, E0108)
#pragma once

#include <string_view>
#include <vector>

#include "compiler/frontend/records/records.h"
#include "compiler/frontend/syntax/syntax.h"
#include "compiler/source/diagnostics.h"

namespace fathom::compiler {

// Returns the row of the family that the record's property `key` names, or the first row if the key is absent and
// optional. Returns nullptr after reporting an unknown or missing key. `what` names the family in messages. `place`
// is the span for a missing key.
const RecordSpec* row_by_type(const std::vector<RecordSpec>& family, std::string_view what,
                              const syntax::Record& record, Span place, Diagnostics& diagnostics,
                              std::string_view key = "type");

// Reports pairs of properties that exclude each other.
void check_exclusions(const RecordSpec& row, const syntax::Record& record, Diagnostics& diagnostics);

// Returns the record of a named material or light, or nullptr after reporting that the value is not a record. `what`
// names the kind in messages.
const syntax::Record* record_of(const syntax::Property& named, std::string_view what, std::string_view example,
                                Diagnostics& diagnostics);

}  // namespace fathom::compiler
