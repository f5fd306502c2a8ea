#include "compiler/frontend/text/parse/imports.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "compiler/frontend/syntax/json_error.h"
#include "compiler/frontend/text/parse/lexer.h"
#include "compiler/frontend/text/parse/parser.h"
#include "compiler/frontend/text/parse/standard_files.h"

namespace fathom::compiler::text {
namespace {

namespace fs = std::filesystem;

constexpr const char* kAsText = " (as text)";  // suffix of the name of a converted file

// Returns the location of an imported path, relative to the scene's folder.
std::string joined(const std::string& from, const std::string& path) {
  return (fs::path(from).parent_path() / path).lexically_normal().generic_string();
}

// True if an import's path, as written, is one of the library.
bool is_standard(std::string_view path) { return path.starts_with("std/"); }

// Returns the file at a path such as "std/gears" or "std/gears.fathom", or nullptr.
const EmbeddedFile* find_standard(std::string_view path) {
  constexpr std::string_view kFolder = "std/", kEnding = ".fathom";
  if (!is_standard(path)) return nullptr;
  path.remove_prefix(kFolder.size());
  if (path.ends_with(kEnding)) path.remove_suffix(kEnding.size());
  const auto files = standard_files();
  const auto found = std::ranges::find(files, path, &EmbeddedFile::name);
  return found == files.end() ? nullptr : &*found;
}

// Returns the location of an imported path, relative to the scene's folder. `from` is the location of the importer.
std::string path_of(const std::string& path, const std::string& from) {
  if (!is_standard(path)) return joined(from, path);
  const EmbeddedFile* const file = find_standard(path);
  return file ? fmt::format("std/{}.fathom", file->name) : path;
}

std::string names_of_standard_files() {
  std::vector<std::string> names;
  for (const EmbeddedFile& file : standard_files()) names.push_back(fmt::format("std/{}", file.name));
  return fmt::format("{}", fmt::join(names, ", "));
}

// Returns the reason why a path is invalid, or "" if the path is valid.
std::string fault_of(const std::string& path) {
  if (path.empty()) return "the path is empty";
  if (path.starts_with('/') || path.find(':') != std::string::npos) return "the path is not relative";
  if (path.find('\\') != std::string::npos) return "the path has a `\\`";
  if (path.ends_with('/')) return "the path is that of a folder";
  return "";
}

class ImportLoader {
 public:
  ImportLoader(Tree& tree, Source& source, const ImportReader& reader, const TextMaker& to_text, const Limits& limits,
               Diagnostics& diagnostics)
      : tree_(tree),
        source_(source),
        reader_(reader),
        to_text_(to_text),
        limits_(limits),
        diagnostics_(diagnostics) {
    paths_.push_back(fs::path(source.name()).filename().generic_string());
  }

  void run() {
    for (std::uint32_t module = 0; module < tree_.modules.size() && !full_; ++module) {
      const Module range = tree_.modules[module];  // a copy, because load() adds modules
      for (std::uint32_t i = range.begin; i < range.end && !full_; ++i) {
        if (tree_.statements[i].kind == Statement::Kind::Import) load(module, i);
      }
    }
  }

 private:
  void fail(Span span, std::string message, std::vector<std::string> help) {
    diagnostics_.error("E0810", span, std::move(message), "", std::move(help));
  }

  void load(std::uint32_t module, std::uint32_t number) {
    const Statement& statement = tree_.statements[number];
    const Span span = statement.span;
    if (const std::string fault = fault_of(statement.label); !fault.empty()) {
      return fail(span, fault, {"write it from the folder of this file, with / between names: \"lib/gears.fathom\""});
    }
    const std::string path = path_of(statement.label, paths_[module]);
    if (const auto circle = circle_of(paths_[module], path); !circle.empty()) {
      return fail(span, fmt::format("`{}` imports itself: {}", circle.front(), fmt::join(circle, " imports ")),
                  {"move what both need to a file of its own"});
    }
    imports_[paths_[module]].insert(path);
    const bool has_values = statement.has_fields;
    const auto known = plain_.find(path);
    if (!has_values && known != plain_.end()) {
      tree_.statements[number].target = known->second;
      return;
    }
    if (tree_.modules.size() > kMaxImports) {
      full_ = true;
      return fail(span, fmt::format("the scene has more than {} imports", kMaxImports),
                  {"imports of a file without values for its parameters count once"});
    }
    const Source* file = file_of(path, span);
    if (file == nullptr) return;
    const auto target = add(*file, path, number, has_values);
    if (!target) return;
    if (!has_values) plain_.emplace(path, *target);
    tree_.statements[number].target = *target;
  }

  // Returns the files of the import cycle that this import would close, or {} if it closes none.
  std::vector<std::string> circle_of(const std::string& from, const std::string& to) const {
    std::vector<std::string> way = {to};
    std::set<std::string> seen;
    const auto reaches = [&](const auto& self, const std::string& at) -> bool {
      if (at == from) return true;
      if (!seen.insert(at).second) return false;
      const auto next = imports_.find(at);
      if (next == imports_.end()) return false;
      return std::ranges::any_of(next->second, [&](const std::string& path) {
        way.push_back(path);
        if (self(self, path)) return true;
        way.pop_back();
        return false;
      });
    };
    if (!reaches(reaches, to)) return {};
    way.insert(way.begin(), from);
    return way;
  }

