#include "compiler/artefact/archive.h"

#include <fmt/format.h>

#include <algorithm>

namespace fathom::compiler {

void value(Archive& archive, double& number, double least, double most) {
  double copy = number;
  archive.number(copy);
  if (archive.failed()) return;
  if (!(copy >= least && copy <= most)) {
    archive.fail(fmt::format("{} is not in [{}, {}]", copy, least, most));
  } else {
    number = copy;
  }
}

void value(Archive& archive, std::uint64_t& number, std::uint64_t least, std::uint64_t most) {
  std::uint64_t copy = number;
  archive.whole(copy);
  if (archive.failed()) return;
  if (copy < least || copy > most) {
    archive.fail(fmt::format("{} is not in {}..{}", copy, least, most));
  } else {
    number = copy;
  }
}

void field(Archive& archive, std::string_view name, bool& flag) {
  static constexpr std::string_view kNames[] = {"no", "yes"};
  std::size_t index = flag ? 1 : 0;
  archive.begin(name);
  archive.choice(index, kNames);
  archive.end();
  flag = index == 1;
}

void field(Archive& archive, std::string_view name, std::string& text) {
  archive.begin(name);
  archive.text(text);
  const bool printable =
      std::none_of(text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; });
  if (!printable) archive.fail("a control character in a text");
  archive.end();
}

void field(Archive& archive, std::string_view name, std::optional<double>& number, double least, double most) {
  archive.begin(name);
  const bool there = archive.present(number.has_value());
  if (archive.reading()) number = there ? std::optional(least) : std::nullopt;
  if (number && !archive.failed()) value(archive, *number, least, most);
  archive.end();
}

}  // namespace fathom::compiler
