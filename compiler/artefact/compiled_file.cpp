#include "compiler/artefact/compiled_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <iterator>
#include <utility>

#include "compiler/artefact/fields.h"
#include "compiler/artefact/programs.h"
#include "compiler/source/limits.h"
#include "vm/encoding/binary.h"
#include "vm/encoding/repeats.h"

namespace fathom::compiler {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::uint64_t kMaxText = 1 << 30;  // bytes of a scene and its imports, whose places have 32 bits

// Sections, in the order of the file.
enum Section { kCode, kTables, kDebug, kText, kSections };
constexpr std::string_view kSectionNames[] = {"code", "tables", "debug", "text"};

// Magic, version, number of sections, digest of the opcodes; size and digest of each section; digest of the header.
constexpr std::size_t kHeaderSize = 8 + 4 + 4 + 16 + kSections * (8 + 16) + 16;

void write(vm::ByteWriter& out, vm::Digest digest) {
  out.u64(digest.low);
  out.u64(digest.high);
}

vm::Digest read_digest(vm::ByteReader& in) {
  const std::uint64_t low = in.u64();
  return {low, in.u64()};
}

Bytes write_code(const CompiledScene& scene) {
  vm::ByteWriter out;
  out.u32(static_cast<std::uint32_t>(scene.media.size()));
  out.u32(static_cast<std::uint32_t>(scene.formulas.size()));
  vm::ProgramEncoder encoder;
  for (const NamedProgram& row : programs_of(scene)) encoder.write(out, *row.program);
  return out.take();
}

Bytes write_tables(const CompiledScene& scene) { return TableJson::to_cbor(tables_of(scene)); }

// Returns the name without folders: a file does not depend on its scene's folder.
std::string file_name(const std::string& path) { return std::filesystem::path(path).filename().string(); }

Bytes write_debug(const CompiledScene& scene) {
  vm::ByteWriter out;
  for (const NamedProgram& row : programs_of(scene)) {
    const vm::Program& program = row.program->program();
    vm::write_debug(out, {file_name(program.source_name), program.debug});
  }
  return out.take();
}

Bytes write_text(const Source& source, const Definitions& definitions) {
  vm::ByteWriter out;
  out.text(file_name(source.name()));
  out.u32(static_cast<std::uint32_t>(definitions.size()));
  for (const auto& [name, value] : definitions) {
    out.text(name);
    out.f64(value);
  }
  out.text(source.text());
  const std::vector<Import> imports = files_of(source);
  out.u32(static_cast<std::uint32_t>(imports.size()));
  for (const Import& import : imports) {
    out.text(import.path);
    out.text(import.file->text());
  }
  return out.take();
}

FileError damaged(std::string_view section, std::string_view what) {
  return {fmt::format("the section `{}` {}", section, what), "it was changed or damaged: compile the scene again"};
}

std::variant<ProgramList, FileError> read_code(std::span<const std::uint8_t> bytes, const Limits& limits) {
  vm::ByteReader in(bytes);
  const std::size_t media = in.u32(), formulas = in.u32();
  // A program takes 28 bytes at least.
  const bool room = media <= bytes.size() / 56 && formulas <= bytes.size() / 28;
  if (in.failed() || !room) return damaged("code", "is cut off");
  ProgramList list(media, formulas);
  vm::ProgramDecoder decoder;
  vm::Limits machine = largest_machine();
  // Straight code has fewer words than bytes. Rows and copies have more, for a few programs of the greatest size.
  constexpr double kPrograms = 4;
  const double most =
      static_cast<double>(bytes.size()) + static_cast<double>(vm::kWordsPerInstruction) * limits.instructions;
  double left = kPrograms * most;
  while (!list.full()) {
    const std::size_t begin = in.offset();
    machine.words = static_cast<std::uint32_t>(std::min({static_cast<double>(machine.words), most, left}));
    auto program = decoder.read(in, machine);
    if (const auto* error = std::get_if<vm::VerifyError>(&program)) {
      return FileError{
          fmt::format("program `{}` at byte {} of the code, word {}: {}", list.next(), begin, error->offset,
                      error->reason),
          error->reason.ends_with("allowed") ? raise(&Limits::instructions, 2 * limits.instructions) : ""};
    }
    list.add(std::get<vm::VerifiedProgram>(std::move(program)));
    left -= static_cast<double>(list.programs.back().program().words.size());
  }
  if (in.left() > 0) return damaged("code", fmt::format("goes on for {} bytes after its last program", in.left()));
  return list;
}

std::optional<FileError> read_debug(std::span<const std::uint8_t> bytes, ProgramList& list) {
  if (bytes.empty()) return std::nullopt;
  vm::ByteReader in(bytes);
  for (vm::VerifiedProgram& program : list.programs) {
    vm::DebugTable table = vm::read_debug(in, program);
    if (in.failed()) return damaged("debug", fmt::format("makes no sense at byte {}", in.offset()));
    program = vm::with_debug(program, std::move(table));
  }
  if (in.left() > 0) return damaged("debug", "goes on after its last program");
  const bool says_anything = std::any_of(list.programs.begin(), list.programs.end(), has_debug);
  return says_anything ? std::nullopt : std::optional(damaged("debug", "says nothing, and should be empty"));
}

// A file cut into its sections, whose digests are right.
struct Sections {
  vm::Digest opcodes;  // of the table that the programs were made for
  std::span<const std::uint8_t> code, tables, debug;
  std::optional<Source> text;  // under its file's name, without folders, with its imports
  Definitions definitions;
};

struct Header {
  vm::Digest opcodes;
  std::array<std::uint64_t, kSections> sizes;  // bytes
  std::array<vm::Digest, kSections> digests;
};

std::variant<Header, FileError> read_header(vm::ByteReader& in, std::span<const std::uint8_t> bytes) {
  const FileError broken{"its header is damaged or cut off", "compile the scene again"};
  const auto magic = in.raw(kFileMagic.size());
  if (!std::equal(magic.begin(), magic.end(), kFileMagic.begin(), kFileMagic.end())) {
    return FileError{"it is no compiled scene, or one that was changed as if it were text, or cut off",
                     "copy it again as binary, or compile the scene again"};
  }
  const std::uint32_t version = in.u32(), sections = in.u32();
  if (in.failed()) return broken;
  if (version != kFileVersion || sections != kSections) {
    return FileError{fmt::format("it is of version {} of the format with {} sections; this program reads version {}, "
                                 "which has {}",
                                 version, sections, kFileVersion, int{kSections}),
                     "compile the scene again with this program"};
  }
  Header header{};
  header.opcodes = read_digest(in);
  for (int i = 0; i < kSections; ++i) {
    header.sizes[static_cast<std::size_t>(i)] = in.u64();
    header.digests[static_cast<std::size_t>(i)] = read_digest(in);
  }
  const std::span<const std::uint8_t> read = bytes.first(in.offset());
  if (read_digest(in) != vm::digest(read) || in.failed()) return broken;
  return header;
}

bool read_text(std::span<const std::uint8_t> bytes, Sections& file) {
  vm::ByteReader in(bytes);
  std::string name = in.text(in.left());
  for (std::size_t left = in.count(12); left > 0; --left) {
    std::string parameter = in.text(in.left());
    file.definitions.emplace_back(std::move(parameter), in.f64());
  }
  std::string content = in.text(in.left());
  if (in.failed() || content.empty() || name != file_name(name)) return false;
  file.text = Source(std::move(name), std::move(content));
  for (std::size_t left = in.count(8); left > 0; --left) {
    const std::string path = in.text(in.left());
    if (!add_import(*file.text, path, in.text(in.left()))) return false;
  }
  return !in.failed() && in.left() == 0;
}

// Returns the text as if it lay beside the file `path`.
Source beside(const Source& text, const std::string& path) {
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  Source there((folder / text.name()).string(), text.text());
  for (const Import& import : files_of(text)) {
    there.import(import.path, (folder / import.path).lexically_normal().string(), import.file->text());
  }
  return there;
}

std::variant<Sections, FileError> open_file(std::span<const std::uint8_t> bytes) {
  vm::ByteReader in(bytes);
  auto header = read_header(in, bytes);
  if (auto* error = std::get_if<FileError>(&header)) return std::move(*error);
  const auto& [opcodes, sizes, digests] = std::get<Header>(header);
  std::span<const std::uint8_t> sections[kSections];
  for (int i = 0; i < kSections; ++i) {
    if (sizes[i] > in.left()) return damaged(kSectionNames[i], "is cut off");
    sections[i] = in.raw(static_cast<std::size_t>(sizes[i]));
    if (vm::digest(sections[i]) != digests[i]) return damaged(kSectionNames[i], "has another digest than it should");
  }
  if (in.left() > 0) return FileError{fmt::format("{} bytes follow its last section", in.left()), ""};
  Sections file{opcodes, sections[kCode], sections[kTables], sections[kDebug], std::nullopt, {}};
  if (!sections[kText].empty() && !read_text(sections[kText], file)) return damaged("text", "makes no sense");
  return file;
}

// Returns the reason why the tables are refused.
std::optional<FileError> read_tables(std::span<const std::uint8_t> bytes, CompiledScene& scene) {
  auto parsed = parse_tables(bytes, true);
  if (const auto* reason = std::get_if<std::string>(&parsed)) return damaged("tables", "is wrong: " + *reason);
  Archive archive(std::get<TableJson>(std::move(parsed)));
  read_tables(archive, scene);
  if (archive.failed()) return damaged("tables", "is wrong at " + archive.reason());
  const Bytes again = TableJson::to_cbor(archive.json());
  if (!std::ranges::equal(again, bytes)) return damaged("tables", "is not in the shortest form");
  return std::nullopt;
}

// Reads the scene of the file `path`.
std::variant<CompiledScene, FileError> read_scene(const Sections& file, const std::string& path,
                                                  const Limits& limits) {
  if (file.opcodes != vm::opcode_digest()) {
    return FileError{"its programs are for another machine than this program's",
                     file.text ? "it holds its scene: `fathom compile` makes it anew"
                               : "it holds no scene to compile again: use the program it was made with"};
  }
  auto read = read_code(file.code, limits);
  if (auto* error = std::get_if<FileError>(&read)) return std::move(*error);
  auto& list = std::get<ProgramList>(read);
  if (auto error = read_debug(file.debug, list)) return *std::move(error);
  CompiledScene scene = std::move(list).scene();
  if (auto error = read_tables(file.tables, scene)) return *std::move(error);
  if (const auto fault = check_tags(scene)) {
    return FileError{
        fmt::format("program `{}`, word {}: {}", programs_of(scene)[fault->program].name, fault->word, fault->reason),
        ""};
  }
  scene.source = file.text ? beside(*file.text, path) : Source(path, "");
  resolve_image_path(scene);
  return scene;
}

}  // namespace

