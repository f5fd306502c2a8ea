// Images and their layers as `fathom render` and `fathom tonemap` write them: formats, crops, tone curves,
// attributes.

#include "runtime/film/film_channels.h"
#include "runtime/image/image_exr.h"
#include "runtime/image/image_read.h"
#include "tests/support/catch.h"
#include "tests/support/program.h"

namespace fathom::cli_layers_test {

namespace {

using Catch::Contains;
using fathom::runtime::FloatImage;
using fathom::test::Folder;
using fathom::test::png_size;
using fathom::test::Result;

FloatImage read(const Folder& folder, const std::string& name) {
  const auto image = fathom::runtime::read_image(folder.path() / name);
  if (const auto* unread = std::get_if<fathom::runtime::ImageReadError>(&image)) FAIL(unread->problem);
  return std::get<FloatImage>(image);
}

// True if `part`, placed at (x0, y0), has the values of `whole`.
bool equal_there(const FloatImage& part, const FloatImage& whole, int x0, int y0) {
  for (std::size_t c = 0; c < part.channels.size(); ++c) {
    const std::vector<float>* values = whole.channel(part.channels[c].name);
    if (values == nullptr) return false;
    for (int y = 0; y < part.area.height(); ++y) {
      for (int x = 0; x < part.area.width(); ++x) {
        const float here = part.values[c][part.area.index(part.area.x0 + x, part.area.y0 + y)];
        if (here != (*values)[whole.area.index(x0 + x, y0 + y)]) return false;
      }
    }
  }
  return true;
}

}  // namespace

TEST_CASE("cli layers: wrong flags are exit code 2 and say what is wrong", "[cli]") {
  struct Case {
    const char* arguments;
    const char* message;
  };
  const Case cases[] = {
      {"render ball.json -o out.tga", "valid endings: .png, .jpg, .jpeg, .bmp, .exr, .pfm, .hdr"},
      {"render ball.json --crop 0,0,5", "write its two corners in pixels or percent"},
      {"render ball.json --crop 0,0,5,5,5", "--crop: `0,0,5,5,5`"},
      {"render ball.json --crop 0,0,5.5,5", "--crop: `0,0,5.5,5`"},
      {"render ball.json --crop -1,0,5,5", "--crop: `-1,0,5,5`"},
      {"render ball.json --crop 0,0,101%,5", "--crop: `0,0,101%,5`"},
      {"render ball.json --crop 5,0,5,5", "there are no pixels in 5,0,5,5"},
      {"render ball.json --crop 50%,50%,51%,51%", "there are no pixels in 16,8,16,8"},
      {"render ball.json --crop 0,0,33,16", "the whole picture is 0,0,32,16"},
      {"render ball.json --tone agxx", "did you mean `agx`?"},
      {"render ball.json --exposure bright", "--exposure: `bright` is not a number from -100 to 100"},
      {"render ball.json --exposure 101", "--exposure: `101`"},
      {"render ball.json --bits 12", "--bits: `12` is not one of 8, 16"},
      {"render ball.json -o a.png -o b.jpg --bits 16", "--bits 16: `b.jpg` can have only 8 bits per channel"},
      {"render ball.json -o a.bmp --bits 16", "16 bits go into png"},
      {"render ball.json --cost-map a.exr", "valid endings: .png, .jpg, .jpeg, .bmp for colours, .pfm for numbers"},
      {"slice ball.json -o a.exr", "this format holds numbers"},
      {"tonemap", "the picture is missing"},
      {"tonemap a.exr", "name it with -o FILE"},
      {"tonemap a.exr -o b.hdr", "this format holds numbers"},
      {"tonemap a.exr -o b.gif", "valid endings: .png, .jpg, .jpeg, .bmp"},
      {"tonemap a.exr -o b.png --layer nromal", "did you mean `normal`?"},
      {"tonemap a.exr -o b.png --layer normal --tone agx", "they do not go with another --layer"},
      {"tonemap a.exr -o b.bmp --bits 16", "bmp can have only 8 bits per channel"},
      {"tonemap a.png -o ./a.png", "would be overwritten"},
  };
  const Folder folder;
  for (const Case& c : cases) {
    INFO("fathom " << c.arguments);
    const Result result = folder.run(c.arguments);
    CHECK(result.code == 2);
    CHECK_THAT(result.err, Contains(c.message) && Contains("error: "));
  }
  CHECK(folder.files() == 2);
}

TEST_CASE("cli layers: trouble with files is told from trouble with their content", "[cli]") {
  const Folder folder;
  const Result missing = folder.run("tonemap none.exr -o a.png");
  CHECK(missing.code == 74);
  CHECK_THAT(missing.err, Contains("cannot read `none.exr`: No such file"));
  folder.write("bad.exr", "not a picture");
  const Result bad = folder.run("tonemap bad.exr -o a.png");
  CHECK(bad.code == 65);
  CHECK_THAT(bad.err, Contains("`bad.exr` is no exr picture that can be read"));
  CHECK(folder.run("tonemap ball.json -o a.png").code == 65);
  for (const char* output : {"ball.json/a.exr", "ball.json/a.pfm"}) {
    const Result result = folder.run(std::string("render ball.json -o ") + output);
    CHECK(result.code == 74);
    CHECK_THAT(result.err, Contains("`ball.json`") && !Contains("wrote"));
  }
  REQUIRE(folder.run("render ball.json -o light.pfm -s 1").code == 0);
  const Result no_layer = folder.run("tonemap light.pfm -o a.png --layer albedo");
  CHECK(no_layer.code == 65);
  CHECK_THAT(no_layer.err, Contains("no layer `albedo`") && Contains("its channels: R, G, B"));
  CHECK_FALSE(folder.has("a.png"));
}

TEST_CASE("cli layers: tonemap makes of the exr the bits that render writes", "[cli]") {
  const Folder folder;
  folder.write("toned.json", R"({"version": 1, "camera": {"position": [0, 1, 4]}, "background": [1, 2, 4],
    "film": {"width": 40, "height": 24, "exposure": 0.7, "tone": "filmic"}, "render": {"spp": 3},
    "objects": [{"type": "sphere", "radius": 1}, {"type": "plane", "normal": [0, 1, 0], "offset": -1}]})");
  REQUIRE(folder.run("render toned.json -o r.exr -o r.png -o r.bmp -a -d -n").code == 0);
  CHECK(folder.files() == 3 + 1 + 2 * 4);  // the EXR file contains its layers
  for (const char* layer : {"", "albedo", "depth", "normal"}) {
    const std::string flag = *layer ? std::string(" --layer ") + layer : "";
    const std::string name = *layer ? std::string("r-") + layer : "r";
    for (const char* ending : {".png", ".bmp"}) {
      INFO(name << ending);
      REQUIRE(folder.run(std::string("tonemap r.exr -o t") + ending + flag).code == 0);
      CHECK(folder.read(std::string("t") + ending) == folder.read(name + ending));
    }
  }
  const std::string as_said = folder.read("r.png");
  for (const char* flags : {"--tone agx", "--tone none --exposure -1", "--exposure 2 --bits 16",
                            "--tone aces --bits 16", "--tone neutral"}) {
    INFO(flags);
    REQUIRE(folder.run(std::string("render toned.json -o r.png ") + flags).code == 0);
    REQUIRE(folder.run(std::string("tonemap r.exr -o t.png ") + flags).code == 0);
    CHECK(folder.read("t.png") == folder.read("r.png"));
    CHECK(folder.read("t.png") != as_said);
  }
}

