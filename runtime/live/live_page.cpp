#include "runtime/live/live_page.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string_view>

#include "runtime/chart/markup.h"
#include "runtime/live/live_files.h"
#include "runtime/live/live_scene.h"

namespace fathom::runtime {
namespace {

// Returns JSON as the text of an element. It must not contain `<`, because a name could end the element: all text of
// the scene, and so its shader, whose comments have names, is in this one.
std::string as_element(const nlohmann::json& value) {
  std::string text;
  for (const char c : value.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace)) {
    if (c == '<')
      text += "\\u003c";
    else
      text += c;
  }
  return text;
}

constexpr std::string_view kPage = R"(<!doctype html>
<html lang="en">
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'">
<title>{title}</title>
<style>
{style}</style>
<header><h1>{title}</h1><span id="status" role="status"></span></header>
<canvas id="view" aria-label="{title}"></canvas>
<footer><span>drag: orbit</span><span><kbd>Shift</kbd> drag: pan</span><span>wheel: zoom</span>
<span><kbd>W</kbd> <kbd>A</kbd> <kbd>S</kbd> <kbd>D</kbd> <kbd>Q</kbd> <kbd>E</kbd>: walk</span>
<span><kbd>Home</kbd>: the scene's camera</span><span><kbd>C</kbd>: copy the camera</span></footer>
<script type="application/json" id="scene">{scene}</script>
<script>
{script}</script>
</html>
)";

}  // namespace

std::string live_page(const compiler::CompiledScene& scene) {
  return fmt::format(fmt::runtime(kPage), fmt::arg("title", escape_markup(scene.source.name())),
                     fmt::arg("style", kLiveStyle), fmt::arg("scene", as_element(live_scene(scene))),
                     fmt::arg("script", kLiveScript));
}

}  // namespace fathom::runtime
