#include <fmt/format.h>

#include <cmath>
#include <fathom/fathom.hpp>

#include "bindings/cpp/guard.h"
#include "bindings/cpp/scene_data.h"
#include "compiler/artefact/compiled_file.h"
#include "vm/interpret/evaluate.h"

namespace fathom {

Error library::check_box(std::string_view name, const Box& box) {
  const double lo[] = {box.lo.x, box.lo.y, box.lo.z}, hi[] = {box.hi.x, box.hi.y, box.hi.z};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (lo[axis] <= hi[axis]) continue;
    const bool is_nan = std::isnan(lo[axis]) || std::isnan(hi[axis]);
    return bad_argument(fmt::format("{}: {} from {} to {}", name, "xyz"[axis], lo[axis], hi[axis]) +
                        (is_nan ? " is not a number" : " has no inside"));
  }
  return {};
}

const char* version() noexcept { return FATHOM_VERSION; }

// The names are literals, so they end in a zero.
const char* instruction_set() noexcept { return vm::isa_name().data(); }

const vm::NativeProgram* Scene::Data::native(std::size_t count) const {
  constexpr std::uint64_t kMinEvaluations = 1'000'000;  // as in add_native_code()
  if (evaluated_.fetch_add(count, std::memory_order_relaxed) + count < kMinEvaluations) return nullptr;
  std::call_once(native_once_,
                 [this] { native_ = vm::NativeProgram::compile(scene.distance, vm::RecordedResults::Distance); });
  return native_.get();
}

const runtime::Field& Scene::Data::field() const {
  std::call_once(field_once_, [this] { field_ = runtime::make_field(scene); });
  return *field_;
}

Box Scene::bounds() const noexcept {
  if (!data_) return {{0, 0, 0}, {0, 0, 0}};
  const compiler::Box box = data_->scene.bound.moved(data_->scene.origin);
  return {library::to_vec3(box.lo), library::to_vec3(box.hi)};
}

double Scene::lipschitz() const noexcept { return data_ ? data_->scene.lipschitz : 0; }
bool Scene::certified() const noexcept { return data_ && data_->scene.certified; }
int Scene::width() const noexcept { return data_ ? data_->scene.film.width : 0; }
int Scene::height() const noexcept { return data_ ? data_->scene.film.height : 0; }
int Scene::samples() const noexcept { return data_ ? data_->scene.settings.spp : 0; }

Error Scene::objects(std::vector<std::string>& out) const noexcept {
  return library::guard([&]() -> Error {
    if (!data_) return library::bad_argument(library::kNoScene);
    out.clear();
    for (const compiler::Surface& surface : data_->scene.surfaces) out.push_back(surface.name);
    return {};
  });
}

Error Scene::pack(std::string& out) const noexcept {
  return library::guard([&]() -> Error {
    if (!data_) return library::bad_argument(library::kNoScene);
    const auto file = compiler::write_file(data_->scene, {true, data_->has_text, data_->definitions});
    out.assign(1, data_->foreign ? library::kForeign : library::kScene);
    out.append(file.begin(), file.end());
    return {};
  });
}

Error Scene::parameters(std::vector<Parameter>& out) const noexcept {
  return library::guard([&]() -> Error {
    if (!data_) return library::bad_argument(library::kNoScene);
    out.clear();
    for (const compiler::Parameter& each : data_->scene.parameters) {
      out.push_back({each.name, each.value, each.min, each.max, each.doc});
    }
    return {};
  });
}

}  // namespace fathom
