#include "compiler/artefact/listing.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <utility>

#include "compiler/artefact/fields.h"
#include "compiler/artefact/programs.h"
#include "vm/encoding/assemble.h"
#include "vm/encoding/binary.h"
#include "vm/encoding/disassemble.h"
#include "vm/encoding/escape.h"
#include "vm/program/opcode.h"
#include "vm/range/slope.h"

namespace fathom::compiler {
namespace {

constexpr std::string_view kListingHead = "fathom";

// Returns the lines of a text, each after a bar, so that no line can be taken for one of the listing.
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

// Reads the words of a line: bare words, and texts in quotes. `;` begins a comment. After the first failure, the
// other functions do nothing.
class Words {
 public:
  Words(std::string_view text, std::size_t at) : text_(text), at_(at) {}

  std::string_view next() {
    const std::size_t begin = std::min(text_.find_first_not_of(" \t\r\n", at_), text_.size());
    if (begin < text_.size() && text_[begin] == '"') {
      at_ = begin + std::max<std::size_t>(vm::quoted_length(text_.substr(begin)), 1);
    } else {
      at_ = std::min(text_.find_first_of(" \t\r\n;", begin), text_.size());
    }
    word_ = {static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(at_)};
    return text_.substr(begin, at_ - begin);
  }
  void expect(std::string_view word) {
    if (!failed() && next() != word) fail(fmt::format("`{}` should be here", word));
  }
  void text(std::string& text) {
    if (failed()) return;
    const std::string_view word = next();
    const bool quoted = word.size() >= 2 && word.front() == '"' && word.back() == '"';
    if (!quoted || !vm::unescape(word.substr(1, word.size() - 2), text)) fail("this should be a text in quotes");
  }
  void number(double& number) {
    if (failed()) return;
    const std::string_view word = next();
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    if (error != std::errc() || end != word.data() + word.size()) fail("this should be a number");
  }
  void skip_comment() {
    const std::size_t begin = text_.find_first_not_of(" \t", at_);
    if (begin < text_.size() && text_[begin] == ';') at_ = std::min(text_.find('\n', begin), text_.size());
  }
  void fail(std::string reason) { reason_ = std::move(reason); }
  bool failed() const { return !reason_.empty(); }
  const std::string& reason() const { return reason_; }
  Span word() const { return word_; }  // the last word, at fault after a failure
  std::size_t at() const { return at_; }

 private:
  std::string_view text_;
  std::size_t at_;
  Span word_{};
  std::string reason_;
};

class ListingReader {
 public:
  ListingReader(const Source& source, Diagnostics& diagnostics, const Limits& limits)
      : source_(source),
        text_(source.text()),
        diagnostics_(diagnostics),
        most_(static_cast<std::size_t>(limits.instructions)),
        left_(kPrograms * most_) {}

  // Reads a whole file. The programs come first, because the tables are checked against them.
  std::optional<CompiledScene> read_all(FileContents& contents) {
    Words head(text_, 0);
    head.expect(kListingHead);
    head.expect(std::to_string(kFileVersion));
    head.expect("machine");
    if (!head.failed() && head.next() != vm::opcode_digest().text())
      head.fail("this is another machine than this program's");
    head.skip_comment();
    head.expect("tables");
    if (head.failed()) return error(head.word(), head.reason());
    std::optional<ProgramList> list = read_programs(contents);
    if (!list) return std::nullopt;
    CompiledScene scene = std::move(*list).scene();
    if (!read_json(head, scene)) return std::nullopt;
    if (const auto fault = check_tags(scene)) {
      const Span body = bodies_[fault->program];
      return error(line_of_word(body.begin, body.end, fault->word), fault->reason);
    }
    contents.text = text_found_;
    contents.definitions = std::move(definitions_);
    if (text_found_ && !set_source(scene)) return std::nullopt;
    resolve_image_path(scene);
    return scene;
  }

  // Reads the listing of a single program.
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
    claim_slopes(scene);
    scene.summary = "a program alone, whose constants follow from intervals";
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

  // Reads the tables between the word `tables` and the first program.
  bool read_json(const Words& head, CompiledScene& scene) {
    const std::size_t begin = head.at(), end = std::max(begin, programs_begin_);
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(text_.data());
    auto parsed = parse_tables({bytes + begin, end - begin}, false);
    if (const auto* reason = std::get_if<std::string>(&parsed)) return report(head.word(), "the tables: " + *reason);
    Archive archive(std::get<TableJson>(std::move(parsed)));
    read_tables(archive, scene);
    return archive.failed() ? report(head.word(), "the tables: " + archive.reason()) : true;
  }