TEST_CASE("cli layers: the file of a crop is the picture's part, bit for bit", "[cli]") {
  const Folder folder;
  REQUIRE(folder.run("render ball.json -o w.exr -o w.png -o w.pfm -a -n").code == 0);
  const FloatImage whole = read(folder, "w.exr");
  for (const char* crop : {"9,3,25,14", "28.125%,3,25,14", "9,18.75%,78.125%,87.5%"}) {
    INFO(crop);
    REQUIRE(folder.run(std::string("render ball.json -o c.exr -o c.png -o c.pfm -a -n --threads 1 --crop ") + crop)
                .code == 0);
    const std::string file = folder.read("c.exr");
    const FloatImage part = std::get<FloatImage>(fathom::runtime::decode_exr({file.begin(), file.end()}));
    CHECK(part.width == 32);
    CHECK(part.height == 16);
    CHECK(part.area == fathom::runtime::PixelRect{9, 3, 25, 14});
    // All channels except the three of the denoiser.
    CHECK(part.channels.size() == fathom::runtime::film_channels().size() - 3);
    CHECK(equal_there(part, whole, 9, 3));
    CHECK(png_size(folder.read("c.png")) == std::pair(16, 11));
    for (const char* name : {".png", ".pfm", "-albedo.png", "-normal.png", "-normal.pfm"}) {
      CHECK(equal_there(read(folder, std::string("c") + name), read(folder, std::string("w") + name), 9, 3));
    }
  }
}

