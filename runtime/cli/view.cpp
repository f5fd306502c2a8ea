// fathom view: shows the scene in a browser, live and path-traced, and answers questions about it.
// Tested by: tests/runtime/cli/view/cli_view_test.cpp
#include <fmt/format.h>
#include <spawn.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <optional>
#include <ostream>
#include <thread>

#include "runtime/cli/picture/interruption.h"
#include "runtime/cli/verbs.h"
#include "runtime/cli/view/private_folder.h"
#include "runtime/cli/view/request_guard.h"
#include "runtime/cli/view/view_server.h"

namespace fathom::cli {
namespace {

constexpr const char* kViewExamples =
    "fathom view scene.fathom                      # opens a browser, if there is one\n"
    "fathom view scene.fathom --no-open            # prints the address alone\n"
    "fathom view scene.fathom -D r=0.5 --port 8000";

struct ViewRequest {
  SceneArguments scene;
  int port = 0;
  std::optional<std::string> token;
  std::optional<int> threads;
  bool no_open = false;
};

OptionResult read_token(std::string_view text, std::string& token) {
  if (!is_token(text)) {
    return OptionError{fmt::format("`{}` is no token", text), "it has 16 to 64 letters, digits, - or _"};
  }
  token = text;
  return std::nullopt;
}

std::optional<int> parse(std::span<const std::string> args, const Streams& streams, ViewRequest& request) {
  Arguments arguments("view",
                      "Shows the scene in a browser: live, path-traced, and again whenever its file is saved. The "
                      "page is served to this machine alone.",
                      kViewExamples);
  add_scene_arguments(arguments, request.scene);
  arguments.option("--port", "N", "Port to listen on (any free one)", whole(request.port, 0, 65535));
  arguments.option("--token", "TEXT", "Secret part of the address (random); with --port, a page can be opened again",
                   into(read_token, request.token));
  arguments.option("--threads", "N", "Threads that render (one per processor)", whole(request.threads, 1, 1024));
  arguments.flag("--no-open", "Do not open a browser", request.no_open);
  if (const auto code = arguments.parse(args, streams)) return code;
  if (request.scene.path == "-") {
    return fail(streams, kUsage, "standard input cannot be watched", {"write the scene to a file"});
  }
  return std::nullopt;
}

// Opens the address in the desktop's browser, if there is a desktop. The browser gets the name of a file that leads
// to the address, because any user of the machine sees the arguments of programs. Its output goes nowhere.
void open_browser(const std::string& address, const PrivateFolder& folder) {
  if (std::getenv("DISPLAY") == nullptr && std::getenv("WAYLAND_DISPLAY") == nullptr) return;
  std::string program = "xdg-open", argument = folder.file("open.html");
  std::ofstream(argument) << fmt::format(
      "<!doctype html><title>fathom view</title><meta http-equiv=\"refresh\" content=\"0;url={0}\">"
      "<a href=\"{0}\">fathom view</a>\n",
      address);
  char* const arguments[] = {program.data(), argument.data(), nullptr};
  posix_spawn_file_actions_t quiet;
  posix_spawn_file_actions_init(&quiet);
  posix_spawn_file_actions_addopen(&quiet, STDOUT_FILENO, "/dev/null", 1, 0);
  posix_spawn_file_actions_addopen(&quiet, STDERR_FILENO, "/dev/null", 1, 0);
  pid_t child = 0;
  posix_spawnp(&child, program.c_str(), &quiet, nullptr, arguments, environ);  // without a browser nothing opens
  posix_spawn_file_actions_destroy(&quiet);
}

}  // namespace

int run_view(std::span<const std::string> args, const Streams& streams) {
  ViewRequest request;
  if (const auto code = parse(args, streams, request)) return *code;
  const auto readable = read_scene(request.scene, streams);
  if (const auto* code = std::get_if<ExitCode>(&readable)) return *code;
  RenderRequest render;
  render.scene = request.scene;
  render.quiet = true;
  ViewSession session(render, request.threads.value_or(0));
  // From here on there is something to tidy up. A signal while the scene is read ends the program.
  const Interruption interruption;
  const PrivateFolder folder;
  if (folder.path().empty()) {
    return fail(streams, kIo, "no private folder can be made",
                {"set XDG_RUNTIME_DIR or TMPDIR to a folder of yours"});
  }
  ViewServer server(session, request.port, request.token.value_or(random_token()), folder);
  const auto address = server.address();
  if (!address) {
    return fail(streams, kIo, fmt::format("port {} is in use", request.port),
                {"choose another, or leave out --port"});
  }
  streams.err << session.state().messages;
  streams.out << *address << std::endl;
  say(streams, "the page is at this address; Ctrl-C ends");
  if (!request.no_open) open_browser(*address, folder);
  std::thread serving([&] { server.run(); });
  while (!interruption.stop()) std::this_thread::sleep_for(std::chrono::milliseconds(50));
  server.stop();
  serving.join();
  return kDone;
}

}  // namespace fathom::cli
