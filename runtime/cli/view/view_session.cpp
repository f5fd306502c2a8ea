#include "runtime/cli/view/view_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>

#include "runtime/cli/dump/program_json.h"
#include "runtime/cli/input/text_file.h"
#include "runtime/cli/options/output_file.h"
#include "runtime/cli/options/values.h"
#include "runtime/cli/view/keep_parameters.h"
#include "runtime/cli/view/listings.h"
#include "runtime/cli/view/pixel_answer.h"
#include "runtime/live/live_scene.h"

namespace fathom::cli {
namespace {

using nlohmann::json;

constexpr int kMinSide = 16, kMaxSide = 4096;  // of the true picture, pixels
constexpr std::int64_t kMaxPixels = std::int64_t{1} << 21;
constexpr double kLargest = 1e9;  // coordinate of a camera, scene units

std::string text_of(const json& value) { return value.dump(-1, ' ', false, json::error_handler_t::replace); }
Answer answer_of(const json& value) { return {.body = text_of(value)}; }
Answer text_answer(int status, std::string text) { return {status, "text/plain; charset=utf-8", std::move(text)}; }
Answer problem(int status, std::string reason) { return {.status = status, .body = text_of({{"error", reason}})}; }
Answer image_answer(const Bytes& bytes, int picture) {
  return {.type = "image/png", .body = std::string(bytes.begin(), bytes.end()), .picture = picture};
}

json limit(double value) { return std::isfinite(value) ? json(value) : json(nullptr); }

std::optional<double> number_at(const json& object, const char* name, double largest) {
  const auto found = object.is_object() ? object.find(name) : object.end();
  if (found == object.end() || !found->is_number()) return std::nullopt;
  const double value = found->get<double>();
  return std::abs(value) <= largest ? std::optional(value) : std::nullopt;
}

std::optional<glm::dvec3> vector_at(const json& object, const char* name) {
  const auto found = object.find(name);
  if (found == object.end() || !found->is_array() || found->size() != 3) return std::nullopt;
  glm::dvec3 v;
  for (int i = 0; i < 3; ++i) {
    const json& number = (*found)[static_cast<std::size_t>(i)];
    if (!number.is_number() || !(std::abs(number.get<double>()) <= kLargest)) return std::nullopt;
    v[i] = number.get<double>();
  }
  return v;
}

std::optional<CameraPose> read_pose(const json& camera) {
  if (!camera.is_object()) return std::nullopt;
  const auto position = vector_at(camera, "position"), target = vector_at(camera, "target"),
             up = vector_at(camera, "up");
  const auto half = camera.find("half");
  if (!position || !target || !up || half == camera.end() || !half->is_array() || half->size() != 2)
    return std::nullopt;
  if (!(*half)[0].is_number()) return std::nullopt;
  const double half_width = (*half)[0].get<double>();
  if (!(half_width > 1e-9 && half_width < kLargest) || !(glm::length(*up) > 0)) return std::nullopt;
  if (!(glm::length(*target - *position) > 0)) return std::nullopt;
  return CameraPose{*position, *target, *up, half_width, camera.value("orthographic", json(false)) == json(true)};
}

std::optional<PictureView> read_view(const json& request) {
  const auto id = number_at(request, "id", 1e9), width = number_at(request, "width", kMaxSide),
             height = number_at(request, "height", kMaxSide);
  if (!id || !width || !height || *width < kMinSide || *height < kMinSide) return std::nullopt;
  PictureView view{static_cast<int>(*id), static_cast<int>(*width), static_cast<int>(*height), std::nullopt};
  if (std::int64_t{view.width} * view.height > kMaxPixels) return std::nullopt;
  const auto camera = request.find("camera");
  if (camera == request.end() || camera->is_null()) return view;
  view.pose = read_pose(*camera);
  return view.pose ? std::optional(view) : std::nullopt;
}

// Returns the values of {"values": {name: number}}, or why there are none.
std::variant<compiler::Definitions, std::string> read_values(const std::string& body,
                                                             const std::vector<compiler::Parameter>& parameters) {
  const json request = json::parse(body, nullptr, false);
  const auto values = request.is_object() ? request.find("values") : request.end();
  if (!request.is_object() || values == request.end() || !values->is_object()) return "`values` is missing";
  compiler::Definitions definitions;
  for (const auto& [name, value] : values->items()) {
    const auto found = std::ranges::find(parameters, name, &compiler::Parameter::name);
    if (found == parameters.end()) return "the scene has no parameter of this name";
    if (!value.is_number()) return fmt::format("the value of `{}` is not a number", name);
    const auto number = value.get<double>();
    if (!(number >= found->min && number <= found->max) || !std::isfinite(number)) {
      return fmt::format("`{}` can be from {} to {}", name, found->min, found->max);
    }
    definitions.emplace_back(name, number);
  }
  return definitions;
}

json parameters_json(const LoadedScene& loaded) {
  json list = json::array();
  for (const compiler::Parameter& each : loaded.scene().parameters) {
    const auto own = std::ranges::find(loaded.defaults, each.name, &compiler::Parameter::name);
    list.push_back({{"name", each.name},
                    {"default", own == loaded.defaults.end() ? each.value : own->value},
                    {"value", each.value},
                    {"min", limit(each.min)},
                    {"max", limit(each.max)},
                    {"doc", each.doc}});
  }
  return list;
}

json picture_json(const Picture& picture) {
  return {{"number", picture.number},
          {"version", picture.scene->version},
          {"camera", picture.view.id},
          {"width", picture.film.width()},
          {"height", picture.film.height()},
          {"samples", picture.samples},
          {"spp", picture.spp},
          {"seconds", picture.seconds},
          {"noise", picture.noise ? limit(*picture.noise) : json(nullptr)},
          {"done", picture.done()}};
}

std::string event(const char* name, const json& data) {
  return fmt::format("event: {}\ndata: {}\n\n", name, text_of(data));
}

// Replaces the text of a file unless the file has changed. Returns the problem, if any.
std::optional<std::string> write_over(const SceneArguments& arguments, const std::string& before,
                                      const std::string& after) {
  std::istringstream in;
  std::ostringstream out, err;
  const auto now = read_text(arguments.path, arguments.limits, {in, out, err});
  if (const auto* error = std::get_if<ReadError>(&now)) return error->reason;
  if (std::get<std::string>(now) != before) return "the file has changed; try again";
  return write_text(after, arguments.path);
}

Denoise denoise_of(std::string_view text) {
  return text == "on" ? Denoise::On : text == "off" ? Denoise::Off : Denoise::Auto;
}

}  // namespace

ViewSession::ViewSession(const RenderRequest& request, int threads)
    : arguments_(request.scene),
      files_(threads),
      picture_(threads, [this] { on_picture(); }),
      scene_(request, [this] { on_scene(); }) {
  if (const auto loaded = scene_.state().loaded) picture_.set_scene(loaded);
}

ViewSession::~ViewSession() { stop(); }

void ViewSession::stop() {
  over_ = true;
  const std::lock_guard lock(mutex_);
  changed_.notify_all();
}

void ViewSession::on_scene() {
  const SceneState state = scene_.state();
  if (state.good) {
    picture_.set_scene(state.loaded);
    files_.cancel();
  }
  const std::lock_guard lock(mutex_);
  changed_.notify_all();
}

void ViewSession::on_picture() {
  const std::lock_guard lock(mutex_);
  changed_.notify_all();
}

std::string ViewSession::wait_for_events(Seen& seen, double seconds) {
  std::unique_lock lock(mutex_);
  std::string events;
  changed_.wait_for(lock, std::chrono::duration<double>(seconds), [&] {
    if (over_) return true;
    const SceneState state = scene_.state();
    const auto picture = picture_.latest();
    if (std::exchange(seen.scene, state.version) != state.version) {
      events += event("scene", {{"version", state.version}, {"good", state.good}});
    }
    if (picture && std::exchange(seen.picture, picture->number) != picture->number) {
      events += event("picture", picture_json(*picture));
    }
    return !events.empty();
  });
  return events.empty() ? ": nothing new\n\n" : events;
}

Answer ViewSession::get(std::string_view name, const Query& query) {
  if (name == "scene") return scene_answer();
  if (name == "picture") return picture_answer(query);
  if (name == "pixel") return pixel_answer_at(query);
  if (name == "pixels") return pixels_answer(query);
  if (name == "listing") return listing_answer(query);
  if (name == "program" || name == "exactness") {
    const auto loaded = scene_.state().loaded;
    if (!loaded) return problem(503, "there is no scene without errors yet");
    if (name == "program") return {.body = program_json(loaded->scene().surface, "surface", loaded->scene())};
    const std::lock_guard lock(asking_);
    return answer_of(runtime::live_exactness(loaded->scene()));
  }
  return problem(404, "there is nothing here");
}

Answer ViewSession::post(std::string_view name, const std::string& body) {
  if (name == "camera") return set_camera(body);
  if (name == "parameters") return set_parameters(body);
  if (name == "keep") return keep(body);
  return problem(404, "there is nothing here");
}

Answer ViewSession::scene_answer() const {
  const SceneState state = scene_.state();
  json answer = {{"version", state.version},
                 {"path", arguments_.path},
                 {"good", state.good},
                 {"messages", state.messages},
                 {"text", state.text},
                 {"live", nullptr},
                 {"name", std::filesystem::path(arguments_.path).filename().string()},
                 {"parameters", json::array()}};
  if (!state.loaded) return answer_of(answer);
  const compiler::CompiledScene& scene = state.loaded->scene();
  answer["live"] = state.loaded->live;
  answer["parameters"] = parameters_json(*state.loaded);
  answer["exposure"] = scene.film.exposure;
  answer["spp"] = scene.settings.spp;
  answer["width"] = scene.film.width, answer["height"] = scene.film.height;
  return answer_of(answer);
}

Answer ViewSession::picture_answer(const Query& query) {
  const auto picture = picture_.latest();
  if (!picture) return {.status = 204};  // an event announces it
  const std::string layer = query("layer");
  const double exposure = to_number(query("exposure")).value_or(0);
  const Bytes bytes = files_.encode(picture, layer.empty() ? "color" : layer, exposure, denoise_of(query("denoise")));
  if (bytes.empty()) return problem(400, "layer is one of color, albedo, normal, depth, evaluations, instructions");
  return image_answer(bytes, picture->number);
}

Answer ViewSession::pixel_answer_at(const Query& query) {
  const auto loaded = scene_.state().loaded;
  const PictureView view = picture_.view();
  if (!loaded || view.width == 0) return problem(503, "there is no picture yet");
  const auto x = to_number(query("x")), y = to_number(query("y"));
  if (!x || !y || *x < 0 || *y < 0 || *x > view.width || *y > view.height) {
    return problem(400, fmt::format("x and y are within {}x{}", view.width, view.height));
  }
  const std::lock_guard lock(asking_);
  const compiler::Camera camera = view_camera(loaded->scene(), view.pose, view.width, view.height);
  return answer_of(pixel_answer(loaded->scene(), camera, view.width, view.height, *x, *y));
}

Answer ViewSession::pixels_answer(const Query& query) {
  const auto loaded = scene_.state().loaded;
  const PictureView view = picture_.view();
  if (!loaded || view.width == 0) return problem(503, "there is no picture yet");
  const auto offset = to_number(query("offset"));
  const compiler::CompiledScene& scene = loaded->scene();
  if (!offset || *offset < 0 || *offset >= static_cast<double>(scene.surface.program().words.size())) {
    return problem(400, "offset is the place of an instruction");
  }
  const std::lock_guard lock(asking_);
  if (!relevance_ || relevance_view_ != std::pair(view.id, loaded->version)) {
    const compiler::Camera camera = view_camera(scene, view.pose, view.width, view.height);
    relevance_ = std::make_unique<Relevance>(scene, camera, view.width, view.height);
    relevance_view_ = {view.id, loaded->version};
  }
  const auto pixels = relevance_->pixels(static_cast<std::uint32_t>(*offset));
  return image_answer(mask_file(pixels, relevance_->width(), relevance_->height()), 0);
}

Answer ViewSession::listing_answer(const Query& query) {
  const auto loaded = scene_.state().loaded;
  if (!loaded) return problem(503, "there is no scene without errors yet");
  std::optional<glm::dvec3> point;
  if (const auto at = to_numbers(query("at"), 3, false)) point = glm::dvec3((*at)[0], (*at)[1], (*at)[2]);
  const std::lock_guard lock(asking_);
  Listing listing = make_listing(*loaded, query("kind"), point);
  return text_answer(listing.status, std::move(listing.text));
}

Answer ViewSession::set_camera(const std::string& body) {
  const json request = json::parse(body, nullptr, false);
  auto view = read_view(request);
  if (!view) {
    return problem(400, fmt::format("a view has id, width and height from {} to {}, at most {} pixels, and a camera "
                                    "with position, target, up, half and orthographic, or null",
                                    kMinSide, kMaxSide, kMaxPixels));
  }
  picture_.set_view(std::move(*view));
  files_.cancel();
  return {.status = 204};
}

Answer ViewSession::set_parameters(const std::string& body) {
  const auto loaded = scene_.state().loaded;
  if (!loaded) return problem(409, "there is no scene without errors yet");
  auto values = read_values(body, loaded->scene().parameters);
  if (const auto* reason = std::get_if<std::string>(&values)) return problem(400, *reason);
  scene_.define(std::get<compiler::Definitions>(std::move(values)));
  return {.status = 204};
}

// The file's text is that of the newest version, which must be without errors. A file changed since then is refused,
// so that nothing is lost.
Answer ViewSession::keep(const std::string& body) {
  const SceneState state = scene_.state();
  if (!state.good) return problem(409, "the file has errors; mend them first");
  auto values = read_values(body, state.loaded->scene().parameters);
  if (const auto* reason = std::get_if<std::string>(&values)) return problem(400, *reason);
  if (arguments_.path == "-" || state.loaded->input.stored) return problem(409, "the scene is not a text file");
  auto text = keep_parameters(state.loaded->input.source, std::get<compiler::Definitions>(values));
  if (const auto* error = std::get_if<KeepError>(&text)) return problem(409, error->reason);
  if (auto wrong = write_over(arguments_, state.text, std::get<std::string>(text))) return problem(409, *wrong);
  json names = json::array();
  for (const auto& [name, value] : std::get<compiler::Definitions>(values)) names.push_back(name);
  return answer_of({{"written", names}});
}

}  // namespace fathom::cli
