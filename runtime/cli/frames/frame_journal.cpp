#include "runtime/cli/frames/frame_journal.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "runtime/base/atomic_file.h"
#include "runtime/cli/frames/render_files.h"
#include "vm/encoding/bytes.h"
#include "vm/encoding/digest.h"

namespace fathom::cli {
namespace {

constexpr std::string_view kHead = "fathom frames 1";

std::optional<std::string> text_in(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return std::nullopt;
  std::ostringstream text;
  text << file.rdbuf();
  return file.good() || file.eof() ? std::optional(text.str()) : std::nullopt;
}

std::string digest_of(const std::string& text) {
  return vm::digest({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}).text();
}

// True if a row of the identity describes the scene. All other rows are settings.
bool is_of_scene(const std::string& row) { return row == "scene" || row == "program" || row == "moments"; }

std::string digest_of(const runtime::Identity& identity, bool scene, std::string text) {
  for (const auto& [row, value] : identity) {
    if (is_of_scene(row) == scene) text += fmt::format("{}={}\n", row, value);
  }
  return digest_of(text);
}

// Returns the settings that affect the output files but are not part of the identity.
std::string settings_beside(const runtime::FilmHeader& header, const RenderRequest& request) {
  std::string text = fmt::format("{}:{} bits {} denoise {}\n", header.samples.first, header.samples.last,
                                 request.bits, request.denoise);
  if (const auto& crop = request.options.crop)
    text += fmt::format("{},{},{},{}\n", crop->x0, crop->y0, crop->x1, crop->y1);
  for (const char* name : {"fathom.exposure", "fathom.tone"}) {
    const auto found = header.attributes.find(name);
    if (found == header.attributes.end()) continue;
    if (const auto* number = std::get_if<float>(&found->second)) text += fmt::format("{} {}\n", name, *number);
    if (const auto* word = std::get_if<std::string>(&found->second)) text += fmt::format("{} {}\n", name, *word);
  }
  for (const std::string& file : finished_files(request)) {
    text += std::filesystem::path(file).filename().string() + '\n';
  }
  return text;
}

// Returns a digest of the files' contents, or "" if a file cannot be read.
std::string digest_of_files(const std::vector<std::string>& files) {
  std::string digests;
  for (const std::string& file : files) {
    const auto text = text_in(file);
    if (!text) return "";
    digests += digest_of(*text);
  }
  return digest_of(digests);
}

FrameJournal::Entry entry_of(const runtime::FilmHeader& header, const RenderRequest& request) {
  return {digest_of(header.identity, true, ""), digest_of(header.identity, false, settings_beside(header, request)),
          digest_of_files(finished_files(request))};
}

}  // namespace

std::string FrameJournal::path_for(const std::string& output) {
  const std::filesystem::path path(output);
  std::string stem = path.stem().string();
  stem = stem.substr(0, stem.find('#'));
  while (!stem.empty() && std::string_view("-._ ").find(stem.back()) != std::string_view::npos) stem.pop_back();
  return (path.parent_path() / ((stem.empty() ? "out" : stem) + ".frames")).string();
}

std::optional<ExitCode> FrameJournal::read(const Streams& streams) {
  if (!runtime::stamp_of(path_)) return std::nullopt;
  const auto text = text_in(path_);
  if (!text) return fail(streams, kIo, fmt::format("cannot read `{}`, the journal of the frames", path_));
  auto entries = parse(*text);
  if (!entries) {
    return fail(streams, kBadScene, fmt::format("`{}` is no journal of frames, which would take its place", path_),
                {"give the output another name, or remove the file to render every frame"});
  }
  entries_ = *std::move(entries);
  return std::nullopt;
}

std::optional<std::map<int, FrameJournal::Entry>> FrameJournal::parse(const std::string& text) const {
  std::istringstream lines(text);
  std::string line;
  if (!std::getline(lines, line) || line != kHead) return std::nullopt;
  std::map<int, Entry> entries;
  while (std::getline(lines, line)) {
    std::istringstream words(line);
    int frame = -1;
    Entry entry;
    if (!(words >> frame >> entry.scene >> entry.settings >> entry.files) || frame < 0) return std::nullopt;
    entries[frame] = std::move(entry);
  }
  return entries;
}

bool FrameJournal::has(int frame, const runtime::FilmHeader& header, const RenderRequest& request) const {
  const auto found = entries_.find(frame);
  if (found == entries_.end()) return false;
  const Entry entry = entry_of(header, request);
  return !entry.files.empty() && entry == found->second;
}

std::optional<std::string> FrameJournal::add(int frame, const runtime::FilmHeader& header,
                                             const RenderRequest& request) {
  if (const auto text = text_in(path_)) {
    if (auto there = parse(*text)) entries_ = *std::move(there);
  }
  entries_[frame] = entry_of(header, request);
  std::string text(kHead);
  text += '\n';
  for (const auto& [number, entry] : entries_) {
    text += fmt::format("{} {} {} {}\n", number, entry.scene, entry.settings, entry.files);
  }
  return runtime::write_file({text.begin(), text.end()}, path_);
}

}  // namespace fathom::cli
