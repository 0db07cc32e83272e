#pragma once
// Which faces a surface point touches, and where in them it lies.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "domain/mesh/surface_mesh.h"
#include "littoral/surface_point.h"

namespace littoral {

/// The element a surface point lies in, for messages: "vertex 7", "edge 3", "face 12".
std::string element_name(const SurfacePoint& p);

/// Throws InputError, naming the element, where its number is out of range or it belongs to no
/// face.
void check_element(const SurfaceMesh& mesh, const SurfacePoint& p);

/// Coordinates may be off by this much, as numbers of six digits are.
inline constexpr double barycentric_slack = 1e-5;

/// What is wrong with the coordinates of a point on an edge or face, naming the element: not
/// finite, negative, or a sum that is not 1 (within the slack). Nothing if they are right.
std::string barycentric_fault(const SurfacePoint& p);

/// Throws that as an InputError.
void check_barycentrics(const SurfacePoint& p);

/// The same point named by the smallest element that holds it: a coordinate below 1e-12 of the sum
/// counts as zero, so a face point on a side becomes an edge point and one at a corner a vertex.
///
/// Triangle meshes only. Throws InputError naming the element where its number is out of range, it
/// belongs to no face, or the coordinates are not finite, negative or do not sum to 1 (within
/// the slack).
SurfacePoint simplest(const SurfaceMesh& mesh, const SurfacePoint& p);

/// Faces that contain the point (given in its simplest form), ascending, each once.
std::vector<int> faces_at(const SurfaceMesh& mesh, const SurfacePoint& p);

/// Barycentric coordinates of the point (simplest form) in a triangle, in the order of its corners;
/// none where the triangle does not contain the point. Coordinates off the point's element are
/// exactly 0.
std::optional<std::array<double, 3>> barycentrics_in(const SurfaceMesh& mesh, const SurfacePoint& p,
                                                     int face);

/// Does a face contain both points (simplest form)?
bool share_face(const SurfaceMesh& mesh, const SurfacePoint& p, const SurfacePoint& q);

/// The lowest face that contains both points (simplest form), one without repeated corners if there
/// is one; -1 if none does.
int common_face(const SurfaceMesh& mesh, const SurfacePoint& p, const SurfacePoint& q);

/// The edge that contains both points, ends included (simplest form); -1 if none does.
int common_edge(const SurfaceMesh& mesh, const SurfacePoint& p, const SurfacePoint& q);

/// Does the edge, ends included, contain the point (simplest form)?
bool on_closed_edge(const SurfaceMesh& mesh, const SurfacePoint& p, int edge);

}  // namespace littoral
