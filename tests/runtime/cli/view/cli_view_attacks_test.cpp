// Attacks on the server of `fathom view`: by other sites in the user's browser, and by programs of the machine that
// do not know the token. None gets anything of the scene, and the server answers its own page afterwards.
#include <filesystem>
#include <string>

#include "tests/runtime/cli/view/view_client.h"
#include "tests/support/catch.h"

namespace fathom::test::cli_view_attacks_test {
namespace {

const char* const kSecret =
    "fathom 1\n"
    "object \"</script><script>alert(1)</script>\" sphere(1)\n"
    "camera (position = [0, 0, 4], target = [0, 0, 0])\n"
    "background [1, 1, 1]\n"
    "render (spp = 1)\n";

bool contains(const std::string& text, const std::string& part) { return text.find(part) != text.npos; }

class Attacked {
 public:
  Attacked() {
    folder_.write("scene.fathom", kSecret);
    client_.emplace(folder_, "scene.fathom");
  }
  ViewClient& client() { return *client_; }

  // Expects a refusal with one of the statuses (0: closed without an answer) and without anything of the scene.
  void refused(const std::string& request, std::initializer_list<int> statuses) {
    const Reply reply = client_->exchange(request);
    CAPTURE(request.substr(0, 300), reply.status, reply.body.substr(0, 300));
    CHECK(std::find(statuses.begin(), statuses.end(), reply.status) != statuses.end());
    CHECK_FALSE(contains(reply.body, "sphere"));
    CHECK_FALSE(contains(reply.body, "root:"));
    CHECK(client_->get("scene").status == 200);
  }
  // Returns a request for the scene with these headers.
  std::string scene(const std::string& headers) const {
    return line("GET", client_->root() + "scene") + headers + "\r\n";
  }
  std::string path(const std::string& path) const { return line("GET", path) + client_->own() + "\r\n"; }
  std::string method(const std::string& name) const {
    return line(name, client_->root() + "scene") + client_->own() + "\r\n";
  }
  std::string own() const { return client_->own(); }
  std::string post(const std::string& headers, const std::string& body) const {
    return line("POST", client_->root() + "camera") + client_->own() + headers + "\r\n" + body;
  }

