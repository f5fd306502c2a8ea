// A small markup checker: elements are closed in order, attributes are quoted and unique, every & is escaped.
#pragma once

#include <cctype>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace fathom::test {

// Returns the first error, or an empty string. Knows the HTML elements without an end tag.
inline std::string what_is_wrong(const std::string& markup) {
  static const std::set<std::string> kWithoutEnd = {"meta", "img", "br", "link"};
  static const std::regex kAttribute(R"re(\s+([A-Za-z][A-Za-z0-9:-]*)="([^"<]*)")re");
  static const std::regex kEntity("^&(amp|lt|gt|quot|#39);");
  std::vector<std::string> open;
  for (std::size_t at = 0; at < markup.size();) {
    const std::string near = " near `" + markup.substr(at, 60) + "`";
    if (markup[at] == '&' && !std::regex_search(markup.substr(at, 8), kEntity)) return "a bare &" + near;
    if (markup[at] == '>') return "a bare >" + near;
    if (markup[at] != '<') {
      if (static_cast<unsigned char>(markup[at]) < 0x20 && !std::isspace(static_cast<unsigned char>(markup[at]))) {
        return "a control character" + near;
      }
      ++at;
      continue;
    }
    const std::size_t end = markup.find('>', at);
    if (end == std::string::npos) return "a tag without end" + near;
    std::string tag = markup.substr(at + 1, end - at - 1);
    at = end + 1;
    if (tag == "!DOCTYPE html") continue;
    if (tag[0] == '/') {
      if (open.empty() || open.back() != tag.substr(1)) return "an end without its beginning" + near;
      open.pop_back();
      continue;
    }
    const bool closed = tag.back() == '/';
    if (closed) tag.pop_back();
    const std::string name = tag.substr(0, tag.find_first_of(" \n"));
    std::string rest = tag.substr(name.size());
    std::set<std::string> names;
    for (std::smatch match; std::regex_search(rest, match, kAttribute, std::regex_constants::match_continuous);) {
      if (!names.insert(match[1]).second) return "an attribute twice" + near;
      rest = match.suffix();
    }
    if (rest.find_first_not_of(" \n") != std::string::npos) return "attributes that are none" + near;
    if (closed || kWithoutEnd.count(name) != 0) continue;
    open.push_back(name);
    if (name == "style") at = markup.find("</style>", at);
  }
  return open.empty() ? "" : "no end of " + open.back();
}

}  // namespace fathom::test
