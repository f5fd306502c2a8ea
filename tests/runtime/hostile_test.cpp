// Hostile inputs (tests/hostile/cases.txt): each is refused with the expected exit status and message, in little
// memory, with nothing on standard output and no file left behind. The test checks that each run ends, not how soon:
// the system kills the program after more seconds of processor time than even a slow machine needs.
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "tests/support/catch.h"
#include "tests/support/golden.h"
#include "tests/support/program.h"

namespace fathom::hostile_test {

namespace {

using namespace fathom::test;
namespace fs = std::filesystem;

const fs::path kFolder = fs::path(FATHOM_SOURCE_DIR) / "tests/hostile";

struct Case {
  std::string name, arguments, message;
  int code;
};

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(' '), last = text.find_last_not_of(' ');
  return first == text.npos ? "" : text.substr(first, last - first + 1);
}

std::vector<Case> all_cases() {
  std::vector<Case> cases;
  std::istringstream lines(read_file(kFolder / "cases.txt"));
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::vector<std::string> cells;
    for (std::size_t at = 0; at <= line.size();) {
      const std::size_t end = std::min(line.find(" | ", at), line.size());
      cells.push_back(trimmed(line.substr(at, end - at)));
      at = end + 3;
    }
    REQUIRE(cells.size() == 4);
    cases.push_back({cells[0], cells[1], cells[3], std::stoi(cells[2])});
  }
  return cases;
}

std::string numbered(std::string text, const std::string& mark, int number) {
  const std::string digits = std::to_string(number);
  for (std::size_t at; (at = text.find(mark)) != text.npos;) text.replace(at, mark.size(), digits);
  return text;
}

// Expands "<rep 3>text</rep>" to three copies of the text. In the text, $i and $j are the copy's number, counted from
// 0 and from 1.
std::string expanded(const std::string& recipe) {
  std::string out;
  for (std::size_t at = 0;;) {
    const std::size_t begin = recipe.find("<rep ", at);
    out.append(recipe, at, begin - at);
    if (begin == recipe.npos) return out;
    const std::size_t text = recipe.find('>', begin) + 1, end = recipe.find("</rep>", text);
    REQUIRE(end != recipe.npos);
    const int times = std::stoi(recipe.substr(begin + 5));
    const std::string part = recipe.substr(text, end - text);
    const bool counts = part.find('$') != part.npos;
    for (int i = 0; i < times; ++i) out += counts ? numbered(numbered(part, "$i", i), "$j", i + 1) : part;
    at = end + 6;
  }
}

// Writes the case's own file, and small files that other cases name.
void make_files(const Folder& folder, const Case& hostile) {
  for (const char* beside : {"chunk-of-a-gigabyte.png", "huge.hdr", "of-nothing.hdr"})
    fs::copy_file(kFolder / beside, folder.path() / beside);
  fs::create_symlink("/dev/zero", folder.path() / "zero.pfm");
  fs::remove(folder.path() / hostile.name);
  const fs::path recipe = kFolder / (hostile.name + ".recipe");
  if (fs::exists(recipe)) {
    folder.write(hostile.name, expanded(read_file(recipe)));
  } else if (fs::exists(kFolder / hostile.name)) {
    fs::copy_file(kFolder / hostile.name, folder.path() / hostile.name);
  }
}

// Processor time; the sanitizers take many times as long.
rlim_t max_seconds() { return is_sanitized() ? 300 : 30; }

struct Outcome {
  int code = -1;  // exit status, or minus 1000 plus the number of the signal that ended the program
  double megabytes = 0;
  std::string out, err;
};

// Runs the program by a shell in the folder. The measured memory includes the shell's.
Outcome outcome_of(const Folder& folder, const std::string& arguments) {
  const std::string out = folder.path().string() + ".out", err = folder.path().string() + ".err";
  const std::string command = "exec '" + program_path() + "' " + arguments;
  const rlimit seconds{max_seconds(), max_seconds()};
  const pid_t child = fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    const int in = open("/dev/null", O_RDONLY), to = creat(out.c_str(), 0600), errors = creat(err.c_str(), 0600);
    if (setrlimit(RLIMIT_CPU, &seconds) != 0) _exit(125);
    if (chdir(folder.path().c_str()) != 0 || dup2(in, 0) < 0 || dup2(to, 1) < 0 || dup2(errors, 2) < 0) _exit(126);
    execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
    _exit(127);
  }
  int status = 0;
  rusage usage{};
  REQUIRE(wait4(child, &status, 0, &usage) == child);
  Outcome outcome{WIFEXITED(status) ? WEXITSTATUS(status) : WTERMSIG(status) - 1000,
                  static_cast<double>(usage.ru_maxrss) / 1024, read_file(out), read_file(err)};
  fs::remove(out), fs::remove(err);
  return outcome;
}

std::set<std::string> names_in(const fs::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.insert(entry.path().filename().string());
  return names;
}

TEST_CASE("hostile inputs are refused with a message, in the end and in little memory",
          "[runtime][limits][hostile]") {
  const std::vector<Case> cases = all_cases();
  CHECK(cases.size() >= 60);
  std::set<std::string> used;
  for (const Case& hostile : cases) {
    const Folder folder;
    make_files(folder, hostile);
    used.insert(hostile.name);
    std::string arguments = hostile.arguments;
    if (const std::size_t at = arguments.find("FILE"); at != arguments.npos) arguments.replace(at, 4, hostile.name);
    const std::set<std::string> before = names_in(folder.path());
    const Outcome outcome = outcome_of(folder, arguments);
    INFO(hostile.name << ": fathom " << arguments << "\n" << outcome.err.substr(0, 600));
    CHECK(outcome.code == hostile.code);
    CHECK((outcome.code == 65 || outcome.code == 74));
    CHECK(outcome.err.find(hostile.message) != std::string::npos);
    CHECK(outcome.out.empty());
    CHECK(names_in(folder.path()) == before);
    CHECK(outcome.err.size() < 100'000);
    if (!is_sanitized()) CHECK(outcome.megabytes < 256);
  }
  for (std::string name : names_in(kFolder)) {
    if (name.ends_with(".recipe")) name.resize(name.size() - 7);
    CAPTURE(name);
    CHECK((name == "cases.txt" || used.contains(name)));
  }
}

}  // namespace

}  // namespace fathom::hostile_test