// The data of other programs' files are elsewhere than in their display windows, too: they were shown stretched, and
// were not comparable.
TEST_CASE("cli layers: the data of an exr are shown in their place", "[cli]") {
  const Folder folder;
  REQUIRE(folder.run("render ball.json -o w.exr -s 1").code == 0);
  REQUIRE(folder.run("render ball.json -o c.exr -s 1 --crop 9,3,25,14").code == 0);
  REQUIRE(folder.run("render ball.json -o d.exr -s 1 --crop 8,3,24,14").code == 0);
  REQUIRE(folder.run("tonemap c.exr -o c.png").code == 0);
  REQUIRE(folder.run("tonemap w.exr -o w.png").code == 0);
  const FloatImage crop = read(folder, "c.png"), whole = read(folder, "w.png");
  CHECK(crop.area == fathom::runtime::PixelRect{0, 0, 32, 16});
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 32; ++x) {
      const bool has = x >= 9 && x < 25 && y >= 3 && y < 14;
      const std::size_t at = crop.area.index(x, y);
      for (std::size_t c = 0; c < 3; ++c) CHECK(crop.values[c][at] == (has ? whole.values[c][at] : 0));
    }
  }
  CHECK(folder.run("diff c.exr w.exr --tol 0").code == 1);
  CHECK(folder.run("diff c.exr c.png --tol 1e-3").code == 0);
  CHECK(folder.run("diff c.exr d.exr --tol 0").code == 1);
}

TEST_CASE("cli layers: two runs write the same file, and --profile adds the time", "[cli]") {
  const Folder folder;
  REQUIRE(folder.run("render ball.json -o a.exr --threads 1 -t 5").code == 0);
  REQUIRE(folder.run("render ball.json -o b.exr --threads 2").code == 0);
  CHECK(folder.read("a.exr") == folder.read("b.exr"));
  CHECK(read(folder, "a.exr").attributes.count("renderTimeSeconds") == 0);
  REQUIRE(folder.run("render ball.json -o b.exr --profile").code == 0);
  CHECK(std::get<float>(read(folder, "b.exr").attributes.at("renderTimeSeconds")) > 0);
}

TEST_CASE("cli layers: the attributes say what was rendered, and where the camera was", "[cli]") {
  const Folder folder;
  folder.write("far.json",
               R"({"version": 1, "camera": {"position": [100003, 1, 4], "target": [100000, 0, 0], "fov": 60},
    "materials": {"red": {"type": "diffuse"}}, "film": {"width": 40, "height": 20, "tone": "agx"}, "background": [1, 1, 1],
    "objects": [{"name": "ball", "type": "sphere", "radius": 1, "translate": [100000, 0, 0], "material": "red"}]})");
  REQUIRE(folder.run("render far.json -o a.exr -s 4 --seed 9").code == 0);
  const FloatImage image = read(folder, "a.exr");
  const auto text = [&](const char* name) { return std::get<std::string>(image.attributes.at(name)); };
  CHECK(std::get<int>(image.attributes.at("samplesPerPixel")) == 4);
  CHECK(text("fathom.seed") == "9");
  CHECK(text("fathom.sampleRange") == "0:4");
  CHECK(text("fathom.tone") == "agx");
  CHECK(text("fathom.sceneHash").size() == 32);
  CHECK(text("fathom.programHash").size() == 32);
  CHECK(std::get<std::vector<std::string>>(image.attributes.at("fathom.objects")) ==
        std::vector<std::string>{"ball"});
  const auto materials = std::get<std::vector<std::string>>(image.attributes.at("fathom.materials"));
  const auto& matrix = std::get<fathom::runtime::Matrix4>(image.attributes.at("worldToNDC"));
  const auto& camera = std::get<fathom::runtime::Matrix4>(image.attributes.at("worldToCamera"));
  const auto times = [](const fathom::runtime::Matrix4& m, const double(&p)[4], std::size_t column) {
    double sum = 0;
    for (std::size_t row = 0; row < 4; ++row) sum += p[row] * static_cast<double>(m[4 * row + column]);
    return sum;
  };
  int balls = 0;
  for (int y = 0; y < 20; ++y) {
    for (int x = 0; x < 40; ++x) {
      const std::size_t at = image.area.index(x, y);
      if ((*image.channel("A"))[at] < 1) continue;
      ++balls;
      CHECK((*image.channel("id.object"))[at] == 1);
      CHECK(materials.at(static_cast<std::size_t>((*image.channel("id.material"))[at]) - 1) == "red");
      const double p[4] = {static_cast<double>((*image.channel("P.X"))[at]),
                           static_cast<double>((*image.channel("P.Y"))[at]),
                           static_cast<double>((*image.channel("P.Z"))[at]), 1};
      // Floats near 1e5 are 0.008 apart, and the matrix' last row has the same error.
      const double w = times(matrix, p, 3);
      CHECK(times(matrix, p, 0) / w * 40 == Approx(x + 0.5).margin(1));
      CHECK((1 - times(matrix, p, 1) / w) * 20 == Approx(y + 0.5).margin(1));
      CHECK(times(camera, p, 2) == Approx(w).margin(1e-6));
      CHECK(times(camera, p, 2) <= static_cast<double>((*image.channel("Z"))[at]) + 0.05);
    }
  }
  CHECK(balls > 20);
}

}  // namespace fathom::cli_layers_test
