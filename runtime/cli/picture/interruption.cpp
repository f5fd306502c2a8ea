#include "runtime/cli/picture/interruption.h"

namespace fathom::cli {
namespace {

// Signal handlers may only access lock-free atomics.
std::atomic<bool> stop_asked = false, picture_asked = false;
static_assert(std::atomic<bool>::is_always_lock_free);

void on_signal(int signal) {
  if (signal == SIGUSR1) {
    picture_asked = true;
  } else if (stop_asked.exchange(true) && signal == SIGINT) {
    std::signal(signal, SIG_DFL);
    std::raise(signal);
  }
}

}  // namespace

Interruption::Interruption() {
  stop_asked = picture_asked = false;
  struct sigaction action {};
  action.sa_handler = on_signal;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    sigaction(kSignals[i], nullptr, &before_[i]);
    const bool nohup = kSignals[i] == SIGHUP && before_[i].sa_handler == SIG_IGN;
    if (!nohup) sigaction(kSignals[i], &action, nullptr);
  }
}

Interruption::~Interruption() {
  for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &before_[i], nullptr);
}

const std::atomic<bool>& Interruption::stop() const { return stop_asked; }

bool Interruption::image_requested() { return picture_asked.exchange(false); }

}  // namespace fathom::cli
