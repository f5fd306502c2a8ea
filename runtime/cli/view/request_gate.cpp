#include "runtime/cli/view/request_gate.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace fathom::cli {
namespace {

constexpr std::size_t kMaxHead = 32 << 10;  // bytes of the first request's head
constexpr std::size_t kBuffer = 64 << 10;   // bytes on their way in one direction
constexpr std::size_t kMaxWaiting = 256;    // connections without a head
constexpr std::size_t kMaxPassed = 64;      // connections that the server has
constexpr std::chrono::seconds kHeadTime(3);
constexpr int kTick = 100;  // milliseconds between looks at the clock

// Reads what is there, at most until `text` has `most` bytes. Returns false at the end of the stream, or on an error.
bool receive(int socket, std::string& text, std::size_t most) {
  while (text.size() < most) {
    char piece[16 << 10];
    const ssize_t count = recv(socket, piece, std::min(sizeof piece, most - text.size()), MSG_DONTWAIT);
    if (count < 0) return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR;
    if (count == 0) return false;
    text.append(piece, static_cast<std::size_t>(count));
  }
  return true;
}

// Sends what fits. Returns false when nobody reads any more.
bool deliver(int socket, std::string& text) {
  while (!text.empty()) {
    const ssize_t count = send(socket, text.data(), text.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
    if (count < 0) return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR;
    text.erase(0, static_cast<std::size_t>(count));
  }
  return true;
}

bool is_request_line(std::string_view line) { return line.ends_with(" HTTP/1.1") || line.ends_with(" HTTP/1.0"); }

}  // namespace

Descriptor::~Descriptor() {
  if (number_ >= 0) close(number_);
}

struct RequestGate::Connection {
  enum class State { Head, Passed, Refused };

