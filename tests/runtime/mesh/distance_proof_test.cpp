#include "runtime/mesh/distance_proof.h"

#include "tests/support/catch.h"
#include "tests/support/compiled.h"

namespace fathom::distance_proof_test {

using namespace fathom::runtime;

TEST_CASE("distance proof: a triangle beside a plane is proved at its distance and not below", "[mesh]") {
  const auto scene = test::compiled_objects(R"({"type": "box", "half_size": [4, 1, 4]})");
  const Field prepared = make_field(scene);
  const MeshField field(prepared, compiler::Box::everything());
  for (const double height : {0.0, 0.05, -0.05}) {
    const DistanceProof::Corners up = {{{0, 1 + height, 0}, {0, 1 + height, 2}, {2, 1 + height, 0}}};
    DistanceProof proof(field);
    proof.add(up);
    CHECK(proof.is_near(0.065));
    CHECK(proof.holds(0.2, 0.06));
    CHECK(proof.is_near(0.01) == (height == 0));
    CHECK(proof.holds(0.2, 0.04) == (height == 0));
  }
}

TEST_CASE("distance proof: a triangle that faces the wrong way is near and does not hold", "[mesh]") {
  const auto scene = test::compiled_objects(R"({"type": "box", "half_size": [4, 1, 4]})");
  const Field prepared = make_field(scene);
  const MeshField field(prepared, compiler::Box::everything());
  DistanceProof proof(field);
  proof.add({{{0, 1, 0}, {2, 1, 0}, {0, 1, 2}}});
  CHECK_FALSE(proof.holds(0.1, 0.1));
  CHECK(proof.is_near(0.1));
}

TEST_CASE("distance proof: small features between samples are found", "[mesh]") {
  // A peg of 0.1 stands on the face, and the triangle passes through its foot.
  const auto scene = test::compiled(R"({"version": 1, "objects": [{"type": "box", "half_size": [4, 1, 4]},
    {"type": "box", "half_size": [0.05, 0.5, 0.05], "translate": [0.517, 1, 0.491]}]})");
  const Field prepared = make_field(scene);
  const MeshField field(prepared, compiler::Box::everything());
  DistanceProof proof(field);
  proof.add({{{0, 1, 0}, {0, 1, 2}, {2, 1, 0}}});
  CHECK(proof.is_near(0.5));
  CHECK_FALSE(proof.is_near(0.03));
}

}  // namespace fathom::distance_proof_test