  // Sets the constants of a field, about which a program alone says nothing, to those that interval arithmetic shows.
  static void claim_slopes(CompiledField& field) {
    vm::Workspace workspace;
    const Box all = Box::everything();
    const vm::SlopeBound slope = vm::evaluate_slope(field.distance, all.lo, all.hi, workspace);
    if (slope.lipschitz > 0 && std::isfinite(slope.lipschitz)) field.lipschitz = slope.lipschitz;
    if (std::isfinite(slope.float_error)) field.cancellation = slope.float_error / vm::kFloatError;
  }

  // Names as many surfaces as the tags of a program alone need.
  bool name_surfaces(CompiledScene& scene) {
    constexpr std::size_t kMaxSurfaces = 65536;
    const std::size_t named = std::min(surfaces_named(scene.distance), kMaxSurfaces);
    for (std::size_t i = 0; i < named; ++i) scene.surfaces.push_back({fmt::format("surface {}", i), 0, false});
    const auto fault = check_tags(scene);
    if (!fault) return true;
    return report(line_of_word(0, text_.size(), fault->word),
                  fmt::format("a program alone has {} surfaces at most", kMaxSurfaces));
  }

  // Reads all "program NAME {" ... "}" and the text, which begin at the start of a line.
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
    auto program = vm::assemble(std::string_view(text_).substr(begin, end - begin), nullptr, std::min(most_, left_));
    if (const auto* wrong = std::get_if<vm::AssembleError>(&program)) {
      return refuse_line(begin, *wrong);
    }
    auto verified = vm::verify(std::get<vm::Program>(std::move(program)), largest_machine());
    if (const auto* wrong = std::get_if<vm::VerifyError>(&verified)) {
      return error_at<vm::VerifiedProgram>(line_of_word(begin, end, wrong->offset), wrong->reason);
    }
    auto& sound = std::get<vm::VerifiedProgram>(verified);
    left_ -= std::min<std::size_t>(left_, sound.instructions());
    return std::move(sound);
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

  // Returns the line of the instruction that the word belongs to: the assembler knows words, people know lines.
  Span line_of_word(std::size_t begin, std::size_t end, std::uint32_t word) const {
    std::vector<std::size_t> lines;
    const auto program =
        std::get<vm::Program>(vm::assemble(std::string_view(text_).substr(begin, end - begin), &lines, most_));
    std::size_t words = 0;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      words += vm::instruction_length(program.words[words]);
      if (words <= word) continue;
      const std::size_t at = begin + lines[i], line_end = std::min(text_.find('\n', at), end);
      return span(std::min(text_.find_first_not_of(' ', at), line_end), line_end);
    }
    return span(end, end);
  }

  bool read_text(std::size_t begin, std::size_t end) {
    Words words(std::string_view(text_).substr(0, end), begin);
    words.expect("text");
    words.text(text_name_);
    if (words.failed()) return report(words.word(), words.reason());
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

  // Reads `import "lib/gears.fathom"`, which precedes the lines of the import.
  bool read_import(std::size_t begin, std::size_t end) {
    Words words(std::string_view(text_).substr(0, end), begin);
    words.expect("import");
    FileText& file = texts_.emplace_back();
    file.place = span(begin, end);
    words.text(file.path);
    return words.failed() ? report(words.word(), words.reason()) : true;
  }

  // Reads `define "r" 0.5`.
  bool read_definition(std::size_t begin, std::size_t end) {
    Words words(std::string_view(text_).substr(0, end), begin);
    auto& [name, value] = definitions_.emplace_back();
    words.expect("define");
    words.text(name);
    words.number(value);
    return words.failed() ? report(words.word(), words.reason()) : true;
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
  static constexpr std::size_t kPrograms = 4;  // number of programs of the greatest size
  std::size_t most_, left_;                    // instructions of a program with rows, and of all that follow
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
  std::string out = fmt::format("{} {}\nmachine {}\ntables {}\n", kListingHead, kFileVersion,
                                vm::opcode_digest().text(), print_tables(tables_of(scene)));
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

std::optional<CompiledScene> read_listing(const Source& listing, Diagnostics& diagnostics, FileContents& contents,
                                          const Limits& limits) {
  ListingReader reader(listing, diagnostics, limits);
  return Words(listing.text(), 0).next() == kListingHead ? reader.read_all(contents) : reader.read_one(contents);
}

}  // namespace fathom::compiler
