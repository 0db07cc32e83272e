// What a moving source saves in quadratic-order geodesics: the ordering and symbolic factorization
// kept, and starts from the solution before.
// usage: littoral_moving_source STEPS MESH [TOLERANCE]
//
// The source moves straight from the centre of the first face to that of a neighbour. One thread,
// processor seconds.

#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "domain/intrinsic/intrinsic_triangulation.h"
#include "io/read.h"
#include "littoral/error.h"
#include "methods/quadratic/quadratic_program.h"
#include "sources/surface/pieces.h"

namespace littoral {
namespace {

using Solver = ParaboloidSolver<6, 2>;

double seconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// The way's places: before, on and after the edge that the first face shares with a neighbour.
std::vector<SurfacePoint> way(const SurfaceMesh& mesh, int steps) {
  for (int k = 0; k < 3; ++k)
    for (int other : mesh.edge_faces(mesh.side_edge(0, k))) {
      if (other == 0) continue;
      std::vector<SurfacePoint> places;
      for (int i = 0; i < steps; ++i) {
        const double t = 2.0 * (i + 0.5) / steps - 1;
        const int face = t < 0 ? 0 : other;
        Vec3 b = Vec3::Constant(std::abs(t) / 3);
        for (int j = 0; j < 3; ++j)
          for (int v : {mesh.face(0)[k], mesh.face(0)[(k + 1) % 3]})
            if (mesh.face(face)[j] == v) b[j] += (1 - std::abs(t)) / 2;
        places.push_back(SurfacePoint::in_face(face, b[0], b[1], b[2]));
      }
      return places;
    }
  throw InputError("the first face has no neighbour");
}

struct Total {
  double seconds = 0, steps = 0;
  std::size_t samples = 0;
  bool converged = true;
};

void run(int steps, const std::string& path, double tolerance) {
  set_thread_count(1);
  const SurfaceMesh mesh(io::read_surface(path));
  Report report;
  const IntrinsicTriangulation T = intrinsic_triangulation(mesh, report);
  const P2Elements<2> E = p2_elements(T);
  const auto parts = quadratic_parts(E);
  const QuadraticPart<2>& part = parts.at(static_cast<std::size_t>(E.component[E.node[0][0]]));
  const auto analysed = [&] {
    return std::make_unique<const Solver>(static_cast<int>(part.nodes.size()), part.local_node,
                                          Task());
  };
  double analysing = -seconds();
  const auto kept = analysed();
  analysing += seconds();
  std::printf("%d faces, tolerance %g; ordering and symbolic factorization %.3f s\n\n",
              mesh.n_faces(), tolerance, analysing);
  std::printf("| start | steps of the solver | processor seconds | samples | converged |\n");
  std::printf("|---|---|---|---|---|\n");
  const std::vector<SurfacePoint> places = way(mesh, steps);
  for (const double before : {0.0, 1.0, 0.95, 0.6}) {
    Total total;
    std::optional<VecX> last;
    for (const SurfacePoint& place : places) {
      Sources sources;
      sources.points.push_back(place);
      const auto points = p2_sources(mesh, T, place_sources(mesh, sources, report), 0);
      double spent = -seconds();
      const QuadraticProgram<2> program(E, part, points, 1e-4 * E.h);
      const VecX start = last && before > 0 ? VecX(before * *last) : program.start();
      const ParaboloidResult result = kept->solve(
          program.program(), start, {tolerance, 100},
          [&](const VecX& u, double share) { return program.violated(u, share * 100 * tolerance); },
          Task());
      spent += seconds();
      if (last) {  // the first has nothing to start from
        total.seconds += spent;
        total.steps += result.iterations;
        total.samples = std::max(total.samples, result.samples);
        total.converged = total.converged && result.converged;
      }
      last = result.x;
    }
    const double n = static_cast<double>(places.size()) - 1;
    const std::string start =
        before > 0 ? std::to_string(before).substr(0, 4) + " of the solution before" : "usual";
    std::printf("| %s | %.1f | %.3f | %zu | %s |\n", start.c_str(), total.steps / n,
                total.seconds / n, total.samples, total.converged ? "all" : "not all");
  }
}

}  // namespace
}  // namespace littoral

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: littoral_moving_source STEPS MESH [TOLERANCE]\n");
    return 2;
  }
  littoral::run(std::atoi(argv[1]), argv[2], argc > 3 ? std::atof(argv[3]) : 1e-5);
}
