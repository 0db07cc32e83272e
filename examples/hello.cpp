// A mesh made in code: a square of 20 x 20 cells, two triangles each.

#include <littoral/domain/surface_mesh.h>

#include <array>
#include <iostream>

int main() {
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
  std::cout << mesh.n_vertices() << " vertices, " << mesh.n_edges() << " edges, " << mesh.n_faces()
            << " faces\n";
}
