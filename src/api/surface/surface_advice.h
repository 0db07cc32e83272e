#pragma once
// What `littoral info` adds to counts: how thick a shape is, its likely unit, and what suits it.

#include <string>
#include <vector>

#include "littoral/polygon_soup.h"

namespace littoral {

/// Diameters of the largest balls that touch a closed surface from its inside, at `samples` points
/// spread evenly over its area: ascending, without those that found none. The side that the volume
/// of the whole is on counts as the inside.
///
/// Shrinking balls: the ball through x with its centre on the normal, and through the point nearest
/// to its centre, is smaller, until no point lies in it (Ma, Bae, Choi, "3D medial axis point
/// approximation using nearest neighbors and the normal field", 2012).
std::vector<double> inner_ball_diameters(const PolygonSoup& triangles, int samples);

/// By the longest side alone; a guess.
std::string guess_unit(double longest_side);

/// What decides which methods suit a surface or cloud.
struct SurfaceTraits {
  bool has_faces = false, has_normals = false, only_triangles = false;
  bool closed = false, watertight = false, orientable = true;
  double boundary_loops = 0, nonmanifold_edges = 0, turned = 0, crossing = 0;
  double smallest_angle = 60;  // [degrees]
};
/// One or a few sentences: a method, or what to do first, and why.
std::string recommendation_for(const SurfaceTraits& traits);

}  // namespace littoral
