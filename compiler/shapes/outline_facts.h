// Facts about each outline in addition to its opcode: which parameters fit together, the immediates of the opcode,
// and a box around the outline, infinite along z. All functions take the parameters in the order of the node table.
#pragma once

#include <vector>

#include "compiler/shapes/node_table.h"

namespace fathom::compiler {

Complaint check_rounded_rectangle(Params p);
Complaint check_segment(Params p);
Complaint check_polygon(Params p);
Complaint check_regular_polygon(Params p);
Complaint check_star(Params p);
Complaint check_trapezoid(Params p);
Complaint check_uneven_capsule(Params p);
Complaint check_arc(Params p);
Complaint check_pie(Params p);
Complaint check_cut_disk(Params p);
Complaint check_horseshoe(Params p);
Complaint check_lens(Params p);
Complaint check_moon(Params p);
Complaint check_egg(Params p);
Complaint check_cross(Params p);
Complaint check_rounded_x(Params p);

std::vector<double> rounded_rectangle_immediates(Params p);
std::vector<double> segment_immediates(Params p);
std::vector<double> regular_polygon_immediates(Params p);
std::vector<double> star_immediates(Params p);
std::vector<double> trapezoid_immediates(Params p);
std::vector<double> parallelogram_immediates(Params p);
std::vector<double> diamond_immediates(Params p);
std::vector<double> isosceles_triangle_immediates(Params p);
std::vector<double> arc_immediates(Params p);
std::vector<double> cut_disk_immediates(Params p);
std::vector<double> horseshoe_immediates(Params p);
std::vector<double> lens_immediates(Params p);
std::vector<double> moon_immediates(Params p);
std::vector<double> egg_immediates(Params p);
std::vector<double> rounded_x_immediates(Params p);
std::vector<double> ellipse_immediates(Params p);

// A closed outline, of 180 degrees, has no ends.
Code ring_code(Params p);
Code pie_code(Params p);

Box square_bound(Params p);      // the first parameter is the half extent in x and y
Box half_sizes_bound(Params p);  // the first two parameters are the half extents
Box segment_bound(Params p);
Box polygon_bound(Params p);
Box regular_polygon_bound(Params p);
Box star_bound(Params p);
Box trapezoid_bound(Params p);
Box parallelogram_bound(Params p);
Box isosceles_triangle_bound(Params p);
Box uneven_capsule_bound(Params p);
Box arc_bound(Params p);
Box ring_bound(Params p);
Box pie_bound(Params p);
Box cut_disk_bound(Params p);
Box horseshoe_bound(Params p);
Box lens_bound(Params p);
Box moon_bound(Params p);
Box egg_bound(Params p);
Box heart_bound(Params p);

double segment_magnitude(Params p);
double polygon_magnitude(Params p);
double moon_magnitude(Params p);

}  // namespace fathom::compiler
