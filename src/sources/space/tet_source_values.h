#pragma once
// Values at sources in tets that distance is counted from.

#include <utility>
#include <vector>

#include "domain/tet/tet_lattice.h"
#include "littoral/polygon_soup.h"
#include "littoral/report.h"
#include "operators/tet_operators.h"
#include "sources/space/oriented_points.h"

namespace littoral {

/// Vertices in ascending order, each once with its least value; `values` may be empty and is then
/// left so.
void merge_vertices(std::vector<int>& vertices, std::vector<double>& values);

/// Values of the triangles that polygons are cut into.
std::vector<double> values_of_triangles(const PolygonSoup& polygons,
                                        const std::vector<double>& of_faces);

/// Values of the samples of triangles or, of a cloud, of its points.
std::vector<double> values_of_samples(const PolygonSoup& surface, const OrientedPoints& samples,
                                      const std::vector<double>& values);

/// What has one value in tets: where it is, by tets and barycentrics, and that value.
struct ValuedPlace {
  TetPoint at;
  double value;
};

/// Warns of values that other sources reach sooner along edges of tets: c_i > c_j + d(i, j) even
/// for these paths, which are no shorter than distance. unit: [length] of one unit of the mesh.
void warn_of_shadowed(const TetMesh& mesh, const TetOperators& ops,
                      const std::vector<ValuedPlace>& sources, double unit, Report& report);

}  // namespace littoral
