// Programs of random graphs, and compiled scenes, as seeds for targets that read programs or scenes.
#pragma once

#include <utility>
#include <vector>

#include "compiler/compile.h"
#include "compiler/lower/fuse.h"
#include "tests/fuzz/target.h"
#include "tests/support/plain_lowering.h"
#include "tests/support/random/random_scene.h"

namespace fathom::fuzz {

// Returns a dozen programs of a few to some dozens of instructions, fused and not fused.
inline std::vector<vm::VerifiedProgram> seed_programs() {
  std::vector<vm::VerifiedProgram> programs;
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    test::Random random(seed);
    test::GraphOptions options;
    options.depth = 1 + static_cast<int>(seed % 3);
    vm::VerifiedProgram program = test::plain_lowering(test::random_scene(random, options));
    programs.push_back(seed % 2 ? test::verified(compiler::fuse(program.program())) : std::move(program));
  }
  return programs;
}

// Returns the small scenes that come with Fathom, and one scene that puts an entry into every table.
inline std::vector<compiler::CompiledScene> seed_scenes() {
  constexpr const char* kEverything = R"scene({"version": 1, "params": {"r": {"default": 0.5, "min": 0.1}},
    "camera": {"fov_y": 40, "f_stop": 2, "focus_distance": 5, "blades": 6}, "film": {"width": 16, "height": 8},
    "render": {"spp": 4, "far": 100}, "background": {"type": "sky", "elevation": 30},
    "lights": {"lamp": {"type": "spot", "position": [0, 3, 0], "target": [0, 0, 0]}},
    "materials": {"glass": {"type": "transparent", "priority": -2}, "glow": {"type": "emissive"},
      "tiles": {"type": "principled", "base_color": {"pattern": "checker", "a": 1, "b": {"pattern": "noise",
                "a": 0, "b": 1}}, "roughness": "0.2 + 0.1 * sin(x)"}},
    "objects": [{"type": "sphere", "radius": "r", "material": "glass"},
      {"type": "plane", "normal": [0, 1, 0], "offset": -1, "material": "tiles"},
      {"type": "sphere", "radius": 0.2, "material": "glow", "translate": [0, 2, 0]},
      {"type": "extrude", "half_depth": 0.3, "of": {"type": "polygon", "points": [[0, 0], [1, 0], [0, 1]]}}]})scene";
  std::vector<Input> texts = files_below("scenes", ".json", 2048);
  texts.push_back(to_input(kEverything));
  std::vector<compiler::CompiledScene> scenes;
  for (const Input& text : texts) {
    compiler::Diagnostics diagnostics;
    auto scene = compiler::compile({"scene.json", to_text(text)}, diagnostics);
    if (scene) scenes.push_back(*std::move(scene));
  }
  return scenes;
}

}  // namespace fathom::fuzz
