#include "compiler/frontend/record_family.h"

#include <fmt/format.h>

#include <string>

#include "compiler/frontend/record_reader.h"
#include "compiler/frontend/suggest.h"

namespace fathom::compiler {

const RecordSpec* row_by_type(const std::vector<RecordSpec>& family, std::string_view what,
                              const syntax::Record& record, Span place, Diagnostics& diagnostics,
                              std::string_view key) {
  const syntax::Property* type = record.find(key);
  const PropertySpec& row = *family[0].find(key);
  std::vector<std::string_view> known(row.choices);
  if (type == nullptr) {
    if (!row.required) return &family[0];
    diagnostics.error("E0103", place, fmt::format("the {} has no `{}`", what, key), "",
                      {fmt::format("known: {}", fmt::join(known, ", "))});
    return nullptr;
  }
  const auto* name = std::get_if<std::string>(&type->value->data);
  if (name == nullptr) {
    diagnostics.error("E0101", type->value->span,
                      fmt::format("`{}` must be a string, not {}", key, describe(*type->value)), "",
                      {fmt::format("known: {}", fmt::join(known, ", "))});
    return nullptr;
  }
  for (const RecordSpec& member : family) {
    if (member.type == *name) return &member;
  }
  diagnostics.error("E0108", type->value->span, fmt::format("unknown type of {} `{}`", what, *name), "",
                    {did_you_mean(*name, known)});
  return nullptr;
}

}  // namespace fathom::compiler
