// The files that a command reads and writes. No file may be both read and written, or written by two outputs.
// Tested by: tests/runtime/cli/cli_overwriting_test.cpp
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

namespace fathom::cli {

class UsedFiles {
 public:
  // A file is known by its canonical path, whether or not it exists.
  void add_input(const std::string& path) { add(path, Use::Input); }
  void add_output(const std::string& path) { add(path, Use::Output); }
  // Returns the first file added that is already an output, or, if it is an output itself, already an input.
  const std::optional<std::string>& conflict() const { return conflict_; }

 private:
  enum class Use { Input, Output };
  void add(const std::string& path, Use use);

  std::map<std::filesystem::path, Use> uses_;
  std::optional<std::string> conflict_;
};

}  // namespace fathom::cli
