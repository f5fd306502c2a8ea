// Fuzz target for film files. The input is a u32 size of the header, the header, and the sums; missing sums are 0.
// The target adds the correct digests, because a fuzz run would never find them. The reader refuses a film with a
// reason, or the film writes as the bytes that were read.
#include <algorithm>

#include "runtime/base/tiles.h"
#include "runtime/film/film_file.h"
#include "runtime/film/film_header_bytes.h"
#include "tests/fuzz/target.h"
#include "vm/encoding/bytes.h"
#include "vm/encoding/digest.h"

namespace fathom::fuzz {
namespace {

constexpr runtime::ReadLimits kFilmLimits{64e6};
constexpr std::size_t kMaxSums = 1 << 20;  // bytes; a header that asks for more gets the sums in the input

void put_checked(vm::ByteWriter& out, Bytes bytes) {
  const vm::Digest digest = vm::digest(bytes);
  out.raw(bytes);
  out.u64(digest.low);
  out.u64(digest.high);
}

void put_sums(vm::ByteWriter& out, const runtime::FilmShape& shape, vm::ByteReader& sums) {
  const runtime::Tiles tiles(shape.area, runtime::kFilmTile);
  const std::size_t pixel = runtime::Film::file_bytes_per_pixel(shape.layers, shape.stages);
  for (std::int64_t i = 0; i < tiles.count(); ++i) {
    const std::size_t size = tiles.at(i).pixels() * pixel;
    const Bytes there = sums.raw(std::min(size, sums.left()));
    Input tile(there.begin(), there.end());
    tile.resize(size);
    put_checked(out, tile);
  }
}

Input sealed_film(Bytes head, vm::ByteReader sums) {
  vm::ByteWriter out;
  out.raw(to_input(runtime::kFilmMagic));
  out.u32(runtime::kFilmFormat);
  out.u64(head.size());
  put_checked(out, head);
  vm::ByteReader reader(head);
  runtime::FilmFile file;
  if (!runtime::read_shape(reader, file) && runtime::sums_size(file.shape) <= kMaxSums) {
    put_sums(out, file.shape, sums);
  } else {
    out.raw(sums.raw(sums.left()));
  }
  return out.take();
}

void run_file(const Input& bytes) {
  const ScratchFile given("given.film"), written("written.film");
  write_file(given.path, bytes);
  const auto read = runtime::read_film(given.path, kFilmLimits);
  if (const auto* unread = std::get_if<runtime::FilmReadError>(&read)) {
    return promise(!unread->problem.empty(), "a refusal has a reason");
  }
  const auto& film = std::get<runtime::FilmFile>(read);
  for (const runtime::Coverage& covered : film.render.covered) {
    if (covered.blocks().size() >= 100) continue;  // canonicalise() is quadratic in their number
    runtime::Coverage form = covered;
    form.canonicalise();
    promise(form == covered, "what is covered is in its one form");
  }
  promise(!runtime::write_film(film.header, film.render, written.path), "what is read can be written");
  promise(read_file(written.path) == bytes, "what is written is what was read");
}

}  // namespace

void run_film(Bytes input) {
  vm::ByteReader in(input);
  const Bytes head = in.raw(std::min<std::size_t>(in.u32(), in.left()));
  if (!in.failed()) run_file(sealed_film(head, in));
}

std::vector<Input> seeds_of_film() {
  std::vector<Input> seeds;
  runtime::FilmLayers every = runtime::kAllLayers;
  every.halves = true;
  for (const runtime::FilmLayers layers : {runtime::FilmLayers{}, every, runtime::FilmLayers{.first_hit = false}}) {
    for (const auto& [adaptive, stages] :
         {std::pair{false, std::size_t{1}}, {true, std::size_t{1}}, {true, std::size_t{2}}}) {
      runtime::PartialRender render{runtime::Film(runtime::PixelRect{2, 1, 20, 4}, layers), {}, {}};
      if (stages > 1) render.film.add_stage();
      if (adaptive) render.adaptive = {4, {{{4, 0}}, {{0, 4}}}};
      runtime::PathSample sample;
      sample.hit = true;
      sample.radiance = glm::vec3(0.5f, 1, 2);
      for (int x = 2; x < 20; ++x) render.film.add(x, 2, sample);
      render.covered.resize(stages);
      for (runtime::Coverage& covered : render.covered) {
        for (const std::uint32_t first : {0, 5}) covered.add({{2, 2, 20, 3}, {first, first + 2}});
        covered.add({{4, 1, 9, 2}, {0, 1}});
        covered.canonicalise();
      }
      const runtime::FilmHeader header{{{"spp", "8"}, {"seed", "0"}},
                                       {{"list", std::vector<std::string>{"a", ""}},
                                        {"matrix", runtime::Matrix4{1, 2, 3}},
                                        {"number", 0.5f},
                                        {"text", std::string("agx")},
                                        {"whole", -3}},
                                       24,
                                       16,
                                       {0, 8},
                                       {1, 2, 3}};
      vm::ByteWriter head, seed;
      runtime::write_head(header, render, head);
      seed.u32(static_cast<std::uint32_t>(head.size()));
      seed.raw(head.bytes());
      render.film.write_sums(render.film.area(), seed);
      seeds.push_back(seed.take());
    }
  }
  return seeds;
}

}  // namespace fathom::fuzz
