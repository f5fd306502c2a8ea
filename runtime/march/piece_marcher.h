// A marcher that follows rays from piece to piece (runtime/field/pieces.h) instead of through the whole scene's
// field.
//
// A ray begins the pieces whose boxes it meets, one after another in the order in which it enters them, and ends when
// the next box lies beyond its hit. Its hit depends on the ray and the pieces alone. If several roots lie within
// their brackets, the piece that comes first in the scene is hit: coincident faces have one surface.
//
// A ray within a solid follows a piece that it is in to its exit, goes on in another that the exit lies in, and ends
// at the exit that lies in none.
// Not a public header: march.h is. Tested by: tests/runtime/march/piece_marcher_test.cpp
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>
#include <memory>
#include <vector>

#include "runtime/field/piece_boxes.h"
#include "runtime/field/pieces.h"
#include "runtime/march/marcher.h"
#include "runtime/march/method.h"
#include "runtime/march/piece_proposals.h"
#include "runtime/march/piece_scan.h"
#include "runtime/march/piece_stream.h"
#include "runtime/march/stream.h"

namespace fathom::runtime {

class PieceMarcher final : public Marcher {
 public:
  PieceMarcher(const Field& field, const Marching& marching);

  MarchCounters counters() const override;

 private:
  struct Root {
    double t;  // from the clipped ray's origin
    float width;
    std::uint32_t piece;
    std::int8_t side;
  };
  // A ray under way. Its number is the id of its part within a piece.
  struct RayState {
    ClippedRay ray;
    float slope;
    std::uint32_t leaves;  // piece whose surface the ray leaves outwards, or kNoPiece
    std::int32_t piece;    // that the ray is in
    double from, to;       // the part of the ray there
    PieceBoxes::Visit visit;
    std::vector<Root> roots;  // in the order in which they were found; of a solid only the last
    double reach;             // no root beyond matters
    bool exact;               // a solid's: the root was found in double
    RayHit::Status miss;      // status without a root
    std::int8_t side;
    std::uint32_t evaluations, certified;
    std::uint64_t instructions;
  };
  // Searches in double.
  class Searches final : public Marcher {
   public:
    using Marcher::certify_from;
    using Marcher::Marcher;

   private:
    void begin(RayBlock&) override {}
    void step() override {}
  };

  void begin(RayBlock& rays) override;
  void step() override;
  void scan(RayBlock& rays);
  void begin_ray(const RayBlock& rays, std::size_t i);
  void begin_outside(std::uint32_t number, std::size_t i);
  static void add_root(RayState& state, double t, float width, std::uint32_t piece);
  int side_at(glm::dvec3 place);
  double clear_around(glm::dvec3 place);
  void begin_next_piece(std::uint32_t number);
  bool enter_solid(RayState& state, double t);
  void leave_piece(std::uint32_t number);
  double value_at(RayState& state, std::uint32_t piece, double t);
  void search_exit(std::uint32_t number);
  void start(std::uint32_t number);
  void answer(std::uint32_t shared);
  void advance_stream(std::uint32_t shared, std::size_t few);
  void advance(Marcher& part);
  bool advance_parts(std::size_t few);
  void end_piece(const RayHit& found);
  void end_ray(std::uint32_t number);

  const Pieces& pieces_;
  const Marching marching_;
  const std::size_t register_lanes_;  // points per register
  Searches searches_;
  std::vector<std::unique_ptr<PieceStream>> streams_;       // [template]
  std::vector<std::unique_ptr<Stream<float>>> own_;         // [template] of a piece with a field of its own
  std::vector<std::unique_ptr<PieceProposals>> proposals_;  // [template]
  std::unique_ptr<PieceScan> scan_;                         // null in a scene of many pieces
  std::size_t scanned_ = 0;  // number of waiting rays that were scanned, the first ones
  std::vector<RayState> states_;
  std::vector<std::uint32_t> free_, ready_;  // numbers of states: unused, and before their next piece
  std::vector<PieceProposals::Answer> answers_;
  std::vector<PieceStream::Ended> ended_;
  std::vector<RayHit> found_;
  glm::dvec3 place_{std::numeric_limits<double>::quiet_NaN()};  // where side_at() looked last
  int side_ = 1;                                                // there
  glm::dvec3 clear_place_{0.0};
  double clear_ = -1;  // within this distance of the place is no solid; below 0: not known yet
  PieceBoxes::Visit around_;                                    // the boxes around a place
  std::vector<std::uint32_t> others_;                           // pieces around an exit
};

}  // namespace fathom::runtime
