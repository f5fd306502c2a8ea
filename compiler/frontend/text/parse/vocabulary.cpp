#include "compiler/frontend/text/parse/vocabulary.h"

#include <algorithm>
#include <deque>
#include <unordered_map>

#include "compiler/frontend/formula/formula_nodes.h"
#include "compiler/shapes/node_table.h"

namespace fathom::compiler::text {
namespace {

struct Named {
  std::string_view text;
  Placement placement;
  Builtin builtin;
};
constexpr Named kOwnWords[] = {
    {"scale", Placement::Scale, Builtin::None},
    {"rotate", Placement::Rotate, Builtin::None},
    {"translate", Placement::Translate, Builtin::None},
    {"material", Placement::Material, Builtin::None},
    {"name", Placement::Name, Builtin::None},
    {"len", Placement::None, Builtin::Len},
    {"dot", Placement::None, Builtin::Dot},
    {"normalize", Placement::None, Builtin::Normalize},
    {"random", Placement::None, Builtin::Random},
    {"require", Placement::None, Builtin::Require},
    {"show", Placement::None, Builtin::Show},
};

class Vocabulary {
 public:
  Vocabulary() : functions_(formula_functions(machine_functions())) {
    for (const NodeSpec& row : node_table()) {
      if (row.category != Category::Internal && row.category != Category::Function) at(row.name).node = &row;
    }
    for (const FormulaFunction& row : functions_) at(row.name).formula = &row;
    for (const Named& row : kOwnWords) at(row.text).placement = row.placement, at(row.text).builtin = row.builtin;
    for (const RecordSpec& row : material_records()) at(row.type).material = &row;
    for (const RecordSpec& row : light_records()) at(row.type).light = &row;
    for (const RecordSpec& row : background_records()) at(row.type).background = &row;
    for (const RecordSpec& row : pattern_records()) at(row.type).pattern = &row;
    for (const RecordSpec& row : camera_records()) at(row.type).camera = &row;
    for (const Word& word : words_) names_.push_back(word.text);
    std::sort(names_.begin(), names_.end());
  }

  const Word* find(std::string_view text) const {
    const auto found = numbers_.find(text);
    return found == numbers_.end() ? nullptr : &words_[found->second];
  }
  const std::vector<std::string_view>& names() const { return names_; }

 private:
  Word& at(std::string_view text) {
    const auto [found, is_new] = numbers_.emplace(text, words_.size());
    if (is_new) words_.push_back({text});
    return words_[found->second];
  }

  std::vector<FormulaFunction> functions_;
  std::deque<Word> words_;
  std::unordered_map<std::string_view, std::size_t> numbers_;
  std::vector<std::string_view> names_;
};

const Vocabulary& vocabulary() {
  static const Vocabulary made;
  return made;
}

}  // namespace

const Word* find_word(std::string_view text) { return vocabulary().find(text); }
const std::vector<std::string_view>& all_words() { return vocabulary().names(); }

const std::vector<std::string_view>& positional(const NodeSpec& node) {
  static const std::vector<std::vector<std::string_view>> all = [] {
    std::vector<std::vector<std::string_view>> made(kKindCount);
    for (const NodeSpec& row : node_table()) {
      std::vector<std::string_view>& names = made[static_cast<std::size_t>(row.kind)];
      if (row.category == Category::Internal || row.category == Category::Function) continue;
      if (row.category == Category::Alteration && node_record(row.kind).find("of")) names.push_back("of");
      for (const ParamSpec& param : row.params) {
        if (!param.fallback) names.push_back(param.name);
      }
    }
    return made;
  }();
  return all[static_cast<std::size_t>(node.kind)];
}

}  // namespace fathom::compiler::text
