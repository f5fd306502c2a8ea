// A thin part of the solid, or a thin gap, as a lattice sees it.
//
// A walk over balls without a zero, the largest first, explores the part from one of its points, up to where corners
// of the lattice are in sight: those are in the mesh. From a place between two pieces it goes on, in the neck there,
// up to corners of both. If the corners are of two pieces of the mesh, the mesh is torn at that place. If the walk
// meets none, the mesh has nothing of the part. A part that goes on in all directions of a plane is a sheet, and what
// lies on its two sides is one in the mesh.
// Tested by: tests/runtime/mesh/mesh_counts_test.cpp
#pragma once

#include <optional>

#include "runtime/mesh/lost/field_probe.h"
#include "runtime/mesh/lost/lattice_labels.h"
#include "runtime/mesh/lost/thin_places.h"

namespace fathom::runtime {

struct ThinRegion {
  enum class Fate { Kept, Lost, Torn };
  Fate fate = Fate::Kept;
  glm::dvec3 place{0};                 // in the middle of the part, programs' coordinates
  double thickness = 0;                // there, scene units; at most four cells
  std::uint32_t surfaces[2] = {0, 0};  // at its two faces, ascending, indices into CompiledScene::surfaces
  bool is_sheet = false;               // what lies on its two sides is one in the mesh
  bool tapers = false;                 // the part is thinner nearby, as wedges and tips are
  std::vector<std::uint32_t> labels;   // of the pieces that the part connects, if the mesh is torn
};

class ThinRegionSearch {
 public:
  static constexpr int kMostBalls = 600;

  // All arguments must outlive this object, which belongs to one thread. `most_balls`: of a walk.
  ThinRegionSearch(const MeshField& field, const CellLattice& lattice, const SignedLattice& signs,
                   const LatticeLabels& labels, int most_balls = kMostBalls)
      : probe_(field), lattice_(lattice), signs_(signs), labels_(labels), most_balls_(most_balls) {}

  // Examines the part that contains a place. `is_apart`: no surface of the mesh is near.
  ThinRegion examine(const ThinPlace& thin, bool is_apart);

  // Follows the gap between two points of one side to where it is narrower, and returns a point of their side if the
  // gap has an opening there.
  std::optional<glm::dvec3> follow_gap(glm::dvec3 from, glm::dvec3 to);

 private:
  static constexpr double kOpenWidth = 1.5;  // in cells: the mesh has parts that are wider

  // A part between two faces, and the direction from one to the other.
  struct Section {
    ProbedPoint middle;
    glm::dvec3 across;  // unit vector
    double width;       // scene units
  };
  struct Widths {
    double least, most;  // of a part near a section
  };
  struct Walked {
    std::vector<std::uint32_t> labels;  // ascending
    double largest = 0;                 // radius of the balls out of sight of corners, scene units
    bool is_explored = false;           // completely
    bool is_long = false;               // the part goes on beyond the reach of the walk
  };

  Section along(const ProbedPoint& from, glm::dvec3 direction);
  bool is_thick(const ProbedPoint& point) const { return 2 * point.radius > kOpenWidth * lattice_.cell; }
  ProbedPoint middle_of(const ProbedPoint& from);
  Section thinnest(const ProbedPoint& from);
  bool find_beside(const Section& from, glm::dvec3 target, double most, Section& found);
  bool ends(const Section& from, glm::dvec3 direction, Widths& widths);
  bool is_sheet(const Section& from, double& least);
  bool thins_out(const Section& from);
  void describe(const Section& section, ThinRegion& region);
  bool find_sheet(const ThinPlace& thin, const Section& section, ThinRegion& region);
  Walked explore(const ProbedPoint& from, bool passes_corners);
  bool add_contact(const ProbedPoint& point, LatticePlace at, std::vector<std::uint32_t>& labels);
  bool add_contacts(const ProbedPoint& point, std::vector<std::uint32_t>& labels);

  FieldProbe probe_;
  const CellLattice& lattice_;
  const SignedLattice& signs_;
  const LatticeLabels& labels_;
  const int most_balls_;
  std::vector<glm::dvec3> places_;
  std::vector<ProbedPoint> around_;
};

}  // namespace fathom::runtime
