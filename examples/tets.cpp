// Distance through tets, from their boundary.

#include <littoral/littoral.h>

#include <iostream>

using namespace littoral;

int main() {
  // A cube of 4 x 4 x 4 cells, six tets each.
  const int n = 4, m = n + 1;
  TetMesh mesh;
  mesh.points.resize(m * m * m, 3);
  for (int v = 0; v < m * m * m; ++v) mesh.points.row(v) << v % m, v / m % m, v / (m * m);
  mesh.tets.resize(6 * n * n * n, 4);
  const int way[6][2] = {{1, m}, {1, m * m}, {m, 1}, {m, m * m}, {m * m, 1}, {m * m, m}};
  int t = 0;
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i)
        for (const auto& [first, second] : way) {
          const int a = i + m * (j + m * k);
          mesh.tets.row(t++) << a, a + first, a + first + second, a + 1 + m + m * m;
        }

  TetSources sources;
  sources.boundary = true;
  const TetField d = distance(mesh, sources);
  std::cout << "the middle of the cube is " << d.values[2 + m * (2 + m * 2)]
            << " from its boundary\n";
}
