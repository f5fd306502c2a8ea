#include "runtime/cli/view/view_server.h"

#include <httplib.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <thread>
#include <utility>

#include "runtime/cli/view/page_files.h"
#include "runtime/cli/view/request_gate.h"
#include "runtime/cli/view/request_guard.h"

namespace fathom::cli {
namespace {

constexpr int kThreads = 24;                // of the server; each stream of events occupies one
constexpr int kMaxStreams = 6;              // of events
constexpr std::size_t kMaxBody = 64 << 10;  // of a request, bytes
constexpr int kPatience = 3;                // for a client that sends or reads nothing, seconds
constexpr double kPing = 5;                 // seconds between events at most

constexpr std::pair<const char*, const char*> kHeaders[] = {
    {"Content-Security-Policy",
     "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; connect-src 'self'; "
     "base-uri 'none'; form-action 'none'; frame-ancestors 'none'"},
    {"X-Content-Type-Options", "nosniff"},
    {"Referrer-Policy", "no-referrer"},
    {"Cross-Origin-Resource-Policy", "same-origin"},
    {"Cross-Origin-Opener-Policy", "same-origin"},
    {"Cache-Control", "no-store"},
};

constexpr std::array<std::pair<std::string_view, const char*>, 3> kTypes = {{
    {".html", "text/html; charset=utf-8"},
    {".css", "text/css; charset=utf-8"},
    {".js", "text/javascript; charset=utf-8"},
}};

const char* type_of(std::string_view name) {
  for (const auto& [ending, type] : kTypes) {
    if (name.ends_with(ending)) return type;
  }
  return "application/octet-stream";
}

RequestFacts facts_of(const httplib::Request& request) {
  // Two headers of one name would let a proxy and this server read different ones.
  const auto only = [&](const char* name) {
    return request.get_header_value_count(name) > 1 ? "?" : request.get_header_value(name);
  };
  return {request.method,         request.path,           only("Host"),        only("Origin"),
          only("Sec-Fetch-Site"), only("Sec-Fetch-Mode"), only("Content-Type")};
}

void refuse(httplib::Response& response, const Refusal& refusal) {
  response.status = refusal.status;
  response.set_content(std::string(refusal.reason) + "\n", "text/plain; charset=utf-8");
}

// Sends a body in pieces, because the library compresses whole bodies with Brotli at the highest quality, which takes
// 40 ms for showcase.json.
void send(httplib::Response& response, std::string body, const std::string& type) {
  if (body.empty()) return response.set_content("", type);
  const std::size_t size = body.size();
  response.set_content_provider(
      size, type, [body = std::move(body)](std::size_t at, std::size_t length, httplib::DataSink& sink) {
        return sink.write(body.data() + at, length);
      });
}

void reply(httplib::Response& response, Answer answer) {
  response.status = answer.status;
  if (answer.picture > 0) response.set_header("X-Picture", std::to_string(answer.picture));
  if (answer.status != 204) send(response, std::move(answer.body), answer.type);
}

}  // namespace

struct ViewServer::Server {
  ViewSession& session;
  RequestGate gate;
  const std::string socket;  // where the gate passes requests on
  httplib::Server http;
  std::optional<RequestGuard> guard;  // none if the port is not free
  std::atomic<int> streams = 0;

  Server(ViewSession& viewed, int port, const std::string& token, const PrivateFolder& folder)
      : session(viewed), gate(port), socket(folder.file("http")) {
    http.set_address_family(AF_UNIX);
    http.set_socket_options([](socket_t) {});
    constexpr int kAnyPort = 80;  // a Unix socket has none, and the library wants a number
    if (gate.port() == 0 || !http.bind_to_port(socket, kAnyPort)) return;
    guard.emplace(gate.port(), token);
    set_limits();
    add_routes();
  }

  void set_limits() {
    http.new_task_queue = [] { return new httplib::ThreadPool(kThreads); };
    http.set_payload_max_length(kMaxBody);
    http.set_read_timeout(kPatience);
    http.set_write_timeout(kPatience);
    http.set_keep_alive_timeout(kPatience);
    httplib::Headers headers;
    for (const auto& [name, value] : kHeaders) headers.emplace(name, value);
    http.set_default_headers(headers);
    http.set_exception_handler([](const auto&, httplib::Response& response, const std::exception_ptr&) {
      refuse(response, {500, "the request cannot be answered"});
    });
    http.set_pre_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
      const std::optional<Refusal> refusal = guard->refuse(facts_of(request));
      if (!refusal) return httplib::Server::HandlerResponse::Unhandled;
      refuse(response, *refusal);
      return httplib::Server::HandlerResponse::Handled;
    });
  }

  void add_routes() {
    for (const compiler::EmbeddedFile& file : page_files()) {
      const std::string name = file.name == "index.html" ? "" : std::string(file.name);
      std::string path = guard->root() + name;
      http.Get(escape(path), [file](const httplib::Request&, httplib::Response& response) {
        send(response, std::string(file.text), type_of(file.name));
      });
    }
    http.Get(guard->root() + "events",
             [this](const httplib::Request&, httplib::Response& response) { stream_events(response); });
    for (const char* name : {"scene", "picture", "pixel", "pixels", "listing", "program", "exactness"}) {
      http.Get(guard->root() + name, [this, name](const httplib::Request& request, httplib::Response& response) {
        reply(response, session.get(name, [&](const char* parameter) { return request.get_param_value(parameter); }));
      });
    }
    for (const char* name : {"camera", "parameters", "keep"}) {
      http.Post(guard->root() + name, [this, name](const httplib::Request& request, httplib::Response& response) {
        reply(response, session.post(name, request.body));
      });
    }
  }

  // The library takes paths as regular expressions.
  static std::string escape(const std::string& path) {
    std::string pattern;
    for (const char c : path) pattern += c == '.' ? std::string("\\.") : std::string(1, c);
    return pattern;
  }

  void stream_events(httplib::Response& response) {
    if (streams.fetch_add(1) >= kMaxStreams) {
      --streams;
      return refuse(response, {429, "too many pages are open"});
    }
    response.set_chunked_content_provider(
        "text/event-stream",
        [this, seen = ViewSession::Seen()](std::size_t, httplib::DataSink& sink) mutable {
          if (session.is_over()) return false;
          const std::string events = session.wait_for_events(seen, kPing);
          return sink.write(events.data(), events.size());
        },
        [this](bool) { --streams; });
  }
};

ViewServer::ViewServer(ViewSession& session, int port, const std::string& token, const PrivateFolder& folder)
    : server_(std::make_unique<Server>(session, port, token, folder)) {}

ViewServer::~ViewServer() = default;

std::optional<std::string> ViewServer::address() const {
  return server_->guard ? std::optional(server_->guard->address()) : std::nullopt;
}

void ViewServer::run() {
  std::atomic<bool> has_ended = false;
  std::thread answering([&] {
    server_->http.listen_after_bind();
    has_ended = true;
  });
  server_->gate.run(server_->guard->root(), server_->socket);
  // Before it runs, the server would forget that it is to stop.
  while (!server_->http.is_running() && !has_ended) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  server_->http.stop();
  answering.join();
}

void ViewServer::stop() {
  server_->session.stop();
  server_->gate.stop();
}

}  // namespace fathom::cli
