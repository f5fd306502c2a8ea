#include "compiler/artefact/listing.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "compiler/artefact/fields.h"
#include "compiler/artefact/programs.h"
#include "compiler/artefact/text_archive.h"
#include "vm/encoding/assemble.h"
#include "vm/encoding/binary.h"
#include "vm/encoding/disassemble.h"
#include "vm/encoding/escape.h"

namespace fathom::compiler {
namespace {

constexpr std::string_view kListingHead = "fathom";

// The lines of a text, each after a bar, so that anything can stand in them.
std::string barred(std::string_view text) {
  std::string out;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    out += "|" + vm::escape(text.substr(at, end - at)) + "\n";
    at = end + 1;
  }
  return out;
}

vm::VerifiedProgram without_debug(const vm::VerifiedProgram& program) { return vm::with_debug(program, {}); }

std::string file_name(const Source& source) { return std::filesystem::path(source.name()).filename().string(); }

class ListingReader {
 public:
  ListingReader(const Source& source, Diagnostics& diagnostics)
      : source_(source), text_(source.text()), diagnostics_(diagnostics) {}

  // A whole file: its programs first, for the tables are checked against them.
  std::optional<CompiledScene> read_all(FileContents& contents) {
    TextArchiveReader in(text_);
    read_head(in);
    if (in.failed()) return refuse(in);
    const std::size_t tables = in.at();
    std::optional<ProgramList> list = read_programs(contents);
    if (!list) return std::nullopt;
    CompiledScene scene = std::move(*list).scene();
    TextArchiveReader table_reader(std::string_view(text_).substr(0, programs_begin_));
    table_reader.skip_to(tables);
    record(table_reader, "tables", scene);
    if (!table_reader.failed() && !table_reader.next().empty()) {
      table_reader.fail("here a program should begin: `program distance {`");
    }
    if (table_reader.failed()) return refuse(table_reader);
    if (const auto fault = check_tags(scene)) return refuse_tag(bodies_[fault->program], *fault);
    contents.text = text_found_;
    contents.definitions = std::move(definitions_);
    if (text_found_ && !set_source(scene)) return std::nullopt;
    place_picture(scene);
    return scene;
  }

  // A listing of one program.
  std::optional<CompiledScene> read_one(FileContents& contents) {
    std::optional<vm::VerifiedProgram> program = assemble(0, text_.size());
    if (!program) return std::nullopt;
    ProgramList list(0, 0);
    list.add(*program);
    list.add(std::move(*program));
    CompiledScene scene = std::move(list).scene();
    scene.bound = Box::everything();
    if (!name_surfaces(scene)) return std::nullopt;
    scene.materials.emplace_back().name = "white";
    scene.background.bottom = scene.background.top = glm::dvec3(1);
    scene.summary = "a program, nothing is proved";
    contents = {has_debug(scene.distance), false, {}};
    return scene;
  }

 private:
  bool set_source(CompiledScene& scene) {
    scene.source = Source(std::move(text_name_), std::move(texts_[0].text));
    for (std::size_t i = 1; i < texts_.size(); ++i) {
      if (add_import(scene.source, texts_[i].path, std::move(texts_[i].text))) continue;
      return report(texts_[i].place, fmt::format("`{}` is no path of an import, or here twice", texts_[i].path));
    }
    return true;
  }

  // As many as the tags of a program alone name.
  bool name_surfaces(CompiledScene& scene) {
    constexpr std::size_t kMostSurfaces = 65536;
    const std::size_t named = std::min(surfaces_named(scene.distance), kMostSurfaces);
    for (std::size_t i = 0; i < named; ++i) scene.surfaces.push_back({fmt::format("surface {}", i), 0, false});
    const auto fault = check_tags(scene);
    if (!fault) return true;
    return report(line_of_word(0, text_.size(), fault->word),
                  fmt::format("a program alone has {} surfaces at most", kMostSurfaces));
  }
  void read_head(TextArchiveReader& in) {
    in.expect(kListingHead);
    in.expect(std::to_string(kFileVersion));
    in.expect("machine");
    if (!in.failed() && in.next() != vm::opcode_digest().text())
      in.fail("this is another machine than this program's");
  }

