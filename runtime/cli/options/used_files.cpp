#include "runtime/cli/options/used_files.h"

#include <system_error>

namespace fathom::cli {

void UsedFiles::add(const std::string& path, Use use) {
  std::error_code ignored;
  const auto canonical = std::filesystem::weakly_canonical(std::filesystem::absolute(path, ignored), ignored);
  const auto [entry, added] = uses_.emplace(canonical, use);
  const bool shared = use == Use::Input && entry->second == Use::Input;
  if (!added && !shared && !conflict_) conflict_ = path;
}

}  // namespace fathom::cli
