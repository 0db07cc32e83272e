// Signed heat on tets: of a lattice made for the input, or of a mesh that is given.

#include "littoral/api/tet_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <string>

#include "littoral/api/regularized_space.h"
#include "littoral/api/space_problem.h"
#include "littoral/api/tet_quadratic.h"
#include "littoral/base/error.h"
#include "littoral/base/memory.h"
#include "littoral/domain/grid_values.h"
#include "littoral/domain/tet_locator.h"
#include "littoral/methods/sharpen.h"
#include "littoral/methods/signed_heat_tets.h"

namespace littoral {

namespace {

SpaceHeatOptions heat_options(const SpaceRequest& request) {
  if (request.method != "signed-heat")
    throw UnsupportedError("method " + request.method +
                           " does not run on tets; signed-heat does, and through tets that are "
                           "given regularized, belyaev-fayolle and quadratic, too");
  const SpaceMethod& method = find_space_method(request.method);
  return parse_options(method.info, space_heat_options(), request.options);
}

constexpr double held_to = 3e-3;  // mean edges, root mean square, where values are held at zero

/// Makes something that takes a while and cannot be interrupted; `make` must own what it touches.
template <class Make>
auto made(const Task& task, Make make) {
  auto out = std::make_shared<std::shared_ptr<const decltype(make())>>();
  run_abandonable(task, [out, make] { *out = std::make_shared<const decltype(make())>(make()); });
  return *out;
}

void check_tet_memory(const TetMesh& mesh, const std::string& what, const std::string& remedy) {
  // The factor of the faces' matrix: about 60 numbers a face were seen.
  check_memory(2.1 * mesh.n_tets() * 60 * 16.0, what + std::to_string(mesh.n_tets()) + " tets",
               remedy);
}

/// One connected part of a mesh.
struct Part {
  TetMesh mesh;
  std::vector<int> vertices;  // of the part -> of the mesh
  std::vector<int> tets;      // of the mesh -> of the part; -1 in none or another
};

Part part_of(const TetMesh& mesh, const TetOperators& ops, int component) {
  Part part;
  std::vector<int> number(static_cast<std::size_t>(mesh.n_vertices()), -1);
  for (int v = 0; v < mesh.n_vertices(); ++v) {
    if (ops.component[static_cast<std::size_t>(v)] != component) continue;
    number[static_cast<std::size_t>(v)] = static_cast<int>(part.vertices.size());
    part.vertices.push_back(v);
  }
  part.mesh.points = mesh.points(part.vertices, Eigen::all);
  std::vector<int> corners;
  int n = 0;
  for (int t = 0; t < mesh.n_tets(); ++t) {
    const bool here = ops.volumes[t] > 0 && number[static_cast<std::size_t>(mesh.tets(t, 0))] >= 0;
    part.tets.push_back(here ? n++ : -1);
    for (int k = 0; k < 4 && here; ++k)
      corners.push_back(number[static_cast<std::size_t>(mesh.tets(t, k))]);
  }
  part.mesh.tets = Eigen::Map<const Rows<int, 4>>(corners.data(), n, 4);
  return part;
}

/// Sources with their places in a mesh.
struct Placed {
  OrientedPoints samples;
  std::vector<TetPoint> places;  // of the samples
  std::vector<int> vertices;
  double h = 0;  // of the samples; [length]
};

/// A row for each vertex of the source or, of a surface, for each vertex next to it, of the samples
/// nearest to that.
TetSourceTerms terms_of(const TetMesh& mesh, const TetOperators& ops, const Placed& sources) {
  if (!sources.vertices.empty()) return vertex_source_terms(ops, sources.vertices);
  std::vector<int> nearest;
  for (const TetPoint& p : sources.places) {
    const auto corner = std::max_element(p.barycentric.begin(), p.barycentric.end());
    nearest.push_back(
        p.tet < 0 ? -1 : mesh.tets(p.tet, static_cast<int>(corner - p.barycentric.begin())));
  }
  return tet_source_terms(mesh, ops, sources.samples, sources.places, nearest);
}

VecX solve_part(const TetMesh& mesh, const TetOperators& ops, const Placed& sources,
                const std::vector<int>& held_tets, const SpaceHeatOptions& options,
                const Task& task, Report& report) {
  const double edge = mean_edge(mesh, held_tets);
  const double tolerance = held_to * edge;
  const TetSourceTerms terms = terms_of(mesh, ops, sources);
  return sources.vertices.empty()
             ? signed_heat_tets(ops, terms, std::max(sources.h, edge), tolerance, options, task,
                                report)
             : unsigned_heat_tets(ops, terms, edge, tolerance, options, task, report);
}

VecX sharpened(const std::shared_ptr<const TetOperators>& ops, const SpMat& rows, const VecX& phi,
               const Task& task, Report& report) {
  Operators in_space;
  in_space.domain = report.domain;
  in_space.scalar = tet_calculus(ops);
  return sharpen_in_space(in_space, rows, phi, SharpenSolver::admm, task, report);
}

/// The tets that hold sources, each once.
std::vector<int> tets_with_sources(const TetMesh& mesh, const Placed& sources) {
  std::vector<int> tets;
  for (const TetPoint& p : sources.places)
    if (p.tet >= 0) tets.push_back(p.tet);
  if (!sources.vertices.empty()) {
    std::vector<char> wanted(static_cast<std::size_t>(mesh.n_vertices()), 0);
    for (int v : sources.vertices) wanted[static_cast<std::size_t>(v)] = 1;
    for (int t = 0; t < mesh.n_tets(); ++t)
      for (int k = 0; k < 4; ++k)
        if (wanted[static_cast<std::size_t>(mesh.tets(t, k))] != 0) tets.push_back(t);
  }
  std::sort(tets.begin(), tets.end());
  tets.erase(std::unique(tets.begin(), tets.end()), tets.end());
  return tets;
}

Placed place(const std::shared_ptr<const TetMesh>& mesh, const TetSources& sources,
             const SpaceRequest& request, const Frame& frame, double max_side, Task& task,
             Report& report) {
  Placed placed;
  placed.vertices = sources.vertices;
  if (!sources.vertices.empty()) return placed;
  bounding_box(sources.surface);  // complains about what cannot be placed
  const SpaceProblem problem =
      make_problem(sources.surface, request, frame, max_side, task, report);
  placed.h = sample_spacing(problem.samples);
  Report again;
  placed.samples = problem.is_cloud()
                       ? problem.samples
                       : sample_faces(problem.surface, max_side, again, SamplesPerTriangle::three);
  const auto locator = made(task, [mesh] { return TetLocator(*mesh); });
  int outside = 0;
  for (Eigen::Index i = 0; i < placed.samples.size(); ++i) {
    if (i % 1024 == 0) task.checkpoint();
    placed.places.push_back(locator->locate(placed.samples.points.row(i)));
    outside += placed.places.back().tet < 0 ? 1 : 0;
  }
  if (outside == placed.samples.size()) throw InputError("no source lies within the tets");
  if (outside > 0)
    report.warn(std::to_string(outside) + " of " + std::to_string(placed.samples.size()) +
                " samples of the sources lie outside the tets and are left out");
  return placed;
}

}  // namespace

TetField tet_distance(const PolygonSoup& input, const Grid& grid, const SpaceRequest& request,
                      VecX* on_grid, Task task, Report& report) {
  const SpaceHeatOptions options = heat_options(request);
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

VecX tet_mesh_distance(const TetMesh& mesh, const TetSources& sources, const SpaceRequest& request,
                       Task task, Report& report) {
  const bool quadratic = request.method == "quadratic";
  const QuadraticOptions quadratic_how =
      quadratic ? tet_quadratic_options(request.options) : QuadraticOptions{};
  SpaceRequest wanted = request;
  if (quadratic) wanted.method = "signed-heat", wanted.options.clear();
  const auto is_hold = [](const auto& option) {
    return option.first == "constraint" || option.first == "soft";
  };
  if (std::none_of(wanted.options.begin(), wanted.options.end(), is_hold))
    wanted.options.emplace_back("constraint", "zero-set");
  const bool is_convex = request.method == "regularized" || request.method == "belyaev-fayolle";
  const RegularizedOptions convex_options =
      is_convex ? regularized_options_in_space(request.method, request.options, report)
                : RegularizedOptions();
  const SpaceHeatOptions options = is_convex ? SpaceHeatOptions() : heat_options(wanted);
  const bool from_vertices = !sources.vertices.empty() || sources.boundary;
  if (from_vertices && (sources.surface.n_faces() > 0 || sources.surface.n_vertices() > 0))
    throw UnsupportedError(
        "distance through tets is signed, from surfaces, or unsigned, from vertices: not both");
  for (const int v : sources.vertices)
    if (v < 0 || v >= mesh.n_vertices())
      throw InputError("there is no vertex " + std::to_string(v) +
                       " to measure from, the mesh has " + std::to_string(mesh.n_vertices()));
  report.method = request.method;
  report.domain = "tet mesh";
  report.sizes.emplace_back("tets", mesh.n_tets());
  report.sizes.emplace_back("vertices", mesh.n_vertices());
  check_tet_memory(mesh, "a mesh of ", "use a coarser mesh");

  Task building = task.stage(0.1, "building operators");
  Box box;
  for (int t = 0; t < mesh.n_tets(); ++t)
    for (int k = 0; k < 4; ++k) {
      const int v = mesh.tets(t, k);
      if (v >= 0 && v < mesh.n_vertices() && mesh.points.row(v).allFinite())
        box.add(mesh.points.row(v));
    }
  if (!(box.size().minCoeff() >= 0) || !box.size().allFinite())
    throw InputError("the tet mesh has no volume");
  const Frame frame(box);
  const auto local = std::make_shared<const TetMesh>(TetMesh{frame.local(mesh.points), mesh.tets});
  const auto ops = made(building, [local] { return tet_operators(*local); });
  std::vector<int> all(static_cast<std::size_t>(mesh.n_tets()));
  std::iota(all.begin(), all.end(), 0);
  TetSources from = sources;
  if (sources.boundary) {
    const MatX3i faces = boundary_faces(*local);
    from.vertices.insert(from.vertices.end(), faces.data(), faces.data() + faces.size());
    std::sort(from.vertices.begin(), from.vertices.end());
    from.vertices.erase(std::unique(from.vertices.begin(), from.vertices.end()),
                        from.vertices.end());
  }
  const Placed placed = place(local, from, wanted, frame, mean_edge(*local, all), building, report);
  for (const int v : placed.vertices)
    if (ops->component[static_cast<std::size_t>(v)] < 0)
      report.warn("source vertex " + std::to_string(v) + " belongs to no tet and is left out");
  if (quadratic) {
    PolygonSoup surface = sources.surface;
    surface.points = frame.local(surface.points);
    const VecX d = quadratic_through_tets(*local, *ops, placed.vertices, surface,
                                          tets_with_sources(*local, placed), quadratic_how,
                                          task.stage(0.9, "distance"), report);
    report_options(quadratic_options(), quadratic_how, report);
    return d * frame.unit;
  }
  std::vector<std::vector<int>> tets_of(static_cast<std::size_t>(ops->n_components));
  for (int t : tets_with_sources(*local, placed))
    if (ops->volumes[t] > 0)
      tets_of[static_cast<std::size_t>(ops->component[static_cast<std::size_t>(local->tets(t, 0))])]
          .push_back(t);

  Task solving = task.stage(options.sharpen ? 0.4 : 0.9, "distance");
  if (is_convex) {
    const SpMat rows = terms_of(*local, *ops, placed).A;
    if (rows.rows() == 0) throw InputError("no source vertex belongs to a tet");
    return regularized_in_space(tet_calculus(ops), rows, convex_options, solving, report) *
           frame.unit;
  }
  VecX phi = VecX::Constant(mesh.n_vertices(), std::numeric_limits<double>::infinity());
  bool any = false;
  for (int c = 0; c < ops->n_components; ++c) {
    const std::vector<int>& held = tets_of[static_cast<std::size_t>(c)];
    const Task stage = solving.stage(1.0 / ops->n_components, "distance");
    if (held.empty()) {
      report.unreachable_components.push_back(c);
      continue;
    }
    any = true;
    if (ops->n_components == 1) {
      phi = solve_part(*local, *ops, placed, held, options, stage, report);
      continue;
    }
    Part part = part_of(*local, *ops, c);
    Placed here = placed;
    for (TetPoint& p : here.places)
      if (p.tet >= 0) p.tet = part.tets[static_cast<std::size_t>(p.tet)];
    here.vertices.clear();
    for (std::size_t v = 0; v < part.vertices.size(); ++v)
      if (std::find(placed.vertices.begin(), placed.vertices.end(), part.vertices[v]) !=
          placed.vertices.end())
        here.vertices.push_back(static_cast<int>(v));
    std::vector<int> held_here;
    for (int t : held) held_here.push_back(part.tets[static_cast<std::size_t>(t)]);
    const VecX values =
        solve_part(part.mesh, tet_operators(part.mesh), here, held_here, options, stage, report);
    phi(part.vertices) = values;
  }
  if (!any) throw InputError("no source vertex belongs to a tet");
  if (options.sharpen)
    phi = sharpened(ops, terms_of(*local, *ops, placed).A, phi, task.stage(0.5, "sharpening"),
                    report);
  report_options(space_heat_options(), options, report);
  return phi * frame.unit;
}

}  // namespace littoral
