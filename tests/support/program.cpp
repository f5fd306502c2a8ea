#include "tests/support/program.h"

#include <sys/wait.h>

#include <cstdlib>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "runtime/cli/run.h"

namespace fathom::test {
namespace {

// Changes the working folder until its end. Working folders belong to the process, and tests run one after the other.
class WorkingFolder {
 public:
  explicit WorkingFolder(const std::filesystem::path& path) : before_(std::filesystem::current_path()) {
    std::filesystem::current_path(path);
  }
  ~WorkingFolder() { std::filesystem::current_path(before_); }
  WorkingFolder(const WorkingFolder&) = delete;
  WorkingFolder& operator=(const WorkingFolder&) = delete;

 private:
  std::filesystem::path before_;
};

// Splits arguments into words as a shell does, with its quotes and backslashes. Fails at other characters that have a
// meaning for a shell, because such lines are for run_script().
std::vector<std::string> words_of(std::string_view arguments) {
  std::vector<std::string> words;
  std::optional<std::string> word;
  char quote = 0;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const char c = arguments[i];
    const auto is_any_of = [c](std::string_view set) { return set.find(c) != set.npos; };
    if (quote == 0 && is_any_of(" \n")) {
      if (word) words.push_back(*std::exchange(word, std::nullopt));
      continue;
    }
    const bool begins_word = quote == 0 && !word;
    if (is_any_of(quote == 0 ? "$`|&;<>()*?[{" : quote == '"' ? "$`" : "") || (begins_word && is_any_of("~#"))) {
      FAIL("only a shell understands `" << c << "` in: " << arguments);
    }
    if (!word) word.emplace();
    if (quote == 0 && is_any_of("'\"")) {
      quote = c;
    } else if (c == quote) {
      quote = 0;
    } else if (c == '\\' && quote != '\'') {
      REQUIRE(++i < arguments.size());
      if (quote == '"' && std::string_view("$`\"\\\n").find(arguments[i]) == std::string_view::npos) *word += c;
      *word += arguments[i];
    } else {
      *word += c;
    }
  }
  REQUIRE(quote == 0);
  if (word) words.push_back(*word);
  return words;
}

}  // namespace

std::string program_path() { return FATHOM_PROGRAM; }
bool is_sanitized() { return FATHOM_SANITIZED; }

Result Folder::run(const std::string& arguments, const std::string& in) const {
  const std::vector<std::string> words = words_of(arguments);
  const WorkingFolder here(path());
  std::istringstream input(in);
  std::ostringstream out, err;
  const int code = cli::run(words, {input, out, err});
  return {code, out.str(), err.str()};
}

std::string Folder::transcript(const std::string& arguments) const {
  const std::vector<std::string> words = words_of(arguments);
  const WorkingFolder here(path());
  std::istringstream input;
  std::ostringstream both;
  cli::run(words, {input, both, both});
  return both.str();
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
