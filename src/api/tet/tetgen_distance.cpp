#include "api/tet/tetgen_distance.h"

#include "api/space/space_problem.h"
#include "api/tet/tet_distance.h"
#include "base/error.h"
#include "domain/mesh/triangulate.h"
#include "domain/tet/tet_locator.h"
#include "domain/volume/grid_values.h"
#include "io/tet/tetgen.h"

namespace littoral {

namespace {

constexpr double growth = 8;         // of tets, from the input to the box
constexpr double margin = 1.0 / 64;  // in spacings: nodes on the box must lie within tets

/// Values of a field on tets at the nodes of a grid; both in the same frame.
VecX at_nodes(const TetMesh& mesh, const VecX& values, const Grid& grid, const Task& task) {
  const TetLocator locator(mesh);
  return grid_values(grid, task, [&](const Vec3& x, int&) {
    const TetPoint p = locator.locate(x);
    if (p.tet < 0) throw SolveError("the tets do not fill the box of the grid");
    return interpolated(mesh, values, p);
  });
}

}  // namespace

TetField tetgen_distance(const PolygonSoup& input, const Grid& grid, const SpaceRequest& request,
                         const TetgenOptions& options, VecX* on_grid, Task task, Report& report) {
  if (request.method != "signed-heat")
    throw UnsupportedError("method " + request.method + " does not run on tets");
  if (input.n_faces() == 0)
    throw UnsupportedError("a cloud has no faces for tetgen to keep; --tets lattice takes clouds");
  const Frame frame(box_on_grid(input, grid));
  const Grid local = frame.local(grid);
  const double spacing = local.spacing.minCoeff();
  PolygonSoup surface;
  surface.points = frame.local(input.points);
  surface.face_offsets = input.face_offsets;
  surface.corners = input.corners;
  surface = triangulate(surface);

  io::TetgenRequest run;
  run.low = local.origin.array() - margin * spacing;
  run.high = local.point(grid.n[0] - 1, grid.n[1] - 1, grid.n[2] - 1).array() + margin * spacing;
  run.fine = spacing;
  run.coarse = growth * spacing;
  run.program = options.program;
  run.timeout = options.timeout;
  const Box box = bounding_box(surface);
  if ((box.low.array() <= run.low.array()).any() || (box.high.array() >= run.high.array()).any())
    throw InputError("tetgen needs a box that holds the whole input; --tets lattice does not");

  TetField field;
  {
    const Stopwatch watch(report, "tetgen");
    field.mesh = io::run_tetgen(surface, run, task.stage(0.3, "waiting for tetgen"));
  }
  const VecX values =
      tet_mesh_distance(field.mesh, {surface, {}}, request, task.stage(0.6, "distance"), report);
  report.domain = "tet mesh of " + options.program;
  const Task sampling = task.stage(0.1, "sampling");
  if (on_grid != nullptr) *on_grid = frame.unit * at_nodes(field.mesh, values, local, sampling);
  field.values = frame.unit * values;
  field.mesh.points = (frame.unit * field.mesh.points).rowwise() + frame.centre.transpose();
  return field;
}

}  // namespace littoral
