// The program fathom. Sets up its process: terminals, signals and the handler of uncaught exceptions.
// Tested by: tests/runtime/cli/cli_test.cpp
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <new>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/cli/options/help_text.h"
#include "runtime/cli/run.h"

namespace fathom::cli {
namespace {

// Terminate handler: prints the reason and exits. std::terminate is called for an uncaught exception in a thread, and
// for a thread not joined when the main thread throws. Both happen when memory or threads run out.
[[noreturn]] void end_at_once() {
  std::string_view reason = "not enough memory, or not enough threads";
  try {
    if (const std::exception_ptr thrown = std::current_exception()) std::rethrow_exception(thrown);
  } catch (const std::bad_alloc&) {
    reason = "not enough memory";
  } catch (const std::exception& error) {
    reason = error.what();
  }
  for (const std::string_view part : {std::string_view("error: "), reason, std::string_view("\n")})
    (void)!::write(STDERR_FILENO, part.data(), part.size());
  std::_Exit(kInternal);
}

void set_handlers(std::string_view verb) {
  std::signal(SIGXFSZ, SIG_IGN);  // exceeding the limit of file size makes a write fail instead of ending the program
  if (verb == "render") {
    std::signal(SIGUSR1, SIG_IGN);  // ignore requests for an image while there is none
    // A reader of the messages may close its pipe before the render is done. Other verbs end with their reader.
    std::signal(SIGPIPE, SIG_IGN);
  }
  std::set_terminate(end_at_once);
  std::signal(SIGABRT, [](int) { std::_Exit(kInternal); });  // a failed CHECK aborts after its message
}

// Overwrites the argument of `view --token`, because any user of the machine sees the arguments of programs.
void hide_token(std::span<char* const> args) {
  constexpr std::string_view kOption = "--token";
  if (args.empty() || std::string_view(args.front()) != "view") return;
  for (std::size_t i = 1; i < args.size(); ++i) {
    const std::string_view before = args[i - 1], word = args[i];
    if (word.starts_with("--token="))
      std::fill_n(args[i] + kOption.size() + 1, word.size() - kOption.size() - 1, '*');
    if (before == kOption) std::fill_n(args[i], word.size(), '*');
  }
}

Streams standard_streams() {
  const bool terminal = isatty(STDERR_FILENO) != 0;
  const char* no_color = std::getenv("NO_COLOR");
  const char* term = std::getenv("TERM");
  const bool dumb = term == nullptr || std::string_view(term) == "dumb";
  const bool color = terminal && !dumb && (no_color == nullptr || *no_color == '\0');
  std::ios::sync_with_stdio(false);
  Streams streams{std::cin, std::cout,          std::cerr, terminal && !dumb, color, isatty(STDOUT_FILENO) != 0,
                  terminal_columns()};
  streams.shows_steps = true;
  return streams;
}

}  // namespace
}  // namespace fathom::cli

int main(int argc, char** argv) {
  const std::vector<std::string> args(argv + 1, argv + argc);
  fathom::cli::hide_token({argv + 1, argv + argc});
  fathom::cli::set_handlers(args.empty() ? "" : args.front());
  return fathom::cli::run(args, fathom::cli::standard_streams());
}

// Large blocks lie on huge pages where the system has them: zeroing and finding the small pages of a map of light
// took half of the time to read it. The sanitizers have allocators of their own.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define FATHOM_OTHER_ALLOCATOR
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define FATHOM_OTHER_ALLOCATOR
#endif
#endif
#ifndef FATHOM_OTHER_ALLOCATOR
void* operator new(std::size_t size) {
  constexpr std::size_t kHugePage = std::size_t{1} << 21;
  void* block = nullptr;
  if (size < 2 * kHugePage) {
    block = std::malloc(std::max(size, std::size_t{1}));
  } else if (size <= SIZE_MAX - kHugePage) {
    const std::size_t whole = (size + kHugePage - 1) / kHugePage * kHugePage;
    block = std::aligned_alloc(kHugePage, whole);
    if (block != nullptr) ::madvise(block, whole, MADV_HUGEPAGE);
  }
  if (block == nullptr) throw std::bad_alloc();
  return block;
}
void operator delete(void* block) noexcept { std::free(block); }
void operator delete(void* block, std::size_t) noexcept { std::free(block); }
#endif
