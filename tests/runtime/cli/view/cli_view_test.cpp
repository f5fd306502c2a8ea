// End-to-end tests of `fathom view`, without a browser: tests/suites/browser has the page's.
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "runtime/image/image_png.h"
#include "tests/runtime/cli/view/view_client.h"
#include "tests/support/catch.h"

namespace fathom::test::cli_view_test {
namespace {

using nlohmann::json;

bool contains(const std::string& text, const std::string& part) { return text.find(part) != text.npos; }

const char* const kText =
    "fathom 1\n"
    "\n"
    "param r(min = 0.1, max = 2, doc = \"of the ball\") = 0.5 // metres\n"
    "param twice = 2 * r\n"
    "object \"ball\" sphere(r)\n"
    "object \"floor\" box([4, 0.1, 4]).translate([0, -twice, 0])\n"
    "camera (position = [0, 0, 4], target = [0, 0, 0])\n"
    "background [1, 1, 1]\n"
    "render (spp = 4)\n";

const char* const kOwnCamera = R"({"id": 1, "width": 32, "height": 16, "camera": null})";

// Waits until the picture has all of its samples, as the stream of events tells.
void wait_until_done(const ViewClient& client) {
  const int socket = client.open();
  ViewClient::send(socket, "GET " + client.root() + "events HTTP/1.1\r\n" + client.own() + "\r\n");
  std::string text;
  char buffer[4096];
  while (!contains(text, "\"done\":true")) {
    const ssize_t count = recv(socket, buffer, sizeof buffer, 0);
    REQUIRE(count > 0);
    text.append(buffer, static_cast<std::size_t>(count));
  }
  close(socket);
  CHECK(contains(text, "event: scene\ndata: {\"good\":true"));
}

}  // namespace

TEST_CASE("view: the true picture has the bits of a render", "[cli][view]") {
  const Folder folder;
  ViewClient client(folder, "ball.json");
  CHECK(client.get("picture").status == 204);
  CHECK(client.post("camera", kOwnCamera).status == 204);
  wait_until_done(client);
  REQUIRE(folder.run("render ball.json --uniform -o ball.png -a -n").code == 0);
  for (const auto& [layer, file] :
       {std::pair("color&denoise=off", "ball.png"), {"albedo", "ball-albedo.png"}, {"normal", "ball-normal.png"}}) {
    CHECK(client.get(std::string("picture?layer=") + layer).body == folder.read(file));
  }
  CHECK(png_size(client.get("picture?denoise=on").body) == std::pair(32, 16));
  CHECK(client.get("picture?exposure=-2&denoise=off").body != folder.read("ball.png"));
  CHECK(png_size(client.get("picture?layer=evaluations").body) == std::pair(32, 16));
  CHECK(client.get("picture?layer=sound").status == 400);
  CHECK(client.end() == 0);
}

TEST_CASE("view: a moved camera sees what a render with this camera sees", "[cli][view]") {
  const Folder folder;
  ViewClient client(folder, "ball.json");
  CHECK(client
            .post("camera", R"({"id": 2, "width": 40, "height": 40, "camera": {"position": [3, 0, 0],
      "target": [0, 0, 0], "up": [0, 1, 0], "half": [0.5, 0.5], "orthographic": false}})")
            .status == 204);
  wait_until_done(client);
  const std::string fov = std::to_string(2 * std::atan(0.5));
  REQUIRE(folder
              .run("render ball.json --uniform --size 40x40 --position 3,0,0 --look-at 0,0,0 --fov " + fov +
                   " -o side.png -d")
              .code == 0);
  CHECK(png_size(client.get("picture?layer=depth").body) == std::pair(40, 40));
  const json pixel = client.json("pixel?x=20&y=20");
  CHECK(pixel["hit"] == true);
  CHECK(pixel["position"][0].get<double>() == Approx(0.5).margin(1e-6));
  CHECK(pixel["distance"].get<double>() == Approx(2.5).margin(1e-6));
}

TEST_CASE("view: a pixel tells its object, its place and the way there", "[cli][view]") {
  const Folder folder;
  folder.write("scene.fathom", kText);
  ViewClient client(folder, "scene.fathom");
  REQUIRE(client.post("camera", kOwnCamera).status == 204);
  const json hit = client.json("pixel?x=16&y=8");
  CHECK(hit["object"] == "ball");
  CHECK(hit["line"] == 5);
  CHECK(hit["normal"][2].get<double>() == Approx(1));
  CHECK(hit["distance"].get<double>() == Approx(3.5));
  REQUIRE(hit["steps"].size() >= 2);
  CHECK(hit["steps"].back()[0].get<double>() == Approx(3.5));
  CHECK(std::abs(hit["steps"].back()[1].get<double>()) < 1e-6);
  CHECK(contains(hit["certificate"].get<std::string>(), "proved"));
  const json miss = client.json("pixel?x=0&y=0");
  CHECK(miss["hit"] == false);
  CHECK(client.get("pixel?x=99&y=0").status == 400);
  CHECK(client.get("pixel?x=nan&y=0").status == 400);
  CHECK(client.json("exactness").size() == 1);

  // The ball's instructions matter on the ball and not on the floor.
  const json program = client.json("program");
  int masks = 0;
  for (const json& line : program["code"]) {
    if (line["op"] != "sphere") continue;
    const std::string mask = client.get("pixels?offset=" + std::to_string(line["offset"].get<int>())).body;
    const auto read = runtime::decode_png({reinterpret_cast<const std::uint8_t*>(mask.data()), mask.size()}, 1e6);
    const auto& image = std::get<runtime::PngImage>(read);
    const auto pixel = [&](int x, int y) { return image.samples[static_cast<std::size_t>(3 * (32 * y + x))]; };
    CHECK(pixel(16, 8) == 0xffff);
    CHECK(pixel(1, 15) == 0);
    ++masks;
  }
  CHECK(masks == 1);
  CHECK(client.get("pixels?offset=100000").status == 400);
  CHECK(contains(client.get("listing?kind=run&at=0,0,1").body, "; at 0 0 1"));
  CHECK(contains(client.get("listing?kind=region&at=0,0,1").body, "; whole:"));
  CHECK(contains(client.get("listing?kind=passes").body, "; pass "));
  CHECK(contains(client.get("listing?kind=graph").body, "sphere"));
  CHECK(contains(client.get("listing?kind=check").body, "no errors"));
  CHECK(client.get("listing?kind=run").status == 400);
  CHECK(client.get("listing?kind=secrets").status == 400);
}