  Descriptor client, server;
  State state = State::Head;
  Clock::time_point until = Clock::now() + kHeadTime;  // of the head, and of what comes after a refusal
  std::string to_server, to_client;
  bool client_ended = false, server_ended = false, shut = false;
};

RequestGate::RequestGate(int port) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC | O_NONBLOCK) != 0) return;
  wake_out_ = Descriptor(ends[0]);
  wake_in_ = Descriptor(ends[1]);
  listener_ = Descriptor(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  // Without SO_REUSEPORT another program cannot listen on the same port.
  const int yes = 1;
  setsockopt(listener_.number(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  sockaddr_in place{};
  place.sin_family = AF_INET;
  place.sin_port = htons(static_cast<std::uint16_t>(port));
  place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof place;
  auto* const address = reinterpret_cast<sockaddr*>(&place);
  if (bind(listener_.number(), address, size) != 0 || listen(listener_.number(), SOMAXCONN) != 0) return;
  if (getsockname(listener_.number(), address, &size) == 0) port_ = ntohs(place.sin_port);
}

RequestGate::~RequestGate() = default;

void RequestGate::stop() {
  if (write(wake_in_.number(), "", 1) != 1) return;  // the pipe is full of such wishes
}

void RequestGate::run(const std::string& root, const std::string& server) {
  root_ = root;
  server_ = server;
  std::vector<pollfd> watched;
  while (true) {
    // Poll passes over a negative number.
    watched = {{wake_out_.number(), POLLIN, 0}, {may_accept_ ? listener_.number() : -1, POLLIN, 0}};
    for (const Connection& connection : connections_) watch(connection, watched);
    const int timeout = connections_.empty() && may_accept_ ? -1 : kTick;
    if (poll(watched.data(), watched.size(), timeout) < 0 && errno != EINTR) return;
    if (watched[0].revents != 0) break;
    accept_all();
    connections_.remove_if([this](Connection& connection) { return !advance(connection); });
  }
  connections_.clear();
}

void RequestGate::watch(const Connection& connection, std::vector<pollfd>& watched) {
  // A socket of which nothing is expected is left out: its end would be told again and again.
  const auto add = [&](int socket, bool reads, bool writes) {
    const int events = (reads ? POLLIN : 0) | (writes ? POLLOUT : 0);
    if (events != 0) watched.push_back({socket, static_cast<short>(events), 0});
  };
  add(connection.client.number(), !connection.client_ended && connection.to_server.size() < kBuffer,
      !connection.to_client.empty());
  if (connection.state != Connection::State::Passed) return;
  add(connection.server.number(), !connection.server_ended && connection.to_client.size() < kBuffer,
      !connection.to_server.empty());
}

void RequestGate::accept_all() {
  may_accept_ = true;
  while (true) {
    Descriptor client(accept4(listener_.number(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
    if (client.number() < 0) {
      // Without a free descriptor the connection stays in the queue, and poll would return at once for it.
      const bool is_full = errno == EMFILE || errno == ENFILE || errno == ENOBUFS || errno == ENOMEM;
      if (is_full && drop_oldest(0)) continue;
      may_accept_ = !is_full;
      return;
    }
    const int yes = 1;
    setsockopt(client.number(), IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
    drop_oldest(kMaxWaiting - 1);
    connections_.emplace_back().client = std::move(client);
  }
}

// Makes room for a connection: a stranger who opens many closes their own.
bool RequestGate::drop_oldest(std::size_t most) {
  const auto waits = [](const Connection& connection) { return connection.state != Connection::State::Passed; };
  if (static_cast<std::size_t>(std::count_if(connections_.begin(), connections_.end(), waits)) <= most) return false;
  connections_.erase(std::find_if(connections_.begin(), connections_.end(), waits));
  return true;
}

bool RequestGate::advance(Connection& connection) {
  switch (connection.state) {
    case Connection::State::Head:
      return read_head(connection);
    case Connection::State::Passed:
      return relay(connection);
    case Connection::State::Refused:
      return drain(connection);
  }
  return false;
}

bool RequestGate::read_head(Connection& connection) {
  std::string& head = connection.to_server;
  const bool is_open = receive(connection.client.number(), head, kMaxHead);
  const std::size_t end = head.find("\r\n");
  if (end == head.npos) {
    if (head.size() >= kMaxHead) return refuse(connection, "400 Bad Request", "the request has no end");
    return is_open && Clock::now() < connection.until;
  }
  const std::string_view line = std::string_view(head).substr(0, end);
  if (!is_request_line(line)) return refuse(connection, "400 Bad Request", "this is no request");
  // A wrong token gets the same answer as a missing page.
  const std::size_t blank = line.find(' ');
  if (!line.substr(blank + 1).starts_with(root_)) return refuse(connection, "404 Not Found", "there is nothing here");
  if (head.find("\r\n\r\n") != head.npos) return pass_on(connection);
  if (head.size() >= kMaxHead) {
    return refuse(connection, "431 Request Header Fields Too Large", "the request's head is too large");
  }
  return is_open && Clock::now() < connection.until;
}

bool RequestGate::pass_on(Connection& connection) {
  const auto passed = [](const Connection& other) { return other.state == Connection::State::Passed; };
  Descriptor server(socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  sockaddr_un place{};
  place.sun_family = AF_UNIX;
  std::strncpy(place.sun_path, server_.c_str(), sizeof place.sun_path - 1);
  if (static_cast<std::size_t>(std::count_if(connections_.begin(), connections_.end(), passed)) >= kMaxPassed ||
      connect(server.number(), reinterpret_cast<const sockaddr*>(&place), sizeof place) != 0) {
    return refuse(connection, "503 Service Unavailable", "too many pages are open");
  }
  connection.server = std::move(server);
  connection.state = Connection::State::Passed;
  return relay(connection);
}

bool RequestGate::relay(Connection& connection) {
  const int client = connection.client.number(), server = connection.server.number();
  if (!connection.client_ended) connection.client_ended = !receive(client, connection.to_server, kBuffer);
  if (!deliver(server, connection.to_server)) connection.to_server.clear();  // the server has refused it
  if (connection.client_ended && connection.to_server.empty() && !connection.shut) {
    connection.shut = true;
    shutdown(server, SHUT_WR);
  }
  if (!connection.server_ended) connection.server_ended = !receive(server, connection.to_client, kBuffer);
  if (!deliver(client, connection.to_client)) return false;
  return !connection.server_ended || !connection.to_client.empty();
}

bool RequestGate::refuse(Connection& connection, std::string_view status, std::string_view reason) {
  connection.state = Connection::State::Refused;
  connection.to_client = fmt::format(
      "HTTP/1.1 {}\r\nContent-Type: text/plain; charset=utf-8\r\nX-Content-Type-Options: nosniff\r\n"
      "Connection: close\r\nContent-Length: {}\r\n\r\n{}\n",
      status, reason.size() + 1, reason);
  connection.to_server.clear();
  connection.to_server.shrink_to_fit();
  return drain(connection);
}

// Closing a connection with unread bytes would take back the answer, so what still comes is read for a while.
bool RequestGate::drain(Connection& connection) {
  if (!deliver(connection.client.number(), connection.to_client)) return false;
  if (connection.to_client.empty() && !connection.shut) {
    connection.shut = true;
    shutdown(connection.client.number(), SHUT_WR);
  }
  std::string ignored;
  return receive(connection.client.number(), ignored, kBuffer) && Clock::now() < connection.until;
}

}  // namespace fathom::cli
