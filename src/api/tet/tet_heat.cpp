// Signed heat on tets: of a lattice made for the input, or of a mesh that is given.

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "api/space/sdf.h"
#include "api/space/space_problem.h"
#include "api/tet/tet_method.h"
#include "base/error.h"
#include "base/made.h"
#include "domain/tet/tet_locator.h"
#include "domain/volume/grid_values.h"
#include "methods/heat/sharpen.h"
#include "methods/heat/signed_heat_tets.h"

namespace littoral {

namespace {

SpaceHeatOptions heat_options(const OptionTexts& texts) {
  return parse_options(find_space_method("signed-heat").info, space_heat_options(), texts);
}

/// Those with constraint zero-set where none is given.
SpaceHeatOptions holding_options(OptionTexts texts) {
  if (std::none_of(texts.begin(), texts.end(), [](const auto& option) {
        return option.first == "constraint" || option.first == "soft";
      }))
    texts.emplace_back("constraint", "zero-set");
  return heat_options(texts);
}

constexpr double held_to = 3e-3;  // mean edges, root mean square, where values are held at zero

VecX sharpened(const std::shared_ptr<const TetOperators>& ops, const SpMat& rows, const VecX& phi,
               const Task& task, Report& report) {
  Operators in_space;
  in_space.domain = report.domain;
  in_space.scalar = tet_calculus(ops);
  return sharpen_in_space(in_space, rows, phi, SharpenSolver::admm, task, report);
}

/// One connected part of a problem; `vertices` become those of the mesh that it has.
TetProblem part_of(const TetProblem& whole, int component, std::vector<int>& vertices) {
  const TetMesh& mesh = *whole.mesh;
  TetProblem part = whole;
  vertices.clear();
  part.vertices.clear();
  std::vector<int> number(static_cast<std::size_t>(mesh.n_vertices()), -1);
  std::vector<char> wanted(number.size(), 0);
  for (const int v : whole.vertices) wanted[static_cast<std::size_t>(v)] = 1;
  for (int v = 0; v < mesh.n_vertices(); ++v) {
    if (whole.ops->component[static_cast<std::size_t>(v)] != component) continue;
    number[static_cast<std::size_t>(v)] = static_cast<int>(vertices.size());
    if (wanted[static_cast<std::size_t>(v)] != 0)
      part.vertices.push_back(static_cast<int>(vertices.size()));
    vertices.push_back(v);
  }
  std::vector<int> corners, tets;  // of the mesh -> of the part; -1 in none or another
  int n = 0;
  for (int t = 0; t < mesh.n_tets(); ++t) {
    const bool here =
        whole.ops->volumes[t] > 0 && number[static_cast<std::size_t>(mesh.tets(t, 0))] >= 0;
    tets.push_back(here ? n++ : -1);
    for (int k = 0; k < 4 && here; ++k)
      corners.push_back(number[static_cast<std::size_t>(mesh.tets(t, k))]);
  }
  for (TetPoint& p : part.places)
    if (p.tet >= 0) p.tet = tets[static_cast<std::size_t>(p.tet)];
  part.mesh = std::make_shared<const TetMesh>(TetMesh{
      mesh.points(vertices, Eigen::all), Eigen::Map<const Rows<int, 4>>(corners.data(), n, 4)});
  part.ops = std::make_shared<const TetOperators>(tet_operators(*part.mesh));
  return part;
}

VecX solve_part(const TetProblem& part, const SpaceHeatOptions& options, const Task& task,
                Report& report) {
  const double edge = mean_edge(*part.mesh, part.tets_with_sources());
  const double tolerance = held_to * edge;
  return part.vertices.empty()
             ? signed_heat_tets(*part.ops, part.terms(), std::max(part.h, edge), tolerance, options,
                                task, report)
             : unsigned_heat_tets(*part.ops, part.terms(), edge, tolerance, options, task, report);
}

VecX through_mesh(const TetProblem& problem, const SpaceHeatOptions& options, Task& task,
                  Report& report) {
  const TetMesh& mesh = *problem.mesh;
  const TetOperators& ops = *problem.ops;
  std::vector<char> reached(static_cast<std::size_t>(ops.n_components), 0);
  for (const int t : problem.tets_with_sources())
    reached[static_cast<std::size_t>(ops.component[static_cast<std::size_t>(mesh.tets(t, 0))])] = 1;
  if (std::count(reached.begin(), reached.end(), 1) == 0)
    throw InputError("no source vertex belongs to a tet");
  Task solving = task.stage(options.sharpen ? 0.4 : 0.9, "distance");
  VecX phi = VecX::Constant(mesh.n_vertices(), std::numeric_limits<double>::infinity());
  for (int c = 0; c < ops.n_components; ++c) {
    const Task stage = solving.stage(1.0 / ops.n_components, "distance");
    if (reached[static_cast<std::size_t>(c)] == 0) {
      report.unreachable_components.push_back(c);
    } else if (ops.n_components == 1) {
      phi = solve_part(problem, options, stage, report);
    } else {
      std::vector<int> vertices;
      const TetProblem part = part_of(problem, c, vertices);
      phi(vertices) = solve_part(part, options, stage, report);
    }
  }
  if (options.sharpen)
    phi = sharpened(problem.ops, problem.terms().A, phi, task.stage(0.5, "sharpening"), report);
  return phi;
}

}  // namespace

TetField tet_distance(const PolygonSoup& input, const Grid& grid, const SpaceRequest& request,
                      VecX* on_grid, Task task, Report& report) {
  if (request.method != "signed-heat") throw_not_on_tets(request.method);
  const SpaceHeatOptions options = heat_options(request.options);
  const Frame frame(box_on_grid(input, grid));
  report.method = request.method;
  report.domain = "tet lattice";
  const Grid local = frame.local(grid);
  const double spacing = local.spacing.minCoeff();
  const SpaceProblem problem = make_problem(input, request, frame, spacing, task, report);
  const OrientedPoints& source = problem.samples;

  Task building = task.stage(0.1, "building tets");
  const double side =
      (local.point(grid.n[0] - 1, grid.n[1] - 1, grid.n[2] - 1) - local.origin).maxCoeff();
  const int depth = std::clamp(static_cast<int>(std::lround(std::log2(side / spacing))), 1, 16);
  const auto made_lattice = made(building, [origin = local.origin, side, depth, p = source.points] {
    return TetLattice(origin, side, depth, p);
  });
  const TetLattice& lattice = *made_lattice;
  const TetMesh& mesh = lattice.mesh();
  report.sizes.emplace_back("tets", mesh.n_tets());
  report.sizes.emplace_back("vertices", mesh.n_vertices());
  check_tet_memory(mesh, "a lattice of ", "use a smaller --resolution");
  const auto made_operators =
      made(building, [made_lattice] { return tet_operators(made_lattice->mesh()); });
  const TetOperators& ops = *made_operators;
  std::vector<TetPoint> places;
  std::vector<int> cubes;
  for (Eigen::Index i = 0; i < source.size(); ++i) {
    places.push_back(lattice.locate(source.points.row(i)));
    cubes.push_back(places.back().tet < 0 ? -1 : lattice.cube_of(places.back().tet));
  }
  const TetSourceTerms terms = tet_source_terms(mesh, ops, source, places, cubes);
  if (terms.outside > 0)
    report.warn(std::to_string(terms.outside) + " samples of the input lie outside the box");
  const double h = std::max(sample_spacing(source), lattice.finest());
  VecX phi = signed_heat_tets(ops, terms, h, 0.01 * lattice.finest(), options,
                              task.stage(options.sharpen ? 0.4 : 0.8, "distance"), report);
  if (options.sharpen)
    phi = sharpened(made_operators, terms.A, phi, task.stage(0.4, "sharpening"), report);
  report_options(space_heat_options(), options, report);
  if (on_grid != nullptr)
    *on_grid =
        frame.unit * grid_values(local, task.stage(0.1, "sampling"), [&](const Vec3& node, int&) {
          // Nodes on the far side of the box may lie outside by rounding.
          const Vec3 x =
              node.cwiseMin((local.origin.array() + side).matrix()).cwiseMax(local.origin);
          return interpolated(mesh, phi, lattice.locate(x));
        });
  TetField field{mesh, phi * frame.unit};
  field.mesh.points = (frame.unit * mesh.points).rowwise() + frame.centre.transpose();
  return field;
}

std::vector<TetMethod> heat_tet_methods() {
  return {tet_method("signed-heat", space_heat_options(), holding_options, through_mesh)};
}

}  // namespace littoral