  // All "program NAME {" ... "}" and the text, which begin at the start of a line.
  std::optional<ProgramList> read_programs(FileContents& contents) {
    std::vector<std::pair<std::string, Span>> bodies;
    programs_begin_ = text_.size();
    for (std::size_t at = 0; at < text_.size();) {
      const std::size_t end = std::min(text_.find('\n', at), text_.size());
      std::string_view line = std::string_view(text_).substr(at, end - at);
      line.remove_suffix(line.size() - std::min(line.find_last_not_of(" \t\r") + 1, line.size()));
      if (line.starts_with("program ") && line.ends_with(" {")) {
        const std::size_t close = std::min(text_.find("\n}", end), text_.size());
        if (close == text_.size())
          return error_at<ProgramList>(span(at, end), "this program has no end: `}` on a line of its own");
        programs_begin_ = std::min(programs_begin_, at);
        bodies.push_back({std::string(line.substr(8, line.size() - 10)), span(end + 1, close + 1)});
        at = close + 3;
      } else if (line.starts_with("text ")) {
        programs_begin_ = std::min(programs_begin_, at);
        if (!read_text(at, end)) return std::nullopt;
        break;
      } else if (programs_begin_ < text_.size() && line.find_first_not_of(" \t\r") != line.npos && line[0] != ';') {
        return error_at<ProgramList>(span(at, end), "this is neither a program nor the text");
      } else {
        at = end + 1;
      }
    }
    return assemble_all(bodies, contents);
  }

  std::optional<ProgramList> assemble_all(const std::vector<std::pair<std::string, Span>>& bodies,
                                          FileContents& contents) {
    const auto starting = [&](std::string_view word) {
      return static_cast<std::size_t>(std::count_if(bodies.begin(), bodies.end(),
                                                    [&](const auto& body) { return body.first.starts_with(word); }));
    };
    ProgramList list(starting("medium") / 2, starting("formula"));
    contents.debug = false;
    for (const auto& [name, place] : bodies) {
      if (list.full() || name != list.next()) {
        return error_at<ProgramList>({place.begin, place.begin},
                                     fmt::format("program `{}` is out of order; `{}` should come here", name,
                                                 list.full() ? "no other" : list.next()));
      }
      std::optional<vm::VerifiedProgram> program = assemble(place.begin, place.end);
      if (!program) return std::nullopt;
      bodies_.push_back(place);
      contents.debug = contents.debug || has_debug(*program);
      list.add(std::move(*program));
    }
    if (list.full()) return list;
    return error_at<ProgramList>(span(text_.size(), text_.size()),
                                 fmt::format("program `{}` is missing before the end", list.next()));
  }

  std::optional<vm::VerifiedProgram> assemble(std::size_t begin, std::size_t end) {
    auto program = vm::assemble(std::string_view(text_).substr(begin, end - begin));
    if (const auto* wrong = std::get_if<vm::AssembleError>(&program)) {
      return refuse_line(begin, *wrong);
    }
    const std::vector<vm::DebugEntry> places = std::get<vm::Program>(program).debug;
    auto verified = vm::verify(std::get<vm::Program>(std::move(program)), largest_machine());
    if (const auto* wrong = std::get_if<vm::VerifyError>(&verified)) {
      return error_at<vm::VerifiedProgram>(line_of_word(begin, end, wrong->offset), wrong->reason);
    }
    return std::get<vm::VerifiedProgram>(std::move(verified));
  }

  std::optional<CompiledScene> refuse_tag(Span body, const TagFault& fault) {
    return error(line_of_word(body.begin, body.end, fault.word), fault.reason);
  }

  std::optional<vm::VerifiedProgram> refuse_line(std::size_t begin, const vm::AssembleError& wrong) {
    std::vector<std::string> help;
    if (wrong.unknown_instruction) {
      std::vector<std::string_view> mnemonics;
      for (std::uint32_t i = 0; i < vm::kOpcodeCount; ++i) mnemonics.push_back(vm::find_opcode(i)->mnemonic);
      const std::string_view word = std::string_view(text_).substr(begin + wrong.begin, wrong.end - wrong.begin);
      if (const std::string_view near = nearest(word, mnemonics); !near.empty()) {
        help.push_back(fmt::format("did you mean `{}`?", near));
      }
    }
    diagnostics_.error("E0701", span(begin + wrong.begin, begin + wrong.end), wrong.reason, "", std::move(help));
    return std::nullopt;
  }

  // The line of the instruction that the word is of: the assembler knows words, people know lines.
  Span line_of_word(std::size_t begin, std::size_t end, std::uint32_t word) const {
    std::size_t words = 0;
    for (std::size_t at = begin; at < end;) {
      const std::size_t line_end = std::min(text_.find('\n', at), end);
      const auto line = vm::assemble(std::string_view(text_).substr(at, line_end - at));
      if (const auto* program = std::get_if<vm::Program>(&line)) words += program->words.size();
      if (words > word) return span(at + std::min(text_.find_first_not_of(' ', at), line_end) - at, line_end);
      at = line_end + 1;
    }
    return span(end, end);
  }

