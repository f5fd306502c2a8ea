// Film files: a written file is read back, and a damaged, truncated or forged file is refused.
#include "runtime/film/film_file.h"

#include <chrono>
#include <cstring>
#include <fstream>
#include <sstream>

#include "runtime/render.h"
#include "tests/runtime/scenes.h"
#include "tests/support/catch.h"
#include "tests/support/temporary_folder.h"
#include "vm/encoding/digest.h"

namespace fathom::runtime::film_file_test {
namespace {

FilmFile small_file(FilmLayers layers, bool adaptive = false) {
  const auto scene = scene_of(R"("background": [1, 1, 1], "objects": [{"type": "sphere", "radius": 1}])");
  RenderOptions options;
  options.width = 7;
  options.height = 5;
  options.spp = 8;
  if (adaptive) options.noise_threshold = 0.1;
  options.layers = layers;
  options.threads = 1;
  const RenderResult result = render(scene, options);
  const Film& film = result.film;
  return {{{{"spp", "8"}, {"seed", "0"}},
           {{"text", std::string("agx")},
            {"number", 0.5f},
            {"whole", -3},
            {"list", std::vector<std::string>{"a", ""}},
            {"matrix", Matrix4{1, 2, 3}}},
           7,
           5,
           {0, 8},
           {1, 2, 3}},
          {film.area(), film.layers(), film.stages()},
          result};
}

std::string bytes_of(const std::string& path) {
  std::stringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

void write_bytes(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

FilmLayers every_layer() {
  FilmLayers layers = kAllLayers;
  layers.halves = true;
  return layers;
}

TEST_CASE("film files: what is written is read back, with every layer or none, of one stage or four", "[film]") {
  const test::TemporaryFolder folder;
  for (const FilmLayers layers : {FilmLayers{}, every_layer(), FilmLayers{.first_hit = false, .halves = true}}) {
    for (const bool adaptive : {false, true}) {
      const FilmFile wrote = small_file(layers, adaptive);
      REQUIRE_FALSE(write_film(wrote.header, wrote.render, folder.file("a.film")));
      const auto read = read_film(folder.file("a.film"));
      REQUIRE(std::holds_alternative<FilmFile>(read));
      const FilmFile& file = std::get<FilmFile>(read);
      CHECK(file.header.identity == wrote.header.identity);
      CHECK(file.header.attributes == wrote.header.attributes);
      CHECK(file.header.samples == wrote.header.samples);
      CHECK(file.header.origin == wrote.header.origin);
      CHECK(file.shape == wrote.shape);
      CHECK(file.render.covered == wrote.render.covered);
      CHECK(file.render.film.hash() == wrote.render.film.hash());
      CHECK(file.render.film.means(3, 2).instructions == wrote.render.film.means(3, 2).instructions);
      REQUIRE_FALSE(write_film(file.header, file.render, folder.file("b.film")));
      CHECK(bytes_of(folder.file("b.film")) == bytes_of(folder.file("a.film")));
      const auto head = read_film_header(folder.file("a.film"));
      CHECK(std::get<FilmFile>(head).shape == wrote.shape);
    }
  }
}

TEST_CASE("film files: every flipped bit and every truncation is found", "[film]") {
  const test::TemporaryFolder folder;
  const FilmFile wrote = small_file(every_layer(), true);
  const std::string path = folder.file("a.film");
  REQUIRE_FALSE(write_film(wrote.header, wrote.render, path));
  const std::string bytes = bytes_of(path);
  int read = 0;
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    std::string damaged = bytes;
    damaged[at] = static_cast<char>(damaged[at] ^ (1 << at % 8));
    write_bytes(path, damaged);
    read += std::holds_alternative<FilmFile>(read_film(path));
  }
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    write_bytes(path, bytes.substr(0, size));
    read += std::holds_alternative<FilmFile>(read_film(path));
  }
  write_bytes(path, bytes + "x");
  read += std::holds_alternative<FilmFile>(read_film(path));
  CHECK(read == 0);
  write_bytes(path, bytes);
  CHECK(std::holds_alternative<FilmFile>(read_film(path)));
}

// Heads forged to make the reader fail, with checksums that fit.
TEST_CASE("film files: a head that makes no sense is refused although its checksum fits", "[film]") {
  const test::TemporaryFolder folder;
  const FilmFile wrote = small_file({});
  const std::string path = folder.file("a.film");
  REQUIRE_FALSE(write_film(wrote.header, wrote.render, path));
  const std::string bytes = bytes_of(path);
  std::uint64_t size = 0;
  std::memcpy(&size, bytes.data() + 12, 8);
  const std::string head = bytes.substr(20, size);
  int accepted = 0;
  const auto offer = [&](const std::string& changed) {
    std::uint64_t length = changed.size();
    std::string file = bytes.substr(0, 12) + std::string(reinterpret_cast<const char*>(&length), 8) + changed;
    const vm::Digest digest = vm::digest(changed);
    file.append(reinterpret_cast<const char*>(&digest.low), 8);
    file.append(reinterpret_cast<const char*>(&digest.high), 8);
    write_bytes(path, file + bytes.substr(20 + size + 16));
    const auto read = read_film(path);
    if (const auto* unread = std::get_if<FilmReadError>(&read)) {
      REQUIRE_FALSE(unread->missing);
    } else {
      ++accepted;  // the change was a name, a value or another valid number
      const FilmFile& film = std::get<FilmFile>(read);
      REQUIRE(film.render.film.area() == film.shape.area);
    }
  };
  for (std::size_t at = 0; at < head.size(); ++at) {
    for (const int value : {0, 1, 0x7f, 0x80, 0xff}) {
      std::string changed = head;
      changed[at] = static_cast<char>(value);
      offer(changed);
    }
    offer(head.substr(0, at));
  }
  CHECK(accepted > 100);
  CHECK(accepted < static_cast<int>(6 * head.size()));
}

// A scene's names can have any length.
TEST_CASE("film files: what can be written can be read, however long", "[film]") {
  const test::TemporaryFolder folder;
  FilmFile wrote = small_file({});
  const std::string path = folder.file("a.film");
  const std::string text(std::size_t{3} << 20, 'x');
  wrote.header.identity = {{text, text}};
  wrote.header.attributes = {{text, text}, {"names", std::vector<std::string>{text, "b"}}};
  REQUIRE_FALSE(write_film(wrote.header, wrote.render, path));
  const auto read = read_film(path);
  REQUIRE(std::holds_alternative<FilmFile>(read));
  CHECK((std::get<FilmFile>(read).header.identity == wrote.header.identity));
  CHECK((std::get<FilmFile>(read).header.attributes == wrote.header.attributes));
  const auto small = read_film(path, {1 << 20});
  CHECK(std::get<FilmReadError>(small).problem.find("bytes of memory, and 1048576 are allowed") != std::string::npos);
}

TEST_CASE("film files: more rows of an identity than are ever written are refused", "[film]") {
  const test::TemporaryFolder folder;
  FilmFile wrote = small_file({});
  wrote.header.identity.assign(10000, {"", ""});
  REQUIRE_FALSE(write_film(wrote.header, wrote.render, folder.file("a.film")));
  const auto read = read_film_header(folder.file("a.film"));
  REQUIRE(std::holds_alternative<FilmReadError>(read));
  CHECK(std::get<FilmReadError>(read).problem.find("head makes no sense") != std::string::npos);
}

TEST_CASE("film files: what a head becomes is counted before it is made", "[film]") {
  const test::TemporaryFolder folder;
  FilmFile wrote = small_file({});
  for (int i = 0; i < 10000; ++i) wrote.header.attributes[std::to_string(i)] = 0;
  REQUIRE_FALSE(write_film(wrote.header, wrote.render, folder.file("a.film")));
  CHECK(std::holds_alternative<FilmFile>(read_film_header(folder.file("a.film"), {3e6})));
  CHECK(std::holds_alternative<FilmReadError>(read_film_header(folder.file("a.film"), {1.4e6})));
  std::string bytes = bytes_of(folder.file("a.film"));
  bytes[15] ^= 1;  // a byte of the head's length
  write_bytes(folder.file("a.film"), bytes);
  CHECK(std::get<FilmReadError>(read_film_header(folder.file("a.film"))).problem.find("too early") !=
        std::string::npos);
}

TEST_CASE("film files: sums that take more memory than is allowed are not read", "[film]") {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("a.film");
  const FilmFile wrote = small_file({});
  PartialRender large{Film(200, 100, FilmLayers{}), std::vector<Coverage>(1), {}};
  FilmHeader header = wrote.header;
  header.width = 200;
  header.height = 100;
  REQUIRE_FALSE(write_film(header, large, path));
  CHECK(std::holds_alternative<FilmFile>(read_film(path, {2e6})));
  CHECK(std::holds_alternative<FilmReadError>(read_film(path, {1e6})));
  CHECK(std::holds_alternative<FilmFile>(read_film_header(path, {1e6})));
}

// The reader checks the blocks for overlaps without tidying them, which would take quadratic time.
TEST_CASE("film files: blocks that overlap are refused as fast as they are read", "[film]") {
  const test::TemporaryFolder folder;
  FilmHeader header = small_file({}).header;
  header.width = header.height = 300;
  PartialRender render{Film(300, 300, FilmLayers{}), std::vector<Coverage>(1), {}};
  for (int i = 0; i < 60000; ++i) {
    const int x = i % 149, y = i / 403;
    render.covered[0].add({{x, y, 300 - x, 300 - y}, {0, 8}});
  }
  REQUIRE_FALSE(write_film(header, render, folder.file("a.film")));
  const auto start = std::chrono::steady_clock::now();
  const auto read = read_film(folder.file("a.film"));
  CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(20));
  CHECK(std::get<FilmReadError>(read).problem.find("head makes no sense") != std::string::npos);
}

TEST_CASE("film files: what is no film, or not there, is said to be so", "[film]") {
  const test::TemporaryFolder folder;
  write_bytes(folder.file("a.film"), "{\"version\": 1}                 ");
  const auto other = read_film(folder.file("a.film"));
  REQUIRE(std::holds_alternative<FilmReadError>(other));
  CHECK_FALSE(std::get<FilmReadError>(other).missing);
  CHECK(std::get<FilmReadError>(other).problem.find("does not begin as one") != std::string::npos);
  CHECK(std::get<FilmReadError>(other).not_a_film);
  write_bytes(folder.file("a.film"), "FATHOMFM");
  CHECK_FALSE(std::get<FilmReadError>(read_film(folder.file("a.film"))).not_a_film);
  const auto missing = read_film(folder.file("b.film"));
  CHECK(std::get<FilmReadError>(missing).missing);
  CHECK(std::get<FilmReadError>(read_film(folder.path().string())).missing);
}

TEST_CASE("film files: what renders differ in is named", "[film]") {
  const Identity a = {{"spp", "64"}, {"seed", "0"}, {"old", "x"}}, b = {{"seed", "0"}, {"spp", "128"}, {"new", "y"}};
  CHECK(differences(a, a).empty());
  CHECK(differences(a, b) == std::vector<std::string>{"spp is 64 there and 128 here",
                                                      "old is x there and unknown here",
                                                      "new is unknown there and y here"});
}

}  // namespace
}  // namespace fathom::runtime::film_file_test