std::vector<Import> files_of(const Source& source) {
  std::vector<Import> files;
  std::ranges::copy_if(source.imports(), std::back_inserter(files), [](const Import& i) { return !i.derived; });
  return files;
}

bool add_import(Source& source, const std::string& path, std::string text) {
  const std::filesystem::path normal = std::filesystem::path(path).lexically_normal();
  const bool known = std::ranges::find(source.imports(), path, &Import::path) != source.imports().end();
  if (path.empty() || normal.is_absolute() || normal.generic_string() != path || known) return false;
  if (source.size() + text.size() > kMaxText) return false;
  source.import(path, path, std::move(text));
  return true;
}

// Looks at the first bytes, which no text begins with. The rest of the magic shows damage by a text mode.
bool is_compiled_file(std::string_view bytes) {
  constexpr std::size_t kName = 4;
  return bytes.size() >= kName && std::equal(kFileMagic.begin(), kFileMagic.begin() + kName,
                                             reinterpret_cast<const std::uint8_t*>(bytes.data()));
}

std::vector<std::uint8_t> write_file(const CompiledScene& scene, const FileContents& contents) {
  const Bytes sections[kSections] = {write_code(scene), write_tables(scene),
                                     contents.debug ? write_debug(scene) : Bytes(),
                                     contents.text ? write_text(scene.source, contents.definitions) : Bytes()};
  vm::ByteWriter out;
  out.raw(kFileMagic);
  out.u32(kFileVersion);
  out.u32(kSections);
  write(out, vm::opcode_digest());
  for (const Bytes& section : sections) {
    out.u64(section.size());
    write(out, vm::digest(section));
  }
  write(out, vm::digest(out.bytes()));
  for (const Bytes& section : sections) out.raw(section);
  return out.take();
}

