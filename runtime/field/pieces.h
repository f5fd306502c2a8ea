// The scene's pieces as rays meet them: the field of each, its box, and the templates that pieces share.
// Tested by: tests/runtime/march/piece_marcher_test.cpp
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "compiler/geometry/box.h"
#include "compiler/scene/compiled_scene.h"
#include "runtime/field/field.h"
#include "runtime/field/piece_boxes.h"
#include "vm/native/native_program.h"
#include "vm/prune/program_template.h"

namespace fathom::runtime {

// Pieces whose programs differ in nothing but constants, and whose float errors are alike, are evaluated side by
// side.
struct PieceTemplate {
  Field field;        // what its pieces share; `bound` is everything, `cancellation` the largest
  bool convex;        // its pieces' distances are convex functions
  bool runs_program;  // its value is its program's: without regions, cells and far levels
  bool per_lane;      // lanes hold the constants of their pieces; false if the template has a single piece
  vm::ProgramTemplate code;
  std::shared_ptr<const vm::NativeProgram> native;  // of `code`; null: the interpreter evaluates, with the same bits

  // Computes distances as vm::evaluate_rows() does. `constants` are not read unless per_lane.
  void evaluate(vm::Points points, std::size_t count, const float* constants, float* out, RegionScratch& scratch,
                vm::Workspace& workspace) const;
};

struct Pieces {
  std::vector<Field> fields;                // [piece]
  PieceBoxes boxes;                         // around the surfaces, with the margin of Field::bound
  std::vector<std::uint32_t> template_of;   // [piece] index into templates
  std::vector<compiler::ClosedForm> forms;  // of all pieces
  std::vector<std::uint32_t> first_form;    // [piece] index into forms, and the end after the last piece
  std::vector<std::vector<float>> rows;     // [piece] constants of its template; empty unless per_lane
  std::vector<PieceTemplate> templates;

  // Returns the forms of a piece, those of one template alike in number and shape.
  std::span<const compiler::ClosedForm> forms_of(std::size_t piece) const {
    return std::span(forms).subspan(first_form[piece], first_form[piece + 1] - first_form[piece]);
  }
};

// Gives the pieces of `split` to its field: rays then meet the pieces, not the whole. A field of one piece, or of
// hundreds of templates, stays whole. `extent` and `far` as make_field() takes them. `native`: with machine code.
// `regions`: of pieces that gain by them, which share the memory, or null.
void add_pieces(Field& field, const compiler::SplitField& split, double extent, std::optional<double> far,
                bool native, const RegionOptions* regions = nullptr, RegionStore* store = nullptr);

// A place in the solids of a field.
struct PlaceInSolid {
  double value;                        // of the field: below 0
  std::optional<std::uint32_t> piece;  // the deepest there; nothing in a field without pieces
};
// Returns nothing if the field is not below 0 there.
std::optional<PlaceInSolid> find_solid(const Field& field, glm::dvec3 place, RealScratch& scratch);

}  // namespace fathom::runtime
