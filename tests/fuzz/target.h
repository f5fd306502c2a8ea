// Fuzz targets: functions that any bytes may be given to. One file each, tests/fuzz/NAME_target.cpp, and a row in
// target.cpp; each has seeds, inputs to begin with. A target throws BrokenPromise where what holds of every input
// does not; the sanitizers and CHECK see the rest.
//
// `scripts/fuzz NAME SECONDS` runs libFuzzer on one. fuzz_test.cpp gives each its seeds, and the inputs that once
// broke something, tests/fuzz/found/NAME/*, as ordinary tests.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace fathom::fuzz {

using Bytes = std::span<const std::uint8_t>;
using Input = std::vector<std::uint8_t>;

struct BrokenPromise : std::logic_error {
  using std::logic_error::logic_error;
};

inline void promise(bool kept, const std::string& what) {
  if (!kept) throw BrokenPromise(what);
}

inline Input to_input(std::string_view text) { return {text.begin(), text.end()}; }
inline std::string to_text(Bytes bytes) { return {bytes.begin(), bytes.end()}; }

struct Target {
  std::string_view name;
  std::size_t longest;  // input that is of interest, bytes
  void (*run)(Bytes input);
  std::vector<Input> (*seeds)();
};

std::span<const Target> targets();
const Target* find_target(std::string_view name);  // nullptr when there is none

Input read_file(const std::filesystem::path& path);
void write_file(const std::filesystem::path& path, Bytes content);

// A file of this process alone, for one user of the name at a time; removed with the object, if somebody writes it.
class ScratchFile {
 public:
  explicit ScratchFile(std::string_view name);
  ~ScratchFile();
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  const std::string path;
};

// The files below a folder of the repository with that ending, or any, sorted; none where there is no such folder.
std::vector<std::filesystem::path> files_below(const std::string& folder, std::string_view ending);
// Their content, of those of at most `longest` bytes.
std::vector<Input> files_below(const std::string& folder, std::string_view ending, std::size_t longest);

// Texts of tests/golden/diagnostics whose code starts with `code`, what is expected left out.
std::vector<Input> golden_inputs(std::string_view code);

}  // namespace fathom::fuzz