  // Returns the text of the file, or nullptr after an error.
  const Source* file_of(const std::string& path, Span span) {
    const auto found = files_.find(path);
    if (found != files_.end()) return found->second;
    const Source* file = read(path, span);
    if (file && first_word(file->text()) != "fathom") file = as_text(*file, path, span);
    files_.emplace(path, file);
    return file;
  }

  // Returns a file that the source already contains, or nullptr.
  const Source* known_file(const std::string& path, bool derived) const {
    const auto same = [&](const Import& import) { return import.path == path && import.derived == derived; };
    const auto found = std::ranges::find_if(source_.imports(), same);
    return found == source_.imports().end() ? nullptr : found->file.get();
  }

  const Source* read(const std::string& path, Span span) {
    if (const Source* known = known_file(path, false)) return known;
    if (const EmbeddedFile* file = find_standard(path)) return add_source(path, std::string(file->text), false, span);
    if (is_standard(path)) {
      fail(span, fmt::format("the library has no `{}`", path), {"there are " + names_of_standard_files()});
      return nullptr;
    }
    auto text = reader_ ? reader_(path) : ImportFault{"there are no files here", ""};
    if (const auto* fault = std::get_if<ImportFault>(&text)) {
      std::vector<std::string> help;
      help.push_back(fault->remedy.empty() ? "paths are from the folder of the file that has them" : fault->remedy);
      fail(span, fmt::format("`{}` cannot be imported: {}", path, fault->reason), std::move(help));
      return nullptr;
    }
    return add_source(path, std::get<std::string>(std::move(text)), false, span);
  }

  const Source* add_source(const std::string& path, std::string text, bool derived, Span span) {
    const auto size = static_cast<double>(source_.size() + text.size());
    if (size > limits_.file_size) {
      diagnostics_.error("E0008", span,
                         fmt::format("the scene and what it imports are more than {} bytes", limits_.file_size), "",
                         {raise(&Limits::file_size, size)});
      return nullptr;
    }
    const fs::path folder = is_standard(path) ? fs::path() : fs::path(source_.name()).parent_path();
    const std::string name = (folder / path).lexically_normal().string();
    const Source& file =
        source_.import(derived ? path + kAsText : path, derived ? name + kAsText : name, std::move(text), derived);
    Diagnostics faults;
    if (check_text(file, faults)) return &file;
    diagnostics_.append(faults, file.base());
    return nullptr;
  }

  const Source* as_text(const Source& file, const std::string& path, Span span) {
    if (const Source* known = known_file(path + kAsText, true)) return known;
    Diagnostics faults;
    std::optional<std::string> text = to_text_(Source(file.name(), file.text()), faults);
    if (text) return add_source(path, *std::move(text), true, span);
    diagnostics_.append(faults, file.base());
    return nullptr;
  }

  // Adds a module for the file. Returns nullopt after an error.
  std::optional<std::uint32_t> add(const Source& file, const std::string& path, std::uint32_t import, bool has_values) {
    const auto number = static_cast<std::uint32_t>(tree_.modules.size());
    const bool again = std::ranges::any_of(tree_.modules, [&](const Module& module) { return module.file == &file; });
    Limits left = limits_;
    for (const Module& module : tree_.modules) left.tokens -= static_cast<double>(module.tokens);
    Diagnostics ignored;
    if (!check_tokens(file, left, ignored)) {
      diagnostics_.error("E0008", tree_.statements[import].span,
                         fmt::format("the scene and what it imports have more than {} values, names and marks",
                                     limits_.tokens),
                         "", {raise(&Limits::tokens, 2 * limits_.tokens)});
      full_ = true;
      return std::nullopt;
    }
    const std::size_t errors = diagnostics_.errors();
    ParsedFile parsed = parse(file, again ? ignored : diagnostics_, limits_);
    if (diagnostics_.errors() > errors || ignored.has_errors()) return std::nullopt;
    paths_.push_back(path);
    append(tree_, std::move(parsed), {.file = &file, .values = import, .has_values = has_values, .again = again});
    return number;
  }

  Tree& tree_;
  Source& source_;
  const ImportReader& reader_;
  const TextMaker& to_text_;
  const Limits& limits_;
  Diagnostics& diagnostics_;
  std::vector<std::string> paths_;                         // [module]
  std::map<std::string, std::uint32_t> plain_;             // modules of imports without values, by path
  std::map<std::string, const Source*> files_;             // by path; null after an error
  std::map<std::string, std::set<std::string>> imports_;   // by path
  bool full_ = false;
};

}  // namespace

void append(Tree& tree, ParsedFile file, Module module) {
  module.begin = static_cast<std::uint32_t>(tree.statements.size());
  for (Statement& statement : file.statements) {
    statement.module = static_cast<std::uint32_t>(tree.modules.size());
    tree.statements.push_back(std::move(statement));
  }
  module.tokens = file.tokens;
  module.end = static_cast<std::uint32_t>(tree.statements.size());
  tree.modules.push_back(module);
  tree.expressions.push_back(std::move(file.expressions));
}

void load_imports(Tree& tree, Source& source, const ImportReader& reader, const TextMaker& to_text,
                  const Limits& limits, Diagnostics& diagnostics) {
  ImportLoader(tree, source, reader, to_text, limits, diagnostics).run();
}

}  // namespace fathom::compiler::text
