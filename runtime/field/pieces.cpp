#include "runtime/field/pieces.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <tuple>
#include <utility>

namespace fathom::runtime {
namespace {

// Pieces of one template have float errors within a factor of two, because the largest holds for all.
int magnitude_of(double cancellation) { return std::ilogb(std::max(cancellation, 0.125)); }

// Maximum number of templates: each has a stream of 80 kB in every thread.
constexpr std::size_t kMostTemplates = 512;

// True if lanes can hold the constants of pieces of this field: its program is run as it is.
bool runs_program(const Field& field) { return !field.cells && !field.regions && !field.far_levels.used(); }

// Returns a letter for each form.
std::string shapes_of(const compiler::CompiledPiece& piece) {
  std::string shapes;
  for (const compiler::ClosedForm& form : piece.forms)
    shapes += static_cast<char>((form.cut ? 'A' : 'a') + static_cast<int>(form.shape));
  return shapes;
}

}  // namespace

void PieceTemplate::evaluate(vm::Points points, std::size_t count, const float* constants, float* out,
                             RegionScratch& scratch, vm::Workspace& workspace) const {
  if (!per_lane) return field.evaluate(points, count, out, scratch, workspace);
  if (native) return native->evaluate_rows(points, count, constants, out);
  vm::evaluate_rows(code, points, count, constants, out, workspace);
}

void add_pieces(Field& field, const compiler::SplitField& split, double extent, std::optional<double> far,
                bool native, const RegionOptions* regions, RegionStore* store) {
  if (split.pieces.size() < 2) return;
  constexpr double kEvaluations = 1e7;  // enough for machine code to repay
  auto pieces = std::make_shared<Pieces>();
  using Key = std::tuple<std::vector<std::uint32_t>, std::vector<double>, std::string, double, int, bool>;
  std::map<Key, std::uint32_t> known;
  std::vector<compiler::Box> boxes;
  RegionOptions left = regions ? *regions : RegionOptions{};
  for (const compiler::CompiledPiece& piece : split.pieces) {
    Field own = make_field(piece, extent, far);
    own.convex = false;  // the radius of convexity is for unions
    if (regions && own.far_levels.used()) {
      add_regions(own, piece, left, store);
      if (own.regions) left.memory -= std::min(left.memory, own.regions->summary().bytes);
    }
    boxes.push_back(own.bound);
    pieces->first_form.push_back(static_cast<std::uint32_t>(pieces->forms.size()));
    pieces->forms.insert(pieces->forms.end(), piece.forms.begin(), piece.forms.end());
    vm::ProgramTemplate code = vm::template_of(piece.distance);
    const bool alike = runs_program(own);
    const Key key{code.words,  code.doubles, shapes_of(piece), own.lipschitz, magnitude_of(piece.cancellation),
                  piece.convex};
    const auto next = static_cast<std::uint32_t>(pieces->templates.size());
    const auto [found, is_new] = alike ? known.try_emplace(key, next) : std::pair(known.end(), true);
    if (is_new) {
      PieceTemplate shared{own, piece.convex, alike, false, std::move(code), nullptr};
      shared.field.bound = compiler::Box::everything();
      pieces->templates.push_back(std::move(shared));
      pieces->template_of.push_back(next);
    } else {
      PieceTemplate& shared = pieces->templates[found->second];
      shared.per_lane = true;
      shared.field.cancellation = std::max(shared.field.cancellation, own.cancellation);
      pieces->template_of.push_back(found->second);
    }
    pieces->fields.push_back(std::move(own));
  }
  if (pieces->templates.size() > kMostTemplates) return;
  pieces->first_form.push_back(static_cast<std::uint32_t>(pieces->forms.size()));
  pieces->boxes = PieceBoxes(boxes);
  pieces->rows.resize(split.pieces.size());
  for (std::size_t i = 0; i < split.pieces.size(); ++i) {
    if (pieces->templates[pieces->template_of[i]].per_lane)
      pieces->rows[i] = vm::constants_of(split.pieces[i].distance);
  }
  for (PieceTemplate& shared : pieces->templates) {
    if (!native) continue;
    if (shared.per_lane) {
      shared.native = vm::NativeProgram::compile_rows(shared.code);
    } else {
      add_native_code(shared.field, kEvaluations);
    }
  }
  // Each piece's own code of its surface repays if rays hit it often.
  constexpr std::size_t kMostWithCode = 128;
  for (Field& own : pieces->fields) {
    if (native && pieces->fields.size() <= kMostWithCode)
      own.native.surface = vm::NativeProgram::compile(*own.surface, vm::RecordedResults::Surface);
  }
  field.pieces = std::move(pieces);
}

std::optional<PlaceInSolid> find_solid(const Field& field, glm::dvec3 place, RealScratch& scratch) {
  std::uint64_t instructions = 0;
  PlaceInSolid found{0, std::nullopt};
  if (!field.pieces) {
    if (field.bound.contains(place)) found.value = field.evaluate(place, scratch, instructions);
  } else {
    PieceBoxes::Visit visit;
    field.pieces->boxes.begin(place, {1, 0, 0}, 0, visit);
    for (BoxedPiece box; field.pieces->boxes.next(visit, 0, box);) {
      const auto piece = static_cast<std::uint32_t>(box.piece);
      const double value = field.pieces->fields[piece].evaluate(place, scratch, instructions);
      if (value < found.value) found = {value, piece};
    }
  }
  return found.value < 0 ? std::optional(found) : std::nullopt;
}

}  // namespace fathom::runtime
