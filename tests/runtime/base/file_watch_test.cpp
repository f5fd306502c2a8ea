#include "runtime/base/file_watch.h"

#include <fstream>

#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"

namespace fathom::runtime::file_watch_test {
namespace {

// A watched file. Every text has another length, because two writes can have the same time stamp.
class Watched {
 public:
  Watched() : path_(folder_.file("scene.json")) { write("a scene"); }
  void write(const std::string& text) const { std::ofstream(path_) << text; }
  void remove() const { std::filesystem::remove(path_); }
  FileWatch watch() const { return FileWatch({path_}); }

 private:
  test::TemporaryFolder folder_;
  std::string path_;
};

}  // namespace

TEST_CASE("file watch: what stays as it is has not changed", "[base]") {
  const Watched file;
  FileWatch watch = file.watch();
  CHECK(!watch.changed());
  CHECK(!watch.settled());
  CHECK(!watch.settled());
}

TEST_CASE("file watch: a change has settled when a second look finds the same, and counts once", "[base]") {
  const Watched file;
  FileWatch watch = file.watch();
  file.write("another scene");
  CHECK(!watch.settled());
  CHECK(watch.settled());
  CHECK(!watch.settled());
  CHECK(!watch.changed());
}

TEST_CASE("file watch: a file that is written in steps settles after the last", "[base]") {
  const Watched file;
  FileWatch watch = file.watch();
  for (const char* text : {"", "{", "{ \"version\": 1 }"}) {
    file.write(text);
    CHECK(!watch.settled());
    CHECK(watch.changed());
  }
  CHECK(watch.settled());
}

TEST_CASE("file watch: a change that is noticed early stays one until it has settled", "[base]") {
  const Watched file;
  FileWatch watch = file.watch();
  file.write("");
  CHECK(watch.changed());
  CHECK(watch.changed());
  file.write("another scene");
  CHECK(!watch.settled());
  CHECK(watch.settled());
  CHECK(!watch.changed());
}

TEST_CASE("file watch: a file that is away has not changed, nor settled, until it is back", "[base]") {
  const Watched file;
  FileWatch watch = file.watch();
  file.remove();
  CHECK(!watch.changed());
  CHECK(!watch.settled());
  file.write("another scene");
  CHECK(watch.changed());
  file.remove();
  CHECK(!watch.settled());
  CHECK(!watch.settled());
  file.write("yet another scene");
  CHECK(!watch.settled());
  CHECK(watch.settled());
}

TEST_CASE("file watch: one of several files is enough", "[base]") {
  const test::TemporaryFolder folder;
  std::ofstream(folder.file("a")) << "1";
  std::ofstream(folder.file("b")) << "1";
  FileWatch watch({folder.file("a"), folder.file("b")});
  std::ofstream(folder.file("b")) << "12";
  CHECK(!watch.settled());
  std::ofstream(folder.file("a")) << "12";
  CHECK(!watch.settled());
  CHECK(watch.settled());
}

}  // namespace fathom::runtime::file_watch_test
