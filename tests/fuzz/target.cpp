#include "tests/fuzz/target.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <system_error>

namespace fathom::fuzz {

namespace fs = std::filesystem;

void run_scene(Bytes input);
std::vector<Input> seeds_of_scene();
void run_formula(Bytes input);
std::vector<Input> seeds_of_formula();
void run_import(Bytes input);
std::vector<Input> seeds_of_import();
void run_text(Bytes input);
std::vector<Input> seeds_of_text();
void run_picture(Bytes input);
std::vector<Input> seeds_of_picture();
void run_film(Bytes input);
std::vector<Input> seeds_of_film();
void run_differential(Bytes input);
std::vector<Input> seeds_of_differential();
void run_assembly(Bytes input);
std::vector<Input> seeds_of_assembly();
void run_program(Bytes input);
std::vector<Input> seeds_of_program();

std::span<const Target> targets() {
  static constexpr Target kTargets[] = {
      {"scene", 8192, run_scene, seeds_of_scene},
      {"formula", 1024, run_formula, seeds_of_formula},
      {"import", 8192, run_import, seeds_of_import},
      {"text", 4096, run_text, seeds_of_text},
      {"assembly", 16384, run_assembly, seeds_of_assembly},
      {"program", 16384, run_program, seeds_of_program},
      {"picture", 8192, run_picture, seeds_of_picture},
      {"film", 16384, run_film, seeds_of_film},
      {"differential", 512, run_differential, seeds_of_differential},
  };
  return kTargets;
}

const Target* find_target(std::string_view name) {
  for (const Target& target : targets()) {
    if (target.name == name) return &target;
  }
  return nullptr;
}

Input read_file(const fs::path& path) {
  std::stringstream content;
  content << std::ifstream(path, std::ios::binary).rdbuf();
  return to_input(content.str());
}

void write_file(const fs::path& path, Bytes content) {
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(content.data()), static_cast<std::streamsize>(content.size()));
}

ScratchFile::ScratchFile(std::string_view name)
    : path((fs::temp_directory_path() / fmt::format("fathom-fuzz-{}-{}", getpid(), name)).string()) {}

ScratchFile::~ScratchFile() {
  std::error_code ignored;
  fs::remove(path, ignored);
}

std::vector<fs::path> files_below(const std::string& folder, std::string_view ending) {
  std::vector<fs::path> paths;
  const fs::path root = fs::path(FATHOM_SOURCE_DIR) / folder;
  if (!fs::exists(root)) return paths;
  for (const auto& entry : fs::recursive_directory_iterator(root)) {
    if (entry.is_regular_file() && (ending.empty() || entry.path().extension() == ending))
      paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

std::vector<Input> files_below(const std::string& folder, std::string_view ending, std::size_t longest) {
  std::vector<Input> inputs;
  for (const fs::path& path : files_below(folder, ending)) {
    if (fs::file_size(path) <= longest) inputs.push_back(read_file(path));
  }
  return inputs;
}

std::vector<Input> golden_inputs(std::string_view code) {
  std::vector<Input> inputs;
  for (const fs::path& path : files_below("tests/golden/diagnostics", ".txt")) {
    if (!path.filename().string().starts_with(code)) continue;
    const Input whole = read_file(path);
    const std::string text = to_text(whole);
    inputs.push_back(to_input(text.substr(0, text.find("----- expected"))));
  }
  return inputs;
}

}  // namespace fathom::fuzz
