#include "runtime/cli/options/step_line.h"

#include <fmt/format.h>

#include <ostream>
#include <utility>

#include "vm/encoding/printable.h"

namespace fathom::cli {
namespace {

using namespace std::chrono_literals;

constexpr auto kFirst = 500ms, kRedraw = 100ms, kLine = 10000ms;

}  // namespace

StepLine::StepLine(const Streams& streams, std::string work) : streams_(streams), work_(std::move(work)) {
  if (streams.shows_steps && !streams.quiet && streams.verbosity == 0) thread_ = std::thread([this] { run(); });
}

void StepLine::begin(std::string_view step) {
  const std::lock_guard lock(mutex_);
  step_ = vm::printable(step);
}

void StepLine::end() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    over_ = true;
  }
  wake_.notify_one();
  thread_.join();
  if (drawn_ && streams_.terminal) streams_.err << "\r\033[K" << std::flush;
}

void StepLine::run() {
  std::unique_lock lock(mutex_);
  auto wait = streams_.terminal ? kFirst : kLine;
  while (!wake_.wait_for(lock, wait, [this] { return over_; })) {
    draw();
    wait = streams_.terminal ? kRedraw : kLine;
  }
}

void StepLine::draw() {
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(Clock::now() - start_).count();
  const std::string line = fmt::format("{}{}{}, {} s", work_, step_.empty() ? "" : ": ", step_, seconds);
  streams_.err << (streams_.terminal ? "\r" + line + "\033[K" : line + "\n") << std::flush;
  drawn_ = true;
}

}  // namespace fathom::cli
