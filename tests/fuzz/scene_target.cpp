// Fuzz target for JSON scene files, through the whole compiler. tests/fuzz/check_scene.h lists the promises.
#include "tests/fuzz/check_scene.h"
#include "tests/fuzz/target.h"

namespace fathom::fuzz {

void run_scene(Bytes input) { check_scene(to_text(input)); }

std::vector<Input> seeds_of_scene() {
  std::vector<Input> seeds = files_below("scenes", ".json", 8192);
  for (const char* codes : {"E0", "W0"}) {
    for (Input& input : golden_inputs(codes)) seeds.push_back(std::move(input));
  }
  return seeds;
}

}  // namespace fathom::fuzz
