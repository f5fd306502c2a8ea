// Starts `fathom view` in a folder, and speaks HTTP with it, well-formed or not.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/catch.h"
#include "tests/support/program.h"

namespace fathom::test {

struct Reply {
  int status = 0;  // 0: the server closed the connection without an answer
  std::string head, body;
};

class ViewClient {
 public:
  // `desktop`: variables of the environment, NAME=VALUE, with which the program opens a browser.
  ViewClient(const Folder& folder, const std::string& scene, const std::vector<std::string>& more = {},
             const std::vector<std::string>& desktop = {}) {
    int ends[2];
    REQUIRE(pipe(ends) == 0);
    child_ = fork();
    REQUIRE(child_ >= 0);
    if (child_ == 0) exec(folder, scene, more, desktop, ends);
    close(ends[1]);
    std::string address;
    char c = 0;
    while (::read(ends[0], &c, 1) == 1 && c != '\n') address += c;
    close(ends[0]);
    const std::size_t colon = address.find(':', 6), slash = address.find('/', 8);
    REQUIRE(slash != std::string::npos);
    port_ = std::stoi(address.substr(colon + 1));
    root_ = address.substr(slash);
  }
  ~ViewClient() {
    if (child_ > 0) end();
  }
  ViewClient(const ViewClient&) = delete;
  ViewClient& operator=(const ViewClient&) = delete;

  int port() const { return port_; }
  // Returns a file of the server's process, as "cmdline".
  std::string process(const std::string& name) const {
    std::ifstream file("/proc/" + std::to_string(child_) + "/" + name);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  // Returns the largest memory that the server has had, in KiB.
  int max_memory() const {
    const std::string status = process("status");
    const std::size_t at = status.find("VmHWM:");
    REQUIRE(at != std::string::npos);
    return std::stoi(status.substr(at + 6));
  }
  // Bounds the files that the server may have open from here on.
  void limit_files(unsigned most) const {
    const rlimit limit{most, most};
    REQUIRE(prlimit(child_, RLIMIT_NOFILE, &limit, nullptr) == 0);
  }
  const std::string& root() const { return root_; }  // "/TOKEN/"
  std::string host() const { return "127.0.0.1:" + std::to_string(port_); }

  // Ends the server by a signal and returns its exit code.
  int end() {
    int status = 0;
    kill(std::exchange(child_, 0), SIGTERM);
    wait(&status);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  Reply get(const std::string& name) const {
    return exchange("GET " + root_ + name + " HTTP/1.1\r\n" + own() + "\r\n");
  }
  nlohmann::json json(const std::string& name) const {
    const Reply reply = get(name);
    CAPTURE(name, reply.body);
    CHECK(reply.status == 200);
    return nlohmann::json::parse(reply.body, nullptr, false);
  }
  Reply post(const std::string& name, const std::string& body) const {
    return exchange("POST " + root_ + name + " HTTP/1.1\r\n" + own() + "Content-Type: application/json\r\n" +
                    "Content-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body);
  }

  // Sends bytes as they are, and returns what comes back until the server closes the connection.
  Reply exchange(const std::string& bytes) const {
    const int socket = open();
    send(socket, bytes);
    Reply reply = receive(socket);
    close(socket);
    return reply;
  }
  int open() const {
    const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in place{};
    place.sin_family = AF_INET;
    place.sin_port = htons(static_cast<std::uint16_t>(port_));
    place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    REQUIRE(connect(socket, reinterpret_cast<sockaddr*>(&place), sizeof place) == 0);
    const timeval patience{20, 0};
    setsockopt(socket, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    setsockopt(socket, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
    return socket;
  }
  static void send(int socket, const std::string& bytes) {
    for (std::size_t sent = 0; sent < bytes.size();) {
      const ssize_t count = ::send(socket, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
      if (count <= 0) return;  // the server has closed the connection
      sent += static_cast<std::size_t>(count);
    }
  }
  static Reply receive(int socket) {
    std::string text;
    char buffer[4096];
    for (ssize_t count = 0; (count = recv(socket, buffer, sizeof buffer, 0)) > 0;) {
      text.append(buffer, static_cast<std::size_t>(count));
    }
    const std::size_t middle = text.find("\r\n\r\n");
    if (!text.starts_with("HTTP/1.1 ") || middle == std::string::npos) return {};
    return {std::stoi(text.substr(9, 3)), text.substr(0, middle), text.substr(middle + 4)};
  }
  std::string own() const { return "Host: " + host() + "\r\nConnection: close\r\n"; }

  // Waits until the answer to `name` fulfils a condition, at most 20 seconds. Returns the last answer.
  template <class Condition>
  nlohmann::json wait_for(const std::string& name, const Condition& condition) const {
    nlohmann::json answer;
    for (int i = 0; i < 1000; ++i) {
      answer = json(name);
      if (condition(answer)) return answer;
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    FAIL("no such answer: " << answer.dump());
    return answer;
  }

 private:
  [[noreturn]] static void exec(const Folder& folder, const std::string& scene, const std::vector<std::string>& more,
                                std::vector<std::string> desktop, const int (&ends)[2]) {
    dup2(ends[1], STDOUT_FILENO);
    close(ends[0]), close(ends[1]);
    std::string program = program_path();
    std::vector<std::string> words = {program, "view", scene, "--threads", "2", "-q"};
    if (desktop.empty()) words.push_back("--no-open");
    for (std::string& variable : desktop) putenv(variable.data());
    words.insert(words.end(), more.begin(), more.end());
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    if (chdir(folder.path().c_str()) == 0) execv(program.c_str(), arguments.data());
    _exit(127);
  }
  static void wait(int* status) {
    while (::wait(status) < 0 && errno == EINTR) continue;
  }

  pid_t child_ = 0;
  int port_ = 0;
  std::string root_;
};

}  // namespace fathom::test
