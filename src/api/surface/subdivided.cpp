#include "api/surface/subdivided.h"

#include <array>
#include <vector>

#include "base/index.h"

namespace littoral {

PolygonSoup subdivided(const SurfaceMesh& mesh, const IntrinsicTriangulation& T, int n,
                       const VecX& at_vertices,
                       const std::function<double(int triangle, const Vec3& b)>& at) {
  std::vector<Vec3> points;
  std::vector<double> values;
  for (int v = 0; v < mesh.n_vertices(); ++v) {
    points.push_back(mesh.point(v));
    values.push_back(at_vertices[v]);
  }
  PolygonSoup soup;
  std::vector<int> first_on_edge(std::size_t(mesh.n_edges()), -1);
  for (int f = 0; f < mesh.n_faces(); ++f) {
    const int triangle = T.triangle_of_face[f];
    if (triangle < 0) continue;
    const auto corner = mesh.face(f);
    const auto add = [&](int i, int j) {  // the point i/n towards corner 1, j/n towards corner 2
      const Vec3 b(1 - double(i + j) / n, double(i) / n, double(j) / n);
      points.push_back(b[0] * mesh.point(corner[0]) + b[1] * mesh.point(corner[1]) +
                       b[2] * mesh.point(corner[2]));
      values.push_back(at(triangle, b));
      return static_cast<int>(points.size()) - 1;
    };
    Rows<int, Eigen::Dynamic> id = Rows<int, Eigen::Dynamic>::Constant(n + 1, n + 1, -1);
    id(0, 0) = corner[0], id(n, 0) = corner[1], id(0, n) = corner[2];
    for (int k = 0; k < 3; ++k) {
      const int e = mesh.side_edge(f, k);
      const auto on_side = [&](int s) -> int& {  // s / n along side k
        return k == 0 ? id(s, 0) : k == 1 ? id(n - s, s) : id(0, n - s);
      };
      const bool fresh = first_on_edge[e] < 0;
      if (fresh) first_on_edge[e] = static_cast<int>(points.size());
      for (int s = 1; s < n; ++s) {  // s / n along the edge
        int& here = on_side(mesh.side_along(f, k) ? s : n - s);
        const int t = mesh.side_along(f, k) ? s : n - s;
        here = first_on_edge[e] + s - 1;
        if (fresh) k == 0 ? add(t, 0) : k == 1 ? add(n - t, t) : add(0, n - t);
      }
    }
    for (int i = 1; i < n; ++i)
      for (int j = 1; i + j < n; ++j) id(i, j) = add(i, j);
    for (int i = 0; i < n; ++i)
      for (int j = 0; i + j < n; ++j) {
        soup.add_face(std::array{id(i, j), id(i + 1, j), id(i, j + 1)});
        if (i + j + 1 < n) soup.add_face(std::array{id(i + 1, j), id(i + 1, j + 1), id(i, j + 1)});
      }
  }
  soup.points.resize(index(points.size()), 3);
  for (std::size_t v = 0; v < points.size(); ++v) soup.points.row(index(v)) = points[v];
  soup.scalars["distance"] = Eigen::Map<const VecX>(values.data(), index(values.size()));
  return soup;
}

}  // namespace littoral
