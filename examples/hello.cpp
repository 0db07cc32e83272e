// Signed distance to a broken line on a square made in code.

#include <littoral/littoral.h>

#include <iostream>

int main() {
  // A unit square of 20 x 20 cells, two triangles each.
  const int n = 20;
  Eigen::MatrixXd V((n + 1) * (n + 1), 3);
  Eigen::MatrixXi F(2 * n * n, 3);
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) V.row(j * (n + 1) + i) << double(i) / n, double(j) / n, 0;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = j * (n + 1) + i, b = a + 1, c = b + n + 1, d = c - 1;
      F.row(2 * (j * n + i)) << a, b, c;
      F.row(2 * (j * n + i) + 1) << a, c, d;
    }
  const littoral::Mesh mesh(V, F);

  // Up the middle, with a gap: positive distances lie to the left.
  littoral::Sources sources;
  for (const auto& [from, to] : {std::pair(0, 8), std::pair(12, n)}) {
    std::vector<int> vertices;
    for (int j = from; j <= to; ++j) vertices.push_back(j * (n + 1) + n / 2);
    sources.add(littoral::Curve::along_vertices(vertices));
  }

  const littoral::Field d = littoral::distance(mesh, sources);

  std::cout << mesh.n_vertices() << " vertices, distances from " << d.values.minCoeff() << " to "
            << d.values.maxCoeff() << "\n";
  for (int i = 0; i <= n; i += 5)
    std::cout << "at (" << mesh.points().row(i) << "): " << d.values[i] << "\n";
  for (const std::string& warning : d.report.warnings) std::cout << "warning: " << warning << "\n";
}
