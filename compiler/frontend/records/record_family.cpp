#include "compiler/frontend/records/record_family.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string>

#include "compiler/frontend/records/record_reader.h"
#include "compiler/frontend/syntax/suggest.h"

namespace fathom::compiler {

const RecordSpec* row_by_type(const std::vector<RecordSpec>& family, std::string_view what,
                              const syntax::Record& record, Span place, Diagnostics& diagnostics,
                              std::string_view key) {
  const syntax::Property* type = record.find(key);
  const PropertySpec& row = *family[0].find(key);
  std::vector<std::string_view> known(row.choices);
  if (type == nullptr) {
    if (!row.required) return &family[0];
    std::vector<std::string> help = {fmt::format("known: {}", fmt::join(known, ", "))};
    for (const RecordSpec& member : family) {
      if (!record.find("preset") || !member.find("preset")) continue;
      help.push_back(fmt::format("presets are of `{0}`: add \"{1}\": \"{0}\"", member.type, key));
    }
    diagnostics.error("E0103", place, fmt::format("the {} has no `{}`", what, key), "", std::move(help));
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

void check_exclusions(const RecordSpec& row, const syntax::Record& record, Diagnostics& diagnostics) {
  for (const PropertySpec& property : row.properties) {
    for (const std::string_view other : property.instead_of) {
      if (!record.find(other) || !record.find(property.name)) continue;
      diagnostics.error(
          "E0106", record.find(property.name)->name_span,
          fmt::format("both `{}` and `{}` are given", other, property.name), "one follows from the other",
          {fmt::format("keep `{}` ({}) or `{}` ({})", other, row.find(other)->doc, property.name, property.doc)});
    }
  }
}

const syntax::Record* record_of(const syntax::Property& named, std::string_view what, std::string_view example,
                                Diagnostics& diagnostics) {
  const auto* record = std::get_if<syntax::Record>(&named.value->data);
  if (record == nullptr) {
    diagnostics.error(
        "E0101", named.value->span,
        fmt::format("{} `{}` must be an object {{...}}, not {}", what, named.name, describe(*named.value)), "",
        {fmt::format("such as {}", example)});
  }
  return record;
}

}  // namespace fathom::compiler
