#include "runtime/film/film_header_bytes.h"

#include <bit>
#include <cstdint>

#include "compiler/scene/compiled_scene.h"
#include "runtime/base/tiles.h"

namespace fathom::runtime {
namespace {

constexpr const char* kBadHeader = "its head makes no sense";
// Max rows of an identity, about ten times the number that a render writes: comparing identities takes quadratic
// time.
constexpr std::size_t kMaxRows = 256;

// Layers of a film, by bit from the lowest.
constexpr bool FilmLayers::*kLayerBits[] = {&FilmLayers::first_hit, &FilmLayers::cost,     &FilmLayers::position,
                                            &FilmLayers::ids,       &FilmLayers::variance, &FilmLayers::halves};

std::uint8_t bits_of(FilmLayers layers) {
  std::uint8_t bits = 0;
  for (std::size_t i = 0; i < std::size(kLayerBits); ++i) {
    if (layers.*kLayerBits[i]) bits |= static_cast<std::uint8_t>(1u << i);
  }
  return bits;
}

FilmLayers read_layers(vm::ByteReader& in) {
  const std::uint8_t bits = in.u8();
  if (bits >> std::size(kLayerBits) != 0) in.fail();
  FilmLayers layers;
  for (std::size_t i = 0; i < std::size(kLayerBits); ++i) layers.*kLayerBits[i] = (bits >> i & 1) != 0;
  return layers;
}

// Reads a text of any length up to the rest of the head, because scenes may use names of any length.
std::string text_of(vm::ByteReader& in) { return in.text(in.left()); }

void write_value(const Attribute& value, vm::ByteWriter& out) {
  out.u8(static_cast<std::uint8_t>(value.index()));
  const auto put = [&](float number) { out.u32(std::bit_cast<std::uint32_t>(number)); };
  if (const int* whole = std::get_if<int>(&value)) out.u32(static_cast<std::uint32_t>(*whole));
  if (const float* number = std::get_if<float>(&value)) put(*number);
  if (const std::string* text = std::get_if<std::string>(&value)) out.text(*text);
  if (const Matrix4* matrix = std::get_if<Matrix4>(&value)) {
    for (const float number : *matrix) put(number);
  }
  if (const auto* list = std::get_if<std::vector<std::string>>(&value)) {
    out.u32(static_cast<std::uint32_t>(list->size()));
    for (const std::string& text : *list) out.text(text);
  }
}

// Reads a value. Kinds count in the order of Attribute's alternatives.
Attribute read_value(vm::ByteReader& in) {
  const auto number = [&] { return std::bit_cast<float>(in.u32()); };
  switch (in.u8()) {
    case 0:
      return static_cast<int>(in.u32());
    case 1:
      return number();
    case 2:
      return text_of(in);
    case 3: {
      Matrix4 matrix;
      for (float& value : matrix) value = number();
      return matrix;
    }
    case 4: {
      std::vector<std::string> list(in.count(4));
      for (std::string& text : list) text = text_of(in);
      return list;
    }
    default:
      in.fail();
      return 0;
  }
}

void write_rect(PixelRect rect, vm::ByteWriter& out) {
  for (const int side : {rect.x0, rect.y0, rect.x1, rect.y1}) out.u32(static_cast<std::uint32_t>(side));
}

PixelRect read_rect(vm::ByteReader& in) {
  PixelRect rect;
  for (int* side : {&rect.x0, &rect.y0, &rect.x1, &rect.y1}) *side = static_cast<int>(in.u32());
  return rect;
}

// True if `rect` has pixels and lies within `outer`.
bool is_within(PixelRect rect, PixelRect outer) {
  return outer.x0 <= rect.x0 && rect.x0 < rect.x1 && rect.x1 <= outer.x1 && outer.y0 <= rect.y0 &&
         rect.y0 < rect.y1 && rect.y1 <= outer.y1;
}

bool is_range(SampleRange samples) {
  return samples.first < samples.last && samples.last <= static_cast<std::uint32_t>(compiler::kMaxSpp);
}

// Refuses blocks that are not in the canonical form, because they may overlap. Checks the form instead of making it:
// the file may hold any blocks, and canonicalising overlapping blocks takes far longer than reading them.
Coverage read_coverage(PixelRect area, vm::ByteReader& in) {
  Coverage covered;
  const std::size_t count = in.count(24);
  for (std::size_t i = 0; i < count; ++i) {
    SampleBlock block;
    block.area = read_rect(in);
    block.samples.first = in.u32();
    block.samples.last = in.u32();
    if (!is_within(block.area, area) || !is_range(block.samples)) {
      in.fail();
      return covered;
    }
    covered.add(block);
  }
  if (!covered.is_canonical()) in.fail();
  return covered;
}

// Reads the state of adaptive sampling: all tiles of the area, or none if all pixels take the same number of samples.
AdaptiveState read_adaptive(const FilmShape& shape, vm::ByteReader& in) {
  constexpr auto kMost = static_cast<std::uint32_t>(compiler::kMaxSpp);
  AdaptiveState state;
  state.tested_spp = in.u32();
  state.tiles.resize(in.count(8));
  for (AdaptiveTile& tile : state.tiles) {
    for (std::uint32_t& end : tile.ends) {
      end = in.u32();
      if (end > 4 * kMost) in.fail();
    }
  }
  const auto tiles = static_cast<std::int64_t>(state.tiles.size());
  const bool fits = tiles == 0 ? shape.stages == 1 : tiles == Tiles(shape.area, kAdaptiveTile).count();
  if (!fits || state.tested_spp > kMost) in.fail();
  return state;
}

bool makes_sense(const FilmFile& head) {
  const FilmHeader& header = head.header;
  const auto side = [](int length) { return length >= 1 && length <= compiler::kMaxSide; };
  return side(header.width) && side(header.height) && is_range(header.samples) &&
         std::int64_t{header.width} * header.height <= kMaxPixels &&
         is_within(head.shape.area, {0, 0, header.width, header.height}) &&
         (head.shape.stages == 1 || head.shape.stages == 2);
}

}  // namespace

std::uint64_t sums_size(const FilmShape& shape) {
  const auto tiles = static_cast<std::uint64_t>(Tiles(shape.area, kFilmTile).count());
  return shape.area.pixels() * Film::file_bytes_per_pixel(shape.layers, shape.stages) + tiles * kDigestSize;
}

void write_head(const FilmHeader& header, const PartialRender& render, vm::ByteWriter& out) {
  out.u32(static_cast<std::uint32_t>(header.identity.size()));
  for (const auto& [name, value] : header.identity) {
    out.text(name);
    out.text(value);
  }
  out.u32(static_cast<std::uint32_t>(header.attributes.size()));
  for (const auto& [name, value] : header.attributes) {
    out.text(name);
    write_value(value, out);
  }
  out.u32(static_cast<std::uint32_t>(header.width));
  out.u32(static_cast<std::uint32_t>(header.height));
  out.u32(header.samples.first);
  out.u32(header.samples.last);
  for (int i = 0; i < 3; ++i) out.f64(header.origin[i]);
  const Film& film = render.film;
  write_rect(film.area(), out);
  out.u8(bits_of(film.layers()));
  out.u8(static_cast<std::uint8_t>(film.stages()));
  for (const Coverage& covered : render.covered) {
    out.u32(static_cast<std::uint32_t>(covered.blocks().size()));
    for (const SampleBlock& block : covered.blocks()) {
      write_rect(block.area, out);
      out.u32(block.samples.first);
      out.u32(block.samples.last);
    }
  }
  out.u32(render.adaptive.tested_spp);
  out.u32(static_cast<std::uint32_t>(render.adaptive.tiles.size()));
  for (const AdaptiveTile& tile : render.adaptive.tiles) {
    for (const std::uint32_t end : tile.ends) out.u32(end);
  }
}

std::optional<std::string> read_shape(vm::ByteReader& in, FilmFile& head) {
  FilmHeader& header = head.header;
  header.identity.resize(in.count(8));
  if (header.identity.size() > kMaxRows) return kBadHeader;
  for (auto& [name, value] : header.identity) {
    name = text_of(in);
    value = text_of(in);
  }
  const std::size_t attributes = in.count(5);
  for (std::size_t i = 0; i < attributes && !in.failed(); ++i) {
    const std::string name = text_of(in);
    if (!header.attributes.empty() && header.attributes.rbegin()->first >= name) in.fail();  // names are in order
    header.attributes[name] = read_value(in);
  }
  header.width = static_cast<int>(in.u32());
  header.height = static_cast<int>(in.u32());
  header.samples.first = in.u32();
  header.samples.last = in.u32();
  for (int i = 0; i < 3; ++i) header.origin[i] = in.f64();
  head.shape.area = read_rect(in);
  head.shape.layers = read_layers(in);
  head.shape.stages = in.u8();
  return in.failed() || !makes_sense(head) ? std::optional<std::string>(kBadHeader) : std::nullopt;
}

std::optional<std::string> read_covered(vm::ByteReader& in, FilmFile& head) {
  for (std::size_t i = 0; i < head.shape.stages; ++i) {
    head.render.covered.push_back(read_coverage(head.shape.area, in));
  }
  head.render.adaptive = read_adaptive(head.shape, in);
  return in.failed() || in.left() > 0 ? std::optional<std::string>(kBadHeader) : std::nullopt;
}

}  // namespace fathom::runtime
