// fuzz_seeds FOLDER: writes the seeds, in one folder per target. `scripts/fuzz` calls it.
#include <cstdio>
#include <filesystem>
#include <string>

#include "tests/fuzz/target.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: fuzz_seeds FOLDER\n");
    return 2;
  }
  namespace fs = std::filesystem;
  for (const fathom::fuzz::Target& target : fathom::fuzz::targets()) {
    const fs::path folder = fs::path(argv[1]) / target.name;
    fs::create_directories(folder);
    int number = 0;
    for (const fathom::fuzz::Input& seed : target.seeds()) {
      fathom::fuzz::write_file(folder / std::to_string(number++), seed);
    }
    std::printf("%s: %d seeds\n", std::string(target.name).c_str(), number);
  }
}
