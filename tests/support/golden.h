// Golden files: an input and what is printed for it, in one file, parted by the line "----- expected".
// FATHOM_UPDATE_GOLDEN=1 in the environment rewrites the second part.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace fathom::tests {

// The whole file.
std::string read_file(const std::filesystem::path& path);

// The files of tests/golden/`folder`, sorted.
std::vector<std::filesystem::path> golden_files(const std::string& folder);

// CHECKs that print(input) is what each file of the folder expects.
void check_golden(const std::string& folder, const std::function<std::string(const std::string& input)>& print);

}  // namespace fathom::tests
