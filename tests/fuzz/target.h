// Fuzz targets: functions that accept any bytes. Each target has a file tests/fuzz/NAME_target.cpp, a row in
// target.cpp, and seeds, the inputs to begin with. A target throws BrokenPromise if a property that holds for every
// input is violated. The sanitizers and CHECK detect other errors.
//
// `scripts/fuzz NAME SECONDS` runs libFuzzer on a target. fuzz_test.cpp runs each target on its seeds, and on the
// inputs that once broke something, tests/fuzz/found/NAME/*, as ordinary tests.
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
  std::size_t longest;  // max size of inputs that are of interest, bytes
  void (*run)(Bytes input);
  std::vector<Input> (*seeds)();
};

std::span<const Target> targets();
const Target* find_target(std::string_view name);  // nullptr if there is none

Input read_file(const std::filesystem::path& path);
void write_file(const std::filesystem::path& path, Bytes content);

// Path of a file private to this process, for one user of the name at a time. The destructor removes the file if
// anybody wrote it.
class ScratchFile {
 public:
  explicit ScratchFile(std::string_view name);
  ~ScratchFile();
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  const std::string path;
};

// Returns the files below a folder of the repository with this extension (empty: any), sorted. Empty if the folder
// does not exist.
std::vector<std::filesystem::path> files_below(const std::string& folder, std::string_view ending);
// Returns the contents of those files that have at most `longest` bytes.
std::vector<Input> files_below(const std::string& folder, std::string_view ending, std::size_t longest);

// Returns the inputs in tests/golden/diagnostics whose code starts with `code`, without the expected parts.
std::vector<Input> golden_inputs(std::string_view code);

}  // namespace fathom::fuzz
