// Reader for material parameters that vary over space: formulas of x, y and z, and patterns that mix two values.
// Tested by: tests/compiler/frontend/elaborate/materials_test.cpp, tests/golden/diagnostics (E0109, E0108_pattern, E0402_material)
#pragma once

#include <optional>
#include <vector>

#include "compiler/frontend/records/record_reader.h"
#include "compiler/frontend/syntax/scope.h"
#include "compiler/frontend/syntax/syntax.h"
#include "compiler/graph/graph.h"
#include "compiler/scene/compiled_scene.h"
#include "compiler/source/diagnostics.h"

namespace fathom::compiler {

inline constexpr int kMaxPatternDepth = 16;  // maximum nesting depth of patterns

// Value of a parameter: a texture or a constant.
struct ReadTexture {
  glm::dvec3 typical;                       // the constant, or the value that stands in for the texture (material.h)
  std::optional<std::uint32_t> index = {};  // of the texture; nullopt for a constant
};

// Returns the property `space` of a material or pattern record, or `otherwise` if absent.
TextureSpace space_of(const RecordReader& reader, TextureSpace otherwise);

class TextureReader {
 public:
  TextureReader(const Scope& scope, Diagnostics& diagnostics) : scope_(scope), diagnostics_(diagnostics) {}

  // Reads a value for which varies() is true (compiler/frontend/records/written_numbers.h). `parameter` is the row of
  // its property. `space` is the material's space. A pattern may override it for itself and the values it mixes.
  // Returns nullopt after a report. A pattern that mixes two equal constants is read as that constant.
  std::optional<ReadTexture> read(const syntax::Value& value, const PropertySpec& parameter, TextureSpace space) {
    return read(value, parameter, Context{space, 1});
  }

  std::vector<Texture> textures;
  std::vector<Scene> formulas;  // number-valued fields; TextureFormula::programs holds indices into `formulas`

 private:
  struct Context {
    TextureSpace space;
    int depth;  // number of patterns, including the current one
  };
  std::optional<ReadTexture> read(const syntax::Value& value, const PropertySpec& parameter, Context context);
  std::optional<ReadTexture> read_pattern(const syntax::Value& value, const PropertySpec& parameter, Context context);
  std::optional<ReadTexture> read_end(const RecordReader& reader, const RecordSpec& row, const char* name,
                                      Context context);
  std::optional<ReadTexture> read_formulas(const syntax::Value& value, const PropertySpec& parameter,
                                           TextureSpace space);
  std::optional<std::uint32_t> add_formula(const syntax::Value& value);
  std::uint32_t add(Texture texture);
  std::uint32_t index_of(const ReadTexture& end);

  const Scope& scope_;
  Diagnostics& diagnostics_;
};

}  // namespace fathom::compiler
