#include "runtime/cli/picture/interruption.h"

#include <unistd.h>

#include <string_view>

#include "runtime/cli/options/exit_code.h"

namespace fathom::cli {
namespace {

// Signal handlers may only access lock-free atomics.
std::atomic<bool> stop_asked = false, picture_asked = false, prepares = false;
static_assert(std::atomic<bool>::is_always_lock_free);
constexpr unsigned kPatience = 2;  // seconds

void on_signal(int signal) {
  if (signal == SIGUSR1) {
    picture_asked = true;
  } else if (signal == SIGALRM) {
    if (!prepares) return;
    constexpr std::string_view kNote = "note: interrupted while the picture was prepared\n";
    (void)!::write(STDERR_FILENO, kNote.data(), kNote.size());
    ::_exit(kInterrupted);
  } else if (stop_asked.exchange(true)) {
    if (signal != SIGINT) return;
    std::signal(signal, SIG_DFL);
    std::raise(signal);
  } else {
    ::alarm(kPatience);
  }
}

}  // namespace

Interruption::Interruption() {
  stop_asked = picture_asked = prepares = false;
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
  prepares = false;
  ::alarm(0);
  for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &before_[i], nullptr);
}

const std::atomic<bool>& Interruption::stop() const { return stop_asked; }

void Interruption::begin_preparation() { prepares = true; }

void Interruption::end_preparation() { prepares = false; }

bool Interruption::image_requested() { return picture_asked.exchange(false); }

}  // namespace fathom::cli