  bool read_text(std::size_t begin, std::size_t end) {
    TextArchiveReader in(std::string_view(text_).substr(0, end));
    in.skip_to(begin);
    in.expect("text");
    in.text(text_name_);
    if (in.failed()) return report(span(in.fault_begin(), in.fault_end()), in.reason());
    for (std::size_t at = end + 1; at < text_.size();) {
      const std::size_t line_end = std::min(text_.find('\n', at), text_.size());
      std::string_view line = std::string_view(text_).substr(at, line_end - at);
      if (line.ends_with('\r')) line.remove_suffix(1);
      if (line.starts_with("define ") && !text_found_) {
        if (!read_definition(at, line_end)) return false;
        at = line_end + 1;
        continue;
      }
      if (line.starts_with("import ") && text_found_) {
        if (!read_import(at, line_end)) return false;
        at = line_end + 1;
        continue;
      }
      if (!text_found_) texts_.push_back({"", "", {}});
      FileText& file = texts_.back();
      if (!file.empty) file.text += '\n';
      if (!line.starts_with('|') || !vm::unescape(line.substr(1), file.text)) {
        return report(span(at, line_end), "a line of the text begins with |, and a backslash in it is written \\\\");
      }
      text_found_ = true, file.empty = false;
      at = line_end + 1;
    }
    return true;
  }

  // import "lib/gears.fathom", before its lines
  bool read_import(std::size_t begin, std::size_t end) {
    TextArchiveReader in(std::string_view(text_).substr(0, end));
    in.skip_to(begin);
    in.expect("import");
    FileText& file = texts_.emplace_back();
    file.place = span(begin, end);
    in.text(file.path);
    return in.failed() ? report(span(in.fault_begin(), in.fault_end()), in.reason()) : true;
  }

  // define "r" 0.5
  bool read_definition(std::size_t begin, std::size_t end) {
    TextArchiveReader in(std::string_view(text_).substr(0, end));
    in.skip_to(begin);
    auto& [name, value] = definitions_.emplace_back();
    in.expect("define");
    in.text(name);
    in.number(value);
    return in.failed() ? report(span(in.fault_begin(), in.fault_end()), in.reason()) : true;
  }

  std::optional<CompiledScene> refuse(const TextArchiveReader& in) {
    return error(span(in.fault_begin(), in.fault_end()), in.reason());
  }
  std::optional<CompiledScene> error(Span place, std::string reason) {
    return error_at<CompiledScene>(place, std::move(reason));
  }
  template <typename Nothing>
  std::optional<Nothing> error_at(Span place, std::string reason) {
    report(place, std::move(reason));
    return std::nullopt;
  }
  bool report(Span place, std::string reason) {
    diagnostics_.error("E0701", place, std::move(reason));
    return false;
  }
  static Span span(std::size_t begin, std::size_t end) {
    return {static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end)};
  }

  const Source& source_;
  const std::string& text_;
  Diagnostics& diagnostics_;
  std::size_t programs_begin_ = 0;
  std::vector<Span> bodies_;  // [program]
  bool text_found_ = false;
  std::string text_name_;
  struct FileText {
    std::string path, text;
    Span place;
    bool empty = true;  // no line of it was read
  };
  std::vector<FileText> texts_;  // the scene's own, then its imports
  Definitions definitions_;
};

}  // namespace

std::string write_listing(const CompiledScene& scene, const FileContents& contents) {
  TextArchiveWriter archive;
  record(archive, "tables", const_cast<CompiledScene&>(scene));  // a writer changes nothing
  std::string out =
      fmt::format("{} {}\nmachine {}\n{}", kListingHead, kFileVersion, vm::opcode_digest().text(), archive.out());
  for (const NamedProgram& row : programs_of(scene)) {
    const std::string listing = vm::disassemble(contents.debug ? *row.program : without_debug(*row.program));
    out += fmt::format("program {} {{\n{}}}\n", row.name, listing);
  }
  if (!contents.text) return out;
  out += fmt::format("text {}\n", vm::quote(file_name(scene.source)));
  for (const auto& [name, value] : contents.definitions) {
    out += fmt::format("define {} {}\n", vm::quote(name), value);
  }
  out += barred(scene.source.text());
  for (const Import& import : files_of(scene.source)) {
    out += fmt::format("import {}\n{}", vm::quote(import.path), barred(import.file->text()));
  }
  return out;
}

std::optional<CompiledScene> read_listing(const Source& listing, Diagnostics& diagnostics, FileContents& contents) {
  ListingReader reader(listing, diagnostics);
  TextArchiveReader in(listing.text());
  return in.next() == kListingHead ? reader.read_all(contents) : reader.read_one(contents);
}

}  // namespace fathom::compiler
