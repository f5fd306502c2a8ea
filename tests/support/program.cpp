#include "tests/support/program.h"

#include <sys/wait.h>

#include <cstdlib>

namespace fathom::test {

std::string program_path() { return FATHOM_PROGRAM; }
bool is_sanitized() { return FATHOM_SANITIZED; }

Result Folder::run(const std::string& arguments, const std::string& in) const {
  std::ofstream(path().string() + ".in") << in;
  Result result = run_script("\"$fathom\" " + arguments + " <'" + path().string() + ".in'");
  std::filesystem::remove(path().string() + ".in");
  return result;
}

Result Folder::run_script(const std::string& lines) const {
  // A sibling of the folder, so that the folder contains only the test's files.
  const std::filesystem::path io = path().string() + ".io";
  std::filesystem::create_directories(io);
  std::ofstream(io / "script") << "fathom='" FATHOM_PROGRAM "'\n" << lines << '\n';
  const std::string command = "cd '" + path().string() + "' && sh '" + (io / "script").string() + "' >'" +
                              (io / "out").string() + "' 2>'" + (io / "err").string() + "'";
  const int status = std::system(command.c_str());
  Result result{WIFEXITED(status) ? WEXITSTATUS(status) : -1, read("../" + io.filename().string() + "/out"),
                read("../" + io.filename().string() + "/err")};
  std::filesystem::remove_all(io);
  return result;
}

}  // namespace fathom::test