TEST_CASE("view: a saved file shows; a mistake keeps the last good scene", "[cli][view]") {
  const Folder folder;
  folder.write("scene.fathom", kText);
  ViewClient client(folder, "scene.fathom");
  const json first = client.json("scene");
  CHECK(first["good"] == true);
  CHECK(first["messages"] == "");
  const std::string shader = first["live"]["shader"];
  std::string text = kText;
  text.replace(text.find("sphere"), 6, "spere");
  folder.write("scene.fathom", text);
  const json bad = client.wait_for("scene", [&](const json& scene) { return scene["text"] == text; });
  CHECK(bad["good"] == false);
  CHECK(contains(bad["messages"], "did you mean `sphere`?"));
  CHECK(contains(bad["messages"], "^^^^^"));
  CHECK(bad["text"] == text);
  CHECK(bad["live"]["shader"] == shader);
  text.replace(text.find("spere"), 5, "torus");
  text.replace(text.find("(r)"), 3, "(r, 0.1)");
  folder.write("scene.fathom", text);
  const json mended = client.wait_for("scene", [&](const json& scene) { return scene["text"] == text; });
  CHECK(mended["good"] == true);
  CHECK(mended["messages"] == "");
  CHECK(mended["live"]["shader"] != shader);
}

TEST_CASE("view: parameters can be set, and written to the file", "[cli][view]") {
  const Folder folder;
  folder.write("scene.fathom", kText);
  ViewClient client(folder, "scene.fathom");
  const json first = client.json("scene");
  REQUIRE(first["parameters"].size() == 2);
  CHECK(first["parameters"][0] == json::parse(R"({"name": "r", "default": 0.5, "value": 0.5, "min": 0.1, "max": 2.0,
                                                  "doc": "of the ball"})"));
  CHECK(client.post("parameters", R"({"values": {"r": 0.75}})").status == 204);
  const json set = client.wait_for("scene", [](const json& s) { return s["parameters"][0]["value"] == 0.75; });
  CHECK(set["parameters"][1]["value"] == 1.5);
  CHECK(set["parameters"][0]["default"] == 0.5);
  CHECK(set["text"] == kText);
  CHECK(client.post("parameters", R"({"values": {"r": 3}})").status == 400);
  CHECK(client.post("parameters", R"({"values": {"q": 3}})").status == 400);
  CHECK(client.post("parameters", R"({"values": {"r": "3"}})").status == 400);
  CHECK(client.post("parameters", "{").status == 400);
  CHECK(client.post("keep", R"({"values": {"twice": 1}})").status == 409);
  CHECK(folder.read("scene.fathom") == kText);
  CHECK(client.post("keep", R"({"values": {"r": 0.75}})").status == 200);
  CHECK(contains(folder.read("scene.fathom"), "\"of the ball\") = 0.75 // metres\nparam twice = 2 * r\n"));
}

TEST_CASE("view: parameters of JSON are written where they are", "[cli][view]") {
  const Folder folder;
  const std::string text = R"({"version": 1, "params": {"r": {"default": -1e-1, "doc": "d"}, "s": 2},
  "objects": [{"type": "sphere", "radius": "s+r"}]})";
  folder.write("scene.json", text);
  ViewClient client(folder, "scene.json");
  CHECK(client.post("keep", R"({"values": {"s": 3, "r": -0.5}})").status == 200);
  CHECK(contains(folder.read("scene.json"), R"({"r": {"default": -0.5, "doc": "d"}, "s": 3},)"));
}

// A signal before the server ran was forgotten, and the program could not be ended any more but by force.
TEST_CASE("view: a signal while the scene is read ends the program", "[cli][view]") {
  const Folder folder;
  std::string slow = "fathom 1\n";
  for (int i = 0; i < 40; ++i) {
    slow += "object expression(\"noise(x*" + std::to_string(i + 2) + ", y, z) - 0.3\", half_size = [1, 1, 1])\n";
  }
  folder.write("slow.fathom", slow);
  for (const char* seconds : {"0.2", "0.6", "1"}) {
    INFO(seconds);
    // 137: timeout had to kill it
    const std::string end =
        std::string("timeout -k 20 ") + seconds + " \"$fathom\" view slow.fathom --no-open --port 0";
    CHECK(folder.run_script(end + " > address; echo $?").out == "124\n");
  }
}

TEST_CASE("view: what cannot be shown is a matter of usage", "[cli][view]") {
  const Folder folder;
  CHECK(folder.run("view -").code == 2);
  CHECK(folder.run("view none.fathom").code == 74);
  CHECK(folder.run("view ball.json --token short").code == 2);
  CHECK(folder.run("view ball.json --port 70000").code == 2);
  const ViewClient client(folder, "ball.json");
  const Result second = folder.run("view ball.json --no-open --port " + std::to_string(client.port()));
  CHECK(second.code == 74);
  CHECK(contains(second.err, "is in use"));
}

}  // namespace fathom::test::cli_view_test
