// Fuzz target for foreign formats: expression lists and trees of nested nodes
// (compiler/frontend/formats/expression_list.h, nested_nodes.h). The result must be a scene that compiles, or an
// error.
#include "tests/fuzz/check_scene.h"
#include "tests/fuzz/target.h"

namespace fathom::fuzz {
namespace {

constexpr const char* kTree = R"({"aabb_min": [-1, -1, -1], "aabb_max": [1, 1, 1],
 "nodeType": "binaryOperator", "blendMode": "union", "blendRadius": 0.1,
 "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0],
 "leftChild": {"nodeType": "primitive", "primitiveType": "sphere", "radius": 0.5, "color": [1, 0, 0],
  "matrix": [1, 0, 0, 0.2, 0, 1, 0, 0, 0, 0, 1, 0]},
 "rightChild": {"nodeType": "primitive", "primitiveType": "box", "sides": [1, 0.5, 0.25], "color": [0, 1, 0],
  "round_x": 0, "round_y": 0, "bevel": 0, "matrix": [0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0.5]}})";
constexpr const char* kList =
    "# a ball\n_0 const 2.95\n_1 var-x\n_2 mul _0 _1\n_3 var-y\n_4 square _2\n_5 square _3\n_6 add _4 _5\n_7 sqrt "
    "_6\n"
    "_8 const 0.5\n_9 sub _7 _8\n_a var-z\n_b mod _a _8\n_c compare _b _9\n_d and _c _9\n_e max _d _9\n";

}  // namespace

void run_import(Bytes input) { check_scene(to_text(input)); }

std::vector<Input> seeds_of_import() {
  std::vector<Input> seeds = files_below("tests/data", ".vm", 8192);
  for (Input& input : golden_inputs("E06")) seeds.push_back(std::move(input));
  seeds.push_back(to_input(kTree));
  seeds.push_back(to_input(kList));
  return seeds;
}

}  // namespace fathom::fuzz