 private:
  static std::string line(const std::string& method, const std::string& path) {
    return method + " " + path + " HTTP/1.1\r\n";
  }
  Folder folder_;
  std::optional<ViewClient> client_;
};

}  // namespace

TEST_CASE("view: other sites and other addresses get nothing", "[cli][view]") {
  Attacked server;
  const std::string port = std::to_string(server.client().port()), close = "Connection: close\r\n";
  const auto host = [&](const std::string& name) { return server.scene("Host: " + name + "\r\n" + close); };
  server.refused(server.scene(close), {400, 403});  // no host
  server.refused(host("attacker.example"), {403});  // DNS rebinding
  server.refused(host("attacker.example:" + port), {403});
  server.refused(host("127.0.0.1"), {403});
  server.refused(host("127.0.0.1:1"), {403});
  server.refused(host("127.0.0.1:" + port + ".attacker.example"), {403});
  server.refused(server.scene("Host: " + server.client().host() + "\r\nHost: attacker.example\r\n" + close), {403});
  const auto from = [&](const std::string& headers) { return server.scene(server.own() + headers); };
  server.refused(from("Origin: http://attacker.example\r\n"), {403});
  server.refused(from("Origin: null\r\n"), {403});
  server.refused(from("Origin: https://127.0.0.1:" + port + "\r\n"), {403});
  server.refused(from("Origin: http://127.0.0.1:" + port + ".attacker.example\r\n"), {403});
  server.refused(from("Sec-Fetch-Site: cross-site\r\n"), {403});
  server.refused(from("Sec-Fetch-Site: same-site\r\n"), {403});
  const Reply own = server.client().exchange(
      from("Origin: http://" + server.client().host() + "\r\nSec-Fetch-Site: same-origin\r\n"));
  CHECK(own.status == 200);
}

TEST_CASE("view: without the token there is nothing, and no file but the page's", "[cli][view]") {
  Attacked server;
  const std::string root = server.client().root();
  server.refused(server.path("/"), {404});
  server.refused(server.path("/scene"), {404});
  server.refused(server.path(root.substr(0, root.size() - 2) + "/scene"), {404});
  server.refused(server.path(root.substr(0, root.size() - 1)), {404});
  server.refused(server.path("/" + std::string(root.size() - 2, '.') + "/scene"), {404});  // as an expression
  server.refused(server.path(root + "../../../../../../etc/passwd"), {404});
  server.refused(server.path(root + "%2e%2e%2f%2e%2e%2f%2e%2e%2fetc/passwd"), {404});
  server.refused(server.path(root + "..\\..\\etc\\passwd"), {404});
  server.refused(server.path(root + "scene.fathom"), {404});
  server.refused(server.path(root + "live_view_js"), {404});  // the dot of live_view.js is a dot
  server.refused(server.path("file:///etc/passwd"), {400, 404});
  server.refused(server.path("http://attacker.example/" + root), {400, 404});
  server.refused(server.path(root + std::string("scene\0.js", 9)), {400, 404});
}

TEST_CASE("view: other methods and contents are refused", "[cli][view]") {
  Attacked server;
  for (const char* name : {"PUT", "DELETE", "PATCH", "OPTIONS", "TRACE", "CONNECT", "BREW"}) {
    server.refused(server.method(name), {400, 405});
  }
  const std::string json = "Content-Type: application/json\r\n",
                    body = R"({"id":1,"width":32,"height":32,"camera":null})";
  const std::string length = "Content-Length: " + std::to_string(body.size()) + "\r\n";
  server.refused(server.post("Content-Type: text/plain\r\n" + length, body), {415});  // as a form of another site
  server.refused(server.post("Content-Type: application/x-www-form-urlencoded\r\n" + length, body), {415});
  server.refused(server.post(length, body), {415});
  for (
      const char* wrong :
      {"", "{", "[]", "7", R"({"id":1,"width":1e9,"height":1e9,"camera":null})",
       R"({"id":1,"width":4096,"height":4096,"camera":null})", R"({"id":1,"width":-5,"height":32,"camera":null})",
       R"({"id":1,"width":32,"height":32,"camera":{}})",
       R"({"id":1,"width":32,"height":32,"camera":{"position":[0,0,1e300],"target":[0,0,0],"up":[0,1,0],"half":[1,1]}})",
       R"({"id":1,"width":32,"height":32,"camera":{"position":[0,0,0],"target":[0,0,0],"up":[0,1,0],"half":[1,1]}})",
       R"({"id":1,"width":32,"height":32,"camera":{"position":[0,0,1],"target":[0,0,0],"up":[0,0,0],"half":[1,1]}})",
       R"({"id":1,"width":32,"height":32,"camera":{"position":[0,0,1],"target":[0,0,0],"up":[0,1,0],"half":"wide"}})"}) {
    CAPTURE(wrong);
    CHECK(server.client().post("camera", wrong).status == 400);
  }
  CHECK(server.client().post("camera", std::string(60000, '[')).status == 400);
  CHECK(server.client().post("secrets", "{}").status == 404);
}

TEST_CASE("view: requests that are too large end", "[cli][view]") {
  Attacked server;
  const std::string json = "Content-Type: application/json\r\n";
  server.refused(server.post(json + "Content-Length: 1000000\r\n", std::string(1000000, ' ')), {0, 400, 413});
  server.refused(server.post(json + "Content-Length: 99999999999999999999\r\n", ""), {0, 400, 413});
  server.refused(server.post(json + "Content-Length: -1\r\n", ""), {0, 400, 413});
  server.refused(server.path(server.client().root() + std::string(100000, 'a')), {0, 400, 414});
  server.refused(server.scene("Host: " + std::string(100000, 'a') + "\r\n"), {0, 400, 403, 431});
  std::string many = server.own();
  for (int i = 0; i < 20000; ++i) many += "X-" + std::to_string(i) + ": a\r\n";
  const Reply reply = server.client().exchange(server.scene(many));
  CHECK((reply.status == 200 || reply.status == 0 || reply.status >= 400));  // no harm either way
  server.refused(server.path("/?" + std::string(7000, '&')), {0, 400, 404});
  // The library reads ranges by a regular expression, which recurses.
  const Reply ranges =
      server.client().exchange(server.scene(server.own() + "Range: bytes=" + std::string(7000, '1') + "\r\n"));
  CHECK(ranges.status != 500);
  server.refused(std::string(100000, '\0'), {0, 400});
  server.refused("\x16\x03\x01 no HTTP at all\r\n\r\n", {0, 400});
}

TEST_CASE("view: slow clients and many streams do not hold the server", "[cli][view]") {
  Attacked server;
  std::vector<int> slow;
  for (int i = 0; i < 12; ++i) {
    slow.push_back(server.client().open());
    ViewClient::send(slow.back(), "GET " + server.client().root() + "scene HTTP/1.1\r\nHost: 127");
  }
  CHECK(server.client().get("scene").status == 200);
  for (const int socket : slow) {
    CHECK(ViewClient::receive(socket).status != 200);
    close(socket);
  }
  CHECK(server.client().end() == 0);
}

TEST_CASE("view: streams have a limit", "[cli][view]") {
  Attacked server;
  std::vector<int> streams;
  for (int i = 0; i < 6; ++i) {
    streams.push_back(server.client().open());
    ViewClient::send(streams.back(), "GET " + server.client().root() + "events HTTP/1.1\r\n" + server.own() + "\r\n");
    char first = 0;
    CHECK(recv(streams.back(), &first, 1, 0) == 1);
  }
  CHECK(server.client().get("events").status == 429);
  for (const int socket : streams) close(socket);
  CHECK(server.client().get("scene").status == 200);
  CHECK(server.client().end() == 0);
}

// The library keeps every line of a head that it has read, however many there are.
// The sanitizers keep what is freed.
TEST_CASE("view: strangers cannot fill the memory", "[cli][view][released]") {
  Attacked server;
  const int before = server.client().max_memory();
  const std::string line = "X-a: " + std::string(8000, 'a') + "\r\n";
  std::string flood;
  while (flood.size() < (64 << 20)) flood += line;
  const std::string without_end(64 << 20, 'a'), wrong = "GET /a HTTP/1.1\r\nHost: x\r\n";
  for (const std::string& bytes : {wrong + flood, "GET /" + without_end, "GET /a" + without_end + " HTTP/1.1\r\n"}) {
    server.refused(bytes, {0, 400, 404});
  }
  // Not even with the token.
  server.refused(server.scene(server.own() + flood), {0, 431});
  CHECK(server.client().max_memory() - before < 30 << 10);
}

// Each sends a byte now and then, more connections than there are threads and places for them.
TEST_CASE("view: strangers cannot hold the threads", "[cli][view]") {
  Attacked server;
  std::vector<int> slow;
  for (int i = 0; i < 300; ++i) slow.push_back(server.client().open());
  for (int round = 0; round < 5; ++round) {
    for (const int socket : slow) ViewClient::send(socket, round == 0 ? "GET /x HTTP/1.1" : "a");
    CHECK(server.client().get("scene").status == 200);
  }
  // All of them end, though they go on.
  for (const int socket : slow) {
    char byte = 0;
    while (recv(socket, &byte, 1, MSG_DONTWAIT) < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) {
      ViewClient::send(socket, "a");
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    close(socket);
  }
  CHECK(server.client().get("scene").status == 200);
}

// Each connection that found no file descriptor woke the server again at once, and its own page got no answer.
TEST_CASE("view: strangers cannot take all file descriptors", "[cli][view]") {
  Attacked server;
  CHECK(server.client().get("scene").status == 200);
  server.client().limit_files(48);
  std::vector<int> idle;
  for (int i = 0; i < 200; ++i) {
    idle.push_back(server.client().open());
    ViewClient::send(idle.back(), "GET /x HTTP/1.1");
  }
  CHECK(server.client().get("scene").status == 200);
  for (const int socket : idle) close(socket);
}

// Any user of the machine sees the arguments of all programs.
TEST_CASE("view: the token is in no arguments", "[cli][view]") {
  const Folder folder;
  folder.write("scene.fathom", kSecret);
  folder.write("xdg-open",
               "#!/bin/sh\ncp \"$1\" page.new\nstat -c %a \"$(dirname \"$1\")\" > mode\n"
               "echo \"$1\" > name\nmv page.new page\n");
  std::filesystem::permissions(folder.path() / "xdg-open", std::filesystem::perms::owner_all);
  const std::string token = "abcdefghijklmnop1234";
  ViewClient client(folder, "scene.fathom", {"--token", token},
                    {"DISPLAY=:0", "PATH=" + folder.path().string() + ":" + std::getenv("PATH")});
  CHECK(client.root() == "/" + token + "/");
  CHECK(contains(client.process("cmdline"), "--token"));
  CHECK_FALSE(contains(client.process("cmdline"), token));
  while (!std::filesystem::exists(folder.path() / "page")) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  CHECK(contains(folder.read("page"), "url=http://" + client.host() + client.root() + "\""));
  CHECK_FALSE(contains(folder.read("name"), token));
  CHECK(folder.read("mode") == "700\n");
  // A browser says that this page comes from elsewhere, and only a page may.
  const std::string elsewhere = client.own() + "Sec-Fetch-Site: cross-site\r\nSec-Fetch-Mode: navigate\r\n\r\n";
  CHECK(client.exchange("GET " + client.root() + " HTTP/1.1\r\n" + elsewhere).status == 200);
  CHECK(client.exchange("GET " + client.root() + "scene HTTP/1.1\r\n" + elsewhere).status == 403);
  const std::string file = folder.read("name").substr(0, folder.read("name").size() - 1);
  CHECK(std::filesystem::exists(file));
  CHECK(client.end() == 0);
  CHECK_FALSE(std::filesystem::exists(file));
}

TEST_CASE("view: names of a scene stay text", "[cli][view]") {
  Attacked server;
  const Reply scene = server.client().get("scene"), page = server.client().get("");
  CHECK(contains(scene.head, "Content-Type: application/json"));
  CHECK(contains(scene.head, "X-Content-Type-Options: nosniff"));
  CHECK(contains(page.head, "Content-Security-Policy: default-src 'none'; script-src 'self'; style-src 'self'"));
  CHECK(contains(page.head, "frame-ancestors 'none'"));
  CHECK(contains(page.head, "Referrer-Policy: no-referrer"));
  CHECK(page.status == 200);
  CHECK_FALSE(contains(page.body, "alert(1)"));
  CHECK_FALSE(contains(page.body, "<script>"));  // all scripts are files
}

}  // namespace fathom::test::cli_view_attacks_test
