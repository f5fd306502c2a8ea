// The functions of the language: one word for each row of the tables of nodes, materials, lights, backgrounds,
// patterns, cameras and formulas, and the few that the language has of its own.
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

// What a word before `(` can mean. It has several meanings when tables have it in common: `round` is of nodes and of
// numbers, which the first argument tells apart; `gradient` is a background and a pattern, which the place tells.
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

const Word* find_word(std::string_view text);      // nullptr when there is none
const std::vector<std::string_view>& all_words();  // sorted

// The properties of a node that are given without a name, in this order: its child, and what it cannot do without.
// Combinators take operands in their place.
const std::vector<std::string_view>& positional(const NodeSpec& node);

}  // namespace fathom::compiler::text
