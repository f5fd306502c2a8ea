// Signals while a render is under way: SIGINT, SIGTERM and SIGHUP ask it to stop, and a second SIGINT ends the
// program at once; SIGHUP and SIGTERM may come twice, from a shell or a queue's task and to its whole group. SIGUSR1
// asks for the picture so far. Under nohup SIGHUP stays ignored. Outside the object's life signals do what they did
// before. Tested by: tests/runtime/cli/picture/cli_checkpoint_test.cpp
#pragma once

#include <array>
#include <atomic>
#include <csignal>

namespace fathom::cli {

// One at a time.
class Interruption {
 public:
  Interruption();
  ~Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

  // Becomes true with the first signal that asks to stop.
  const std::atomic<bool>& stop() const;
  // Whether a picture was asked for since the last call.
  bool picture_wanted();

 private:
  static constexpr std::array kSignals = {SIGINT, SIGTERM, SIGHUP, SIGUSR1};
  std::array<struct sigaction, kSignals.size()> before_{};
};

}  // namespace fathom::cli
