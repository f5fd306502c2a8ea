// The viewer's server: answers the requests of its own page over HTTP, on the loopback interface only.
// Tested by: tests/runtime/cli/view/cli_view_attacks_test.cpp
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "runtime/cli/view/private_folder.h"
#include "runtime/cli/view/view_session.h"

namespace fathom::cli {

class ViewServer {
 public:
  // Binds the server to `port`, 0 for any free one. `token`: see request_guard.h. `folder` gets the server's socket.
  ViewServer(ViewSession& session, int port, const std::string& token, const PrivateFolder& folder);
  ~ViewServer();
  ViewServer(const ViewServer&) = delete;
  ViewServer& operator=(const ViewServer&) = delete;

  // Returns the address of the page, or nullopt if the port is not free or the folder has no place for a socket.
  std::optional<std::string> address() const;
  // Answers requests until stop(), which another thread calls.
  void run();
  void stop();

 private:
  struct Server;
  std::unique_ptr<Server> server_;
};

}  // namespace fathom::cli
