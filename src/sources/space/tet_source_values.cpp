#include "sources/space/tet_source_values.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/index.h"
#include "base/option_table.h"
#include "sources/space/space_distances.h"
#include "sources/surface/source_values.h"
#include "spatial/point_tree.h"

namespace littoral {

namespace {

double to_corner(const TetMesh& mesh, const TetPoint& p, int k) {
  Vec3 x = Vec3::Zero();
  for (int i = 0; i < 4; ++i)
    x += p.barycentric[i] * mesh.points.row(mesh.tets(p.tet, i)).transpose();
  return (mesh.points.row(mesh.tets(p.tet, k)).transpose() - x).norm();
}

}  // namespace

void merge_vertices(std::vector<int>& vertices, std::vector<double>& values) {
  std::map<int, double> least;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const double value = values.empty() ? 0 : values[i];
    const auto [at, is_new] = least.try_emplace(vertices[i], value);
    if (!is_new) at->second = std::min(at->second, value);
  }
  const bool valued = !values.empty();
  vertices.clear();
  values.clear();
  for (const auto& [v, value] : least) {
    vertices.push_back(v);
    if (valued) values.push_back(value);
  }
}

std::vector<double> values_of_triangles(const PolygonSoup& polygons,
                                        const std::vector<double>& of_faces) {
  std::vector<double> out;
  for (int f = 0; f < polygons.n_faces(); ++f)
    for (std::size_t k = 2; k < polygons.face(f).size(); ++k) out.push_back(of_faces[f]);
  return out;
}

std::vector<double> values_of_samples(const PolygonSoup& surface, const OrientedPoints& samples,
                                      const std::vector<double>& values) {
  std::vector<double> out;
  if (surface.n_faces() == 0) {
    const PointTree points(surface.points);
    for (const auto& x : samples.points.rowwise())
      out.push_back(values[points.nearest(x.transpose()).point]);
    return out;
  }
  const NearestSource nearest(surface, samples);
  for (const auto& x : samples.points.rowwise())
    out.push_back(values[nearest.triangle_at(x.transpose())]);
  return out;
}

void warn_of_shadowed(const TetMesh& mesh, const TetOperators& ops,
                      const std::vector<ValuedPlace>& sources, double unit, Report& report) {
  std::vector<EdgePaths::Edge> edges;
  for (int t = 0; t < mesh.n_tets(); ++t)
    for (int i = 0; i < 4 && ops.volumes[t] > 0; ++i)
      for (int j = 0; j < i; ++j) {
        const int a = mesh.tets(t, i), b = mesh.tets(t, j);
        edges.push_back({a, b, (mesh.points.row(a) - mesh.points.row(b)).norm()});
      }
  std::vector<EdgePaths::Start> from;
  for (const ValuedPlace& source : sources)
    for (int k = 0; k < 4 && source.at.tet >= 0; ++k)
      from.push_back({mesh.tets(source.at.tet, k), source.value + to_corner(mesh, source.at, k)});
  const VecX reach = EdgePaths(mesh.n_vertices(), edges).lengths(from);
  std::map<double, double> excess;  // value -> largest
  for (const ValuedPlace& source : sources) {
    if (source.at.tet < 0) continue;
    double least = infinity;
    for (int k = 0; k < 4; ++k)
      least = std::min(least, reach[mesh.tets(source.at.tet, k)] + to_corner(mesh, source.at, k));
    const double over = source.value - least;
    if (!(over > 1e-9 * (1 + std::abs(source.value) + std::abs(least)))) continue;
    double& most = excess[source.value];
    most = std::max(most, over);
  }
  std::vector<std::pair<std::string, double>> named;
  for (const auto& [value, most] : excess)
    named.emplace_back("the source of value " + rounded_text(value * unit), most * unit);
  warn_of_shadowed(named, report);
}

}  // namespace littoral
