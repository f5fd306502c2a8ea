#include "runtime/cli/view/private_folder.h"

#include <stdlib.h>

#include <cstdlib>
#include <filesystem>

namespace fathom::cli {

PrivateFolder::PrivateFolder() {
  for (const char* variable : {"XDG_RUNTIME_DIR", "TMPDIR", ""}) {
    const char* const value = *variable != '\0' ? std::getenv(variable) : "/tmp";
    constexpr std::size_t kLongest = 64;  // names of sockets have at most 107 bytes
    if (value == nullptr || *value != '/' || std::string(value).size() > kLongest) continue;
    std::string path = std::string(value) + "/fathom-XXXXXX";
    if (mkdtemp(path.data()) == nullptr) continue;
    path_ = path;
    return;
  }
}

PrivateFolder::~PrivateFolder() {
  std::error_code ignored;
  if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
}

}  // namespace fathom::cli
