#include "tests/support/program.h"

#include <sys/wait.h>

#include <cstdlib>

namespace fathom::tests {

Result Folder::run(const std::string& arguments, const std::string& in) const {
  const std::filesystem::path io = path().string() + ".io";  // beside the folder, which stays the user's
  std::filesystem::create_directories(io);
  std::ofstream(io / "in") << in;
  const std::string command = "cd '" + path().string() + "' && '" FATHOM_PROGRAM "' " + arguments + " <'" +
                              (io / "in").string() + "' >'" + (io / "out").string() + "' 2>'" +
                              (io / "err").string() + "'";
  const int status = std::system(command.c_str());
  Result result{WIFEXITED(status) ? WEXITSTATUS(status) : -1, read("../" + io.filename().string() + "/out"),
                read("../" + io.filename().string() + "/err")};
  std::filesystem::remove_all(io);
  return result;
}

}  // namespace fathom::tests
