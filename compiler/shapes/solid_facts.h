// Facts about each solid primitive in addition to its opcode: which parameters fit together, the immediates of the
// opcode, and a box around the primitive. All functions take the parameters in the order of the node table.
#pragma once

#include <vector>

#include "compiler/shapes/node_table.h"

namespace fathom::compiler {

Complaint check_round_box(Params p);
Complaint check_rounded_cylinder(Params p);
Complaint check_cone(Params p);
Complaint check_round_cone(Params p);
Complaint check_triangle(Params p);
Complaint check_quad(Params p);
Complaint check_mandelbulb(Params p);
Complaint check_box_frame(Params p);
Complaint check_capped_torus(Params p);
Complaint check_half_angle(Params p);  // takes an angle alone, which must be below 90 degrees
Complaint check_menger_sponge(Params p);
Complaint check_julia(Params p);

std::vector<double> mandelbulb_immediates(Params p);
std::vector<double> round_box_immediates(Params p);
std::vector<double> plane_immediates(Params p);
std::vector<double> rounded_cylinder_immediates(Params p);
std::vector<double> cone_immediates(Params p);
std::vector<double> round_cone_immediates(Params p);
std::vector<double> sheet_immediates(Params p);  // triangle, quad
std::vector<double> box_frame_immediates(Params p);
std::vector<double> capped_torus_immediates(Params p);
std::vector<double> infinite_cone_immediates(Params p);
std::vector<double> tetrahedron_immediates(Params p);
std::vector<double> octahedron_immediates(Params p);
std::vector<double> dodecahedron_immediates(Params p);
std::vector<double> icosahedron_immediates(Params p);
std::vector<double> pyramid_immediates(Params p);
std::vector<double> periodic_immediates(Params p);  // gyroid, Schwarz P and D
std::vector<double> julia_immediates(Params p);

Box sphere_bound(Params p);
Box half_size_bound(Params p);
Box torus_bound(Params p);
Box plane_bound(Params p);
Box cylinder_bound(Params p);
Box cone_bound(Params p);
Box round_cone_bound(Params p);
Box sheet_bound(Params p);
Box mandelbulb_bound(Params p);
Box capped_torus_bound(Params p);
Box infinite_cylinder_bound(Params p);
Box infinite_cone_bound(Params p);
Box capsule_bound(Params p);
Box tetrahedron_bound(Params p);
Box dodecahedron_bound(Params p);
Box icosahedron_bound(Params p);
Box pyramid_bound(Params p);
Box everywhere(Params);
Box menger_sponge_bound(Params p);
Box julia_bound(Params p);

double torus_magnitude(Params p);
double sheet_magnitude(Params p);  // of the numbers that a triangle or quad is evaluated with, scene units

}  // namespace fathom::compiler
