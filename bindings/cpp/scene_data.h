// A compiled scene of the library, and what its methods prepare once.
// Tested by: tests/bindings/library_test.cpp
#pragma once

#include <atomic>
#include <fathom/fathom.hpp>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "compiler/frontend/records/parameters.h"
#include "compiler/scene/compiled_scene.h"
#include "compiler/source/limits.h"
#include "runtime/field/field.h"
#include "vm/native/native_program.h"

namespace fathom {

struct __attribute__((visibility("hidden"))) Scene::Data {
  explicit Data(compiler::CompiledScene compiled) : scene(std::move(compiled)) {}

  compiler::CompiledScene scene;
  compiler::Limits limits;
  compiler::Definitions definitions;  // values that the scene was compiled with
  bool has_text = true;               // false for a compiled file without text
  // The scene is a model of another format: a render compiles it again, on a stage with a light and a camera.
  bool foreign = false;

  // Machine code of the distance program, or null: then the interpreter evaluates, with the same bits. Compiled when
  // the points so far and `count` more repay it.
  const vm::NativeProgram* native(std::size_t count) const;
  // The field as marchers need it. Building it evaluates the scene, so only march() does.
  const runtime::Field& field() const;

 private:
  mutable std::atomic<std::uint64_t> evaluated_{0};
  mutable std::once_flag native_once_, field_once_;
  mutable std::shared_ptr<const vm::NativeProgram> native_;
  mutable std::optional<runtime::Field> field_;
};

namespace library {

// The first byte of a packed scene. A compiled file follows.
inline constexpr char kScene = 'S', kForeign = 'F';

inline Vec3d to_vec3(glm::dvec3 v) { return {v.x, v.y, v.z}; }
inline glm::dvec3 to_glm(Vec3d v) { return {v.x, v.y, v.z}; }

// Returns the error that a box has NaN, or corners in the wrong order, or none.
Error check_box(std::string_view name, const Box& box);

// Compiles the scene's text again, with other definitions after its own, for the picture: on a stage if the scene is
// `foreign`. Returns nullopt after an error, with a message.
std::optional<compiler::CompiledScene> compile_picture(const Scene::Data& data, const compiler::Definitions& more,
                                                       std::optional<glm::dvec3> origin, std::string& message);

}  // namespace library
}  // namespace fathom