std::variant<StoredScene, FileError> read_stored(std::span<const std::uint8_t> bytes, const std::string& path,
                                                 const Limits& limits) {
  auto opened = open_file(bytes);
  if (auto* error = std::get_if<FileError>(&opened)) return std::move(*error);
  auto& file = std::get<Sections>(opened);
  auto scene = read_scene(file, path, limits);
  if (auto* error = std::get_if<FileError>(&scene)) return std::move(*error);
  return StoredScene{std::get<CompiledScene>(std::move(scene)),
                     {!file.debug.empty(), file.text.has_value(), std::move(file.definitions)}};
}

std::variant<StoredText, FileError> read_stored_text(std::span<const std::uint8_t> bytes, const std::string& path) {
  auto opened = open_file(bytes);
  if (auto* error = std::get_if<FileError>(&opened)) return std::move(*error);
  auto& file = std::get<Sections>(opened);
  if (file.text) return StoredText{beside(*file.text, path), std::move(file.definitions)};
  return FileError{"it holds programs without the scene they were compiled from", "compile the scene's own file",
                   true};
}

vm::Digest scene_digest(const CompiledScene& scene, bool settings) {
  TableJson tables = tables_of(scene);
  // A still does not depend on these: the moments of an animation are scenes with digests of their own.
  for (const char* name : {"frames", "fps"}) tables["film"].erase(name);
  tables["camera"].erase("shutter");
  tables.erase("summary");
  for (const char* name : {"film", "render"}) {
    if (!settings) tables.erase(name);
  }
  vm::ByteWriter all;
  write(all, program_digest(scene));
  all.raw(TableJson::to_cbor(tables));
  return vm::digest(all.bytes());
}

vm::Digest program_digest(const CompiledScene& scene) {
  const auto bytes_of = [](const auto& numbers) {
    return std::string_view(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(numbers[0]));
  };
  vm::ByteWriter all;
  for (const NamedProgram& row : programs_of(scene)) {
    write(all, vm::digest(bytes_of(row.program->program().words)));
    write(all, vm::digest(bytes_of(row.program->program().doubles)));
  }
  for (int axis = 0; axis < 3; ++axis) all.f64(scene.origin[axis]);
  return vm::digest(all.bytes());
}

}  // namespace fathom::compiler
