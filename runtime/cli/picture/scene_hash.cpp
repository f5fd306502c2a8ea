#include "runtime/cli/picture/scene_hash.h"

#include "compiler/artefact/compiled_file.h"
#include "vm/encoding/bytes.h"
#include "vm/encoding/digest.h"

namespace fathom::cli {
namespace {

void absorb(const vm::VerifiedProgram& program, vm::ByteWriter& bytes) {
  bytes.u64(program.program().words.size());
  for (const std::uint32_t word : program.program().words) bytes.u32(word);
  for (const double doubles : program.program().doubles) bytes.f64(doubles);
}

void absorb(const compiler::CompiledField& field, vm::ByteWriter& bytes) {
  absorb(field.distance, bytes);
  absorb(field.surface, bytes);
}

}  // namespace

// Film and settings are left out: the command line may override them, some change no sample, and the identity has
// rows of its own for the others.
std::string scene_hash(const compiler::CompiledScene& scene) {
  compiler::CompiledScene rest = scene;
  rest.film = {};
  rest.settings = {};
  return compiler::scene_digest(rest).text();
}

std::string program_hash(const compiler::CompiledScene& scene) {
  vm::ByteWriter bytes;
  absorb(static_cast<const compiler::CompiledField&>(scene), bytes);
  for (const compiler::Medium& medium : scene.media)
    absorb(static_cast<const compiler::CompiledField&>(medium), bytes);
  for (const vm::VerifiedProgram& formula : scene.formulas) absorb(formula, bytes);
  for (int i = 0; i < 3; ++i) bytes.f64(scene.origin[i]);
  return vm::digest(bytes.bytes()).text();
}

}  // namespace fathom::cli
