// Signed distance to a broken line on a square made in code.

#include <api/surface/distance.h>

#include <array>
#include <iostream>
#include <utility>

int main() {
  // A unit square of 20 x 20 cells, two triangles each.
  const int n = 20;
  littoral::PolygonSoup soup;
  soup.points.resize((n + 1) * (n + 1), 3);
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i)
      soup.points.row(j * (n + 1) + i) << double(i) / n, double(j) / n, 0;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = j * (n + 1) + i, b = a + 1, c = b + n + 1, d = c - 1;
      soup.add_face(std::array{a, b, c});
      soup.add_face(std::array{a, c, d});
    }
  const littoral::SurfaceMesh mesh(std::move(soup));

  // Up the middle, with a gap: positive distances lie to the left.
  littoral::Sources sources;
  for (const auto& [from, to] : {std::pair(0, 8), std::pair(12, n)}) {
    littoral::Curve curve;
    for (int j = from; j <= to; ++j)
      curve.nodes.push_back(littoral::SurfacePoint::at_vertex(j * (n + 1) + n / 2));
    sources.curves.push_back(curve);
  }

  littoral::Report report;
  const littoral::VecX phi = littoral::surface_distance(mesh, sources, {}, {}, report);

  std::cout << mesh.n_vertices() << " vertices, distances from " << phi.minCoeff() << " to "
            << phi.maxCoeff() << "\n";
  for (int i = 0; i <= n; i += 5)
    std::cout << "at (" << mesh.point(i).transpose() << "): " << phi[i] << "\n";
  for (const std::string& warning : report.warnings) std::cout << "warning: " << warning << "\n";
}
