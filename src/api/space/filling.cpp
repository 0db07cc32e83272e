#include "api/space/filling.h"

#include <algorithm>
#include <cmath>

#include "api/tet/tet_domain.h"
#include "base/counted.h"
#include "base/run_interruptible.h"
#include "base/stopwatch.h"
#include "domain/tet/tet_lattice.h"
#include "io/tet/tetgen.h"
#include "methods/heat/signed_heat_tets.h"
#include "sources/space/tet_source_values.h"
#include "spatial/grid_values.h"
#include "spatial/triangulate.h"

namespace littoral {

namespace {

constexpr double growth = 8;         // of tetgen's tets, from the input to the box
constexpr double margin = 1.0 / 64;  // in spacings: nodes on the box must lie within tets

double longest_side(const Grid& grid) {
  return (grid.point(grid.n[0] - 1, grid.n[1] - 1, grid.n[2] - 1) - grid.origin).maxCoeff();
}

/// As small as the grid's cells near the points.
std::shared_ptr<const TetLattice> lattice_about(const MatX3& points, const Grid& grid,
                                                const Task& task, Report& report) {
  const double side = longest_side(grid), spacing = grid.spacing.minCoeff();
  const int depth = std::clamp(static_cast<int>(std::lround(std::log2(side / spacing))), 1, 16);
  auto lattice = run_interruptible(task, [origin = grid.origin, side, depth, points] {
    return TetLattice(origin, side, depth, points);
  });
  report.sizes.emplace_back("tets", lattice->mesh().n_tets());
  report.sizes.emplace_back("vertices", lattice->mesh().n_vertices());
  return lattice;
}

SpaceAnswer through_lattice(const SpaceSources& sources, const Grid& grid,
                            const SpaceSignedHeat& options, Task& task, Report& report) {
  const Frame frame(box_on_grid(sources.soup, grid));
  const Grid local = frame.local(grid);
  const SpaceInput input = make_input(sources, frame, local.spacing.minCoeff(), task, report);
  const OrientedPoints& source = input.samples;

  Task building = task.stage(0.1, "building tets");
  const double side = longest_side(local);
  const auto shared = lattice_about(source.points, local, building, report);
  const TetLattice& lattice = *shared;
  const TetMesh& mesh = lattice.mesh();
  check_tet_memory(mesh, "a lattice of ", "lower option resolution");
  const auto ops = run_interruptible(building, [shared] { return tet_operators(shared->mesh()); });
  std::vector<TetPoint> places;
  std::vector<int> cubes;
  for (Eigen::Index i = 0; i < source.size(); ++i) {
    places.push_back(lattice.locate(source.points.row(i)));
    cubes.push_back(places.back().tet < 0 ? -1 : lattice.cube_of(places.back().tet));
  }
  const TetSourceSystem terms = tet_source_system(
      mesh, *ops, source, places, cubes, parts_to_hold(input, options), input.sample_values);
  if (terms.outside > 0)
    report.warn("samples-outside",
                counted(terms.outside, "sample of the input lies", "samples of the input lie") +
                    " outside the box and count for nothing; a larger option padding or option "
                    "bounds holds all");
  const double h = std::max(sample_spacing(source), lattice.finest());
  VecX phi = TetHeatSolver(ops, SolveHint::single_rhs)
                 .signed_distance(terms, h, 0.01 * lattice.finest(), options,
                                  task.stage(options.sharpen ? 0.4 : 0.8, "distance"), report);
  if (options.sharpen)
    phi =
        sharpened_on_tets(ops, "tet lattice", terms.A, phi, task.stage(0.4, "sharpening"), report);
  SpaceAnswer answer;
  answer.at_nodes =
      frame.unit * grid_values(local, task.stage(0.1, "sampling"), [&](const Vec3& node, int&) {
        // Nodes on the far side of the box may lie outside by rounding.
        const Vec3 x = node.cwiseMin((local.origin.array() + side).matrix()).cwiseMax(local.origin);
        return interpolated(mesh, phi, lattice.locate(x));
      });
  answer.tets = {{frame.global(mesh.points), mesh.tets}, phi * frame.unit};
  return answer;
}

/// Values of a field on tets at the nodes of a grid; both in the same frame.
VecX at_nodes(const TetMesh& mesh, const VecX& values, const Grid& grid, const Task& task) {
  const TetLocator locator(mesh);
  return grid_values(grid, task, [&](const Vec3& x, int&) {
    const TetPoint p = locator.locate(x);
    if (p.tet < 0) throw SolveError("the tets do not fill the box of the grid");
    return interpolated(mesh, values, p);
  });
}

/// Tets whose faces include a surface of triangles in the grid's frame.
TetMesh tetgen_about(const PolygonSoup& surface, const Grid& grid, const TetFilling& filling,
                     const Task& task, Report& report) {
  if (surface.n_faces() == 0)
    throw UnsupportedError("a cloud has no faces for tetgen to keep; a lattice takes clouds");
  const double spacing = grid.spacing.minCoeff();
  io::TetgenRequest run;
  run.low = grid.origin.array() - margin * spacing;
  run.high = grid.point(grid.n[0] - 1, grid.n[1] - 1, grid.n[2] - 1).array() + margin * spacing;
  run.fine = spacing;
  run.coarse = growth * spacing;
  run.program = filling.program;
  run.timeout = filling.timeout;
  const Box box = bounding_box(surface);
  if ((box.low.array() <= run.low.array()).any() || (box.high.array() >= run.high.array()).any())
    throw InputError("tetgen needs a box that holds the whole input; a lattice does not");
  const Stopwatch watch(report, "tetgen");
  return io::run_tetgen(surface, run, task);
}

SpaceAnswer through_tetgen(const SpaceSources& sources, const Grid& grid, const TetFilling& filling,
                           const SpaceSignedHeat& options, Task& task, Report& report) {
  const PolygonSoup& soup = sources.soup;
  const Frame frame(box_on_grid(soup, grid));
  const Grid local = frame.local(grid);
  PolygonSoup surface;
  surface.points = frame.local(soup.points);
  surface.face_offsets = soup.face_offsets;
  surface.corners = soup.corners;
  surface = triangulate(surface);

  TetMesh mesh =
      tetgen_about(surface, local, filling, task.stage(0.3, "waiting for tetgen"), report);
  const TetDomain domain{std::make_shared<const TetMesh>(std::move(mesh))};
  TetSources from{surface, {}, false, sources.flip, false};
  if (!sources.values.empty()) from.values = values_of_triangles(soup, frame.local(sources.values));
  Report inner;
  const VecX values =
      solve_once<TetDomain>(options, domain, from, task.stage(0.6, "distance"), inner);
  inner.options.clear();
  report.merge(inner);
  SpaceAnswer answer;
  answer.at_nodes = frame.unit * at_nodes(*domain.mesh, values, local, task.stage(0.1, "sampling"));
  answer.tets = {{frame.global(domain.mesh->points), domain.mesh->tets}, frame.unit * values};
  return answer;
}

}  // namespace

TetMesh filled(const SpaceInput& input, const Grid& grid, const TetFilling& filling, Task task,
               Report& report) {
  if (filling.by == TetFilling::By::lattice)
    return lattice_about(input.samples.points, grid, task, report)->mesh();
  TetMesh mesh = tetgen_about(input.surface, grid, filling, task, report);
  report.sizes.emplace_back("tets", mesh.n_tets());
  report.sizes.emplace_back("vertices", mesh.n_vertices());
  return mesh;
}

Method<SpaceDomain> heat_filling_method(MethodInfo info) {
  return make_method<SpaceDomain>(
      std::move(info), space_heat_options(),
      [](const SpaceDomain& domain, const SpaceSignedHeat&, SolveHint, const Task&, Report&) {
        check_grid(*domain.grid);
        return [domain](const SpaceSources& sources, SpaceSignedHeat& options, Task& task,
                        Report& report) {
          const bool lattice = domain.tets->by == TetFilling::By::lattice;
          options = settled(options, !lattice);
          check_level_sets(options, !sources.values.empty());
          return lattice
                     ? through_lattice(sources, *domain.grid, options, task, report)
                     : through_tetgen(sources, *domain.grid, *domain.tets, options, task, report);
        };
      });
}

}  // namespace littoral
