// Scenes that elaborate() and derive() make of JSON text, and helpers to inspect them.
#pragma once

#include <fmt/format.h>

#include <optional>
#include <string>
#include <utility>

#include "compiler/derive/derive.h"
#include "compiler/frontend/elaborate/elaborate.h"
#include "compiler/frontend/syntax/json.h"
#include "compiler/shapes/print_graph.h"
#include "tests/support/catch.h"

namespace fathom::test {

inline compiler::ElaboratedScene elaborated(const std::string& text, const compiler::Definitions& definitions = {}) {
  const compiler::Source source("scene.json", text);
  compiler::Diagnostics diagnostics;
  const auto file = compiler::read_json(source, diagnostics);
  std::optional<compiler::ElaboratedScene> out;
  if (file) out = compiler::elaborate(*file, diagnostics, definitions);
  if (out) {
    const auto scene = compiler::derive(out->scene, out->type_spans, {}, diagnostics);
    if (scene) out->scene = *scene;
  }
  INFO(diagnostics.print(source, compiler::ErrorFormat::Text));
  REQUIRE(out.has_value());
  REQUIRE(!diagnostics.has_errors());
  return std::move(*out);
}

inline compiler::ElaboratedScene of_objects(const std::string& objects, const std::string& rest = "") {
  return elaborated(R"({"version": 1, "objects": [)" + objects + "]" + rest + "}");
}

// The graph's listing without source locations.
inline std::string listing(const compiler::ElaboratedScene& e) {
  const std::string text = compiler::print_graph(e.scene, compiler::Source());
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = text.find('\n', at);
    const std::string line = text.substr(at, end - at);
    out += line.substr(0, line.find_last_not_of(' ', line.find(';') - 1) + 1) + "\n";
    at = end + 1;
  }
  return out;
}

inline std::string surfaces(const compiler::ElaboratedScene& e) {
  std::string out;
  for (const compiler::Surface& s : e.surfaces) out += fmt::format("{}:{} ", s.name, e.materials[s.material].name);
  return out;
}

}  // namespace fathom::test
