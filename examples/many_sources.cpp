// One mesh, many sources: a solver factors once. Takes a mesh file.

#include <littoral/littoral.h>

#include <iostream>
#include <thread>

using namespace littoral;

int main(int argc, char** argv) {
  if (argc < 2) return std::cerr << "usage: many_sources MESH\n", 2;
  const Mesh mesh = read_mesh(argv[1]);
  const DistanceSolver solver(mesh, SignedHeat{.constraint = Constraint::zero_set});

  // From several threads, on the same factors.
  std::vector<Field> fields(4, Field{mesh, {}, {}, {}, {}});
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i)
    threads.emplace_back([&, i] {
      const Sources point(SurfacePoint::at_vertex(i * (mesh.n_vertices() / 4)));
      fields[static_cast<std::size_t>(i)] = solver.solve(point, {.threads = 1});
    });
  for (std::thread& thread : threads) thread.join();
  for (const Field& field : fields)
    std::cout << "from vertex " << field.sources.points[0].element << ": farthest "
              << field.values.maxCoeff() << "\n";

  // All distances between a few points, exactly.
  const std::vector<SurfacePoint> points = {SurfacePoint::at_vertex(0), SurfacePoint::at_vertex(10),
                                            SurfacePoint::in_face(7, 0.2, 0.3, 0.5)};
  const DistanceMatrix D = distance_matrix(mesh, points, points, Exact{});
  std::cout << "between three points:\n" << D.values << "\n";
}
