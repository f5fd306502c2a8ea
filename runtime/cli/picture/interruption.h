// Signals during a render: SIGINT, SIGTERM and SIGHUP ask the render to stop, and a second SIGINT ends the program at
// once. A second SIGHUP or SIGTERM has no further effect, because shells and queues may send one to the task and one
// to its process group. SIGUSR1 asks for the image so far. Under nohup, SIGHUP stays ignored. The destructor restores
// the previous actions.
// Tested by: tests/runtime/cli/picture/cli_checkpoint_test.cpp
#pragma once

#include <array>
#include <atomic>
#include <csignal>

namespace fathom::cli {

// At most one object may exist at a time.
class Interruption {
 public:
  Interruption();
  ~Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

  // Becomes true with the first signal that asks the render to stop.
  const std::atomic<bool>& stop() const;
  // A signal ends the program, with kInterrupted, if what makes ready to render takes another two seconds. Then
  // nothing is lost.
  void begin_preparation();
  void end_preparation();
  // True if SIGUSR1 has arrived since the last call.
  bool image_requested();

 private:
  static constexpr std::array kSignals = {SIGINT, SIGTERM, SIGHUP, SIGUSR1, SIGALRM};
  std::array<struct sigaction, kSignals.size()> before_{};
};

}  // namespace fathom::cli
