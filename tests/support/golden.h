// Golden files: an input and its expected output in one file, separated by the line "----- expected".
// FATHOM_UPDATE_GOLDEN=1 in the environment rewrites the expected output.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace fathom::test {

// Returns the content of the file.
std::string read_file(const std::filesystem::path& path);

// Returns the files of tests/golden/`folder`, sorted.
std::vector<std::filesystem::path> golden_files(const std::string& folder);

// CHECKs for each file of the folder that print(input) is the expected output.
void check_golden(const std::string& folder, const std::function<std::string(const std::string& input)>& print);

}  // namespace fathom::test
