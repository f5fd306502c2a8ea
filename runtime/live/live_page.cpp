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
<canvas id="view" tabindex="0" aria-label="{title}"></canvas>
<form id="controls" autocomplete="off"><label>show <select id="overlay"></select></label>
<output id="overlay-key" for="overlay"></output>
<label>slice across <select id="slice-axis"><option value="-1">nothing</option><option value="0">x</option>
<option value="1">y</option><option value="2">z</option></select></label>
<label>at <input type="range" id="slice-at"> <output id="slice-place" for="slice-at"></output></label></form>
<footer><span>drag: orbit</span><span><kbd>Shift</kbd> drag: pan</span><span>wheel: zoom</span>
<span>double click: look at a point</span>
<span><kbd>W</kbd> <kbd>A</kbd> <kbd>S</kbd> <kbd>D</kbd> <kbd>Q</kbd> <kbd>E</kbd>: walk</span>
<span><kbd>Home</kbd>: the scene's camera</span><span><kbd>C</kbd>: copy the camera</span></footer>
<script type="application/json" id="scene">{scene}</script>
<script>
{script}{start}</script>
</html>
)";

// Follows the script of the live view, which other pages use, too.
constexpr std::string_view kStart = R"(
const byId = id => document.getElementById(id);
const view = new LiveView(byId("view"), text => { byId("status").textContent = text; });
connectOverlay(view, byId("overlay"), byId("overlay-key"));
connectSlice(view, {axis: byId("slice-axis"), at: byId("slice-at"), place: byId("slice-place")});
view.setScene(JSON.parse(byId("scene").textContent));
)";

}  // namespace

std::string live_page(const compiler::CompiledScene& scene) {
  nlohmann::json values = live_scene(scene);
  values["exactness"] = live_exactness(scene);
  return fmt::format(fmt::runtime(kPage), fmt::arg("title", escape_markup(scene.source.name())),
                     fmt::arg("style", kLiveStyle), fmt::arg("scene", as_element(values)),
                     fmt::arg("script", kLiveScript), fmt::arg("start", kStart));
}

}  // namespace fathom::runtime
