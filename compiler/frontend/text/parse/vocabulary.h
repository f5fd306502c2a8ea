// Functions of the language: one word per row of the tables of nodes, materials, lights, backgrounds, patterns,
// cameras and formulas, and a few built-in functions.
// Tested by: tests/compiler/frontend/text/text_evaluate_test.cpp
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "compiler/frontend/formula/formula_functions.h"
#include "compiler/frontend/records/records.h"

namespace fathom::compiler::text {

enum class Builtin : std::uint8_t { None, Len, Dot, Normalize, Random, Require, Show };
enum class Placement : std::uint8_t { None, Scale, Rotate, Translate, Material, Name };

// Meanings of a word before `(`. A word that occurs in several tables has several meanings. `round` applies to nodes
// and to numbers, and the first argument decides. `gradient` is a background and a pattern, and the place of use
// decides.
struct Word {
  std::string_view text;
  const NodeSpec* node = nullptr;
  const FormulaFunction* formula = nullptr;
  Placement placement = Placement::None;
  Builtin builtin = Builtin::None;
  const RecordSpec* material = nullptr;
  const RecordSpec* light = nullptr;
  const RecordSpec* background = nullptr;
  const RecordSpec* pattern = nullptr;
  const RecordSpec* camera = nullptr;

  bool is_record() const { return material || light || background || pattern || camera; }
};

const Word* find_word(std::string_view text);      // nullptr if the word is unknown
const std::vector<std::string_view>& all_words();  // sorted

// Returns the properties that a node takes without a name, in order: its child, then its required properties.
// Combinators take operands instead.
const std::vector<std::string_view>& positional(const NodeSpec& node);

}  // namespace fathom::compiler::text
