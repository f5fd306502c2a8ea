// A folder for files that only this user may read, removed at the end.
// Tested by: tests/runtime/cli/view/cli_view_attacks_test.cpp
#pragma once

#include <string>

namespace fathom::cli {

class PrivateFolder {
 public:
  PrivateFolder();
  ~PrivateFolder();
  PrivateFolder(const PrivateFolder&) = delete;
  PrivateFolder& operator=(const PrivateFolder&) = delete;

  // Empty if no folder can be made.
  const std::string& path() const { return path_; }
  std::string file(const std::string& name) const { return path_ + "/" + name; }

 private:
  std::string path_;
};

}  // namespace fathom::cli
