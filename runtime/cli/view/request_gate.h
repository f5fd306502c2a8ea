// The gate before the viewer's server: listens on the loopback interface and passes on the connections whose first
// request names the token. Everything else is answered here, and costs no more than its place in a list.
//
// cpp-httplib reads a head line by line into the memory of a thread: as many lines as there are, and for as long as a
// byte comes every few seconds. The gate reads heads of at most 32 KiB, all of them in one thread, and gives each 3
// seconds. It passes bytes on as they are, to the server's Unix socket.
// Tested by: tests/runtime/cli/view/cli_view_attacks_test.cpp
#pragma once

#include <chrono>
#include <cstddef>
#include <list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

struct pollfd;

namespace fathom::cli {

// An open file, closed at the end; -1 for none.
class Descriptor {
 public:
  explicit Descriptor(int number = -1) : number_(number) {}
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  ~Descriptor();
  int number() const { return number_; }

 private:
  int number_;
};

class RequestGate {
 public:
  // Listens on `port` of 127.0.0.1, 0 for any free one.
  explicit RequestGate(int port);
  ~RequestGate();

  // The port; 0 if it is not free.
  int port() const { return port_; }
  // Passes connections to the Unix socket `server` until stop(), which another thread may call. `root`: what the
  // paths of requests begin with.
  void run(const std::string& root, const std::string& server);
  void stop();

 private:
  using Clock = std::chrono::steady_clock;
  struct Connection;

  void accept_all();
  // Drops the oldest connection that waits if more than `most` do. Returns false if not.
  bool drop_oldest(std::size_t most);
  // The steps of a connection. They return false when it ends.
  bool advance(Connection& connection);
  bool read_head(Connection& connection);
  bool pass_on(Connection& connection);
  bool relay(Connection& connection);
  bool refuse(Connection& connection, std::string_view status, std::string_view reason);
  bool drain(Connection& connection);
  static void watch(const Connection& connection, std::vector<pollfd>& watched);

  int port_ = 0;
  bool may_accept_ = true;  // false: no descriptor was free, and the listener is left alone for a tick
  Descriptor listener_, wake_in_, wake_out_;
  std::string root_, server_;
  std::list<Connection> connections_;  // the oldest first
};

}  // namespace fathom::cli
