#include "compiler/frontend/records/record_spec.h"

namespace fathom::compiler {

const PropertySpec* RecordSpec::find(std::string_view property) const {
  for (const PropertySpec& row : properties) {
    if (row.name == property) return &row;
  }
  return nullptr;
}

}  // namespace fathom::compiler
