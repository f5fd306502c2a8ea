#include "runtime/cli/options/step_line.h"

#include <sstream>
#include <thread>

#include "tests/support/catch.h"

namespace fathom::cli {

TEST_CASE("a terminal shows the step under way, and nothing in the end", "[cli]") {
  std::istringstream in;
  std::ostringstream out, err;
  Streams streams{in, out, err};
  streams.terminal = streams.shows_steps = true;
  {
    StepLine line(streams, "meshing");
    line.begin("contour");
    std::this_thread::sleep_for(std::chrono::milliseconds(900));
  }
  CHECK(err.str().find("\rmeshing: contour, 0 s\033[K") != std::string::npos);
  CHECK(err.str().ends_with("\r\033[K"));
}

TEST_CASE("short work, files and quiet verbs show no steps", "[cli]") {
  std::istringstream in;
  std::ostringstream out, err;
  Streams streams{in, out, err};
  streams.shows_steps = true;
  { StepLine line(streams, "meshing"); }
  streams.terminal = true;
  { StepLine line(streams, "meshing"); }
  streams.quiet = true;
  {
    StepLine line(streams, "meshing");
    std::this_thread::sleep_for(std::chrono::milliseconds(600));
  }
  CHECK(err.str().empty());
}

}  // namespace fathom::cli
