#include "littoral/api/sdf.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "littoral/api/tori_cloud.h"
#include "littoral/base/error.h"
#include "littoral/base/memory.h"
#include "littoral/base/parallel.h"
#include "littoral/domain/cloud_normals.h"
#include "littoral/domain/tet_lattice.h"
#include "littoral/domain/triangulate.h"
#include "littoral/methods/signed_heat_tets.h"
#include "littoral/methods/tori.h"
#include "littoral/spatial/winding_number.h"

namespace littoral {

namespace {

// While a grid is computed: directions, bookkeeping and right-hand side; then a few vectors.
constexpr double bytes_per_node = 48;

struct Box {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 high = -low;
  Vec3 size() const { return high - low; }
  void add(const Vec3& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
};

/// Of the faces or, without any, of the points.
Box bounding_box(const PolygonSoup& input) {
  Box box;
  const auto add = [&](int v) {
    if (!input.points.row(v).allFinite())
      throw InputError("vertex " + std::to_string(v) + " has coordinates that are not finite");
    box.add(input.points.row(v));
  };
  if (input.n_faces() > 0)
    for (int v : input.corners) add(v);
  else
    for (int v = 0; v < input.n_vertices(); ++v) add(v);
  if (!(box.size().minCoeff() >= 0)) throw InputError("the input has no faces and no points");
  if (!box.size().allFinite()) throw InputError("the input is too large for double precision");
  return box;
}

/// Moves the input to the origin and scales it to about unit size, by a power of two: results are
/// the same bits wherever it was and however large.
struct Frame {
  Vec3 centre;
  double unit;  // [length] of one unit

  explicit Frame(const Box& box) : centre(box.low + box.size() / 2), unit(1) {
    const double longest = box.size().maxCoeff();
    if (longest > 0) unit = std::exp2(std::ceil(std::log2(longest)));
  }
  Vec3 local(const Vec3& p) const { return (p - centre) / unit; }
  Grid local(const Grid& grid) const { return {grid.n, local(grid.origin), grid.spacing / unit}; }
  MatX3 local(const MatX3& p) const { return (p.rowwise() - centre.transpose()) / unit; }
  Torus local(Torus t) const { return scaled(t, local(t.q), 1 / unit); }
  Torus global(Torus t) const { return scaled(t, centre + unit * t.q, unit); }

 private:
  static Torus scaled(Torus t, const Vec3& q, double scale) {
    t.q = q;
    t.k1 /= scale;
    t.k2 /= scale;
    t.rho *= scale;
    return t;
  }
};

/// The other side is positive.
void flip(Torus& t) {
  t.n = -t.n;
  t.k1 = -t.k1;
  t.k2 = -t.k2;
}

SpaceProblem make_problem(const PolygonSoup& input, const SpaceRequest& request, const Frame& frame,
                          double max_side, Task& task, Report& report) {
  const Stopwatch watch(report, "sources");
  SpaceProblem problem;
  PolygonSoup& surface = problem.surface;
  surface.points = frame.local(input.points);
  if (input.n_faces() > 0) {
    surface.face_offsets = input.face_offsets;
    surface.corners = input.corners;
    surface = triangulate(surface);
    if (request.flip)
      for (int f = 0; f < surface.n_faces(); ++f)
        std::swap(surface.corners[static_cast<std::size_t>(3 * f)],
                  surface.corners[static_cast<std::size_t>(3 * f + 1)]);
    problem.samples = sample_faces(surface, max_side, report);
    report.sizes.emplace_back("faces", surface.n_faces());
  } else {
    surface.normals = request.estimate_normals
                          ? estimate_normals(surface.points, task.stage(0.05, "normals"))
                          : input.normals;
    if (request.flip) surface.normals = -surface.normals;
    if (surface.normals.rows() == 0)
      throw InputError(
          "the input has no faces, and its points have no normals; "
          "--estimate-normals computes some");
    if (has_tori(input) && !request.estimate_normals) {
      for (const Torus& t : tori_of_cloud(input)) problem.tori.push_back(frame.local(t));
      if (request.flip)
        for (Torus& t : problem.tori) flip(t);
    }
    problem.samples = sample_cloud(surface, report);
    report.sizes.emplace_back("points", surface.n_vertices());
  }
  report.sizes.emplace_back("samples", static_cast<double>(problem.samples.size()));
  task.checkpoint();
  return problem;
}

void check_queries(const MatX3& queries) {
  for (Eigen::Index i = 0; i < queries.rows(); ++i)
    if (!queries.row(i).allFinite())
      throw InputError("query point " + std::to_string(i) + " has coordinates that are not finite");
}

std::string grid_text(const Grid& grid) {
  return "a grid of " + std::to_string(grid.n[0]) + " x " + std::to_string(grid.n[1]) + " x " +
         std::to_string(grid.n[2]) + " nodes";
}

void check_grid(const Grid& grid) {
  for (int n : grid.n)
    if (n < 2) throw InputError("a grid needs two nodes along each axis at least");
  if (!grid.origin.allFinite() || !grid.spacing.allFinite() || !(grid.spacing.minCoeff() > 0))
    throw InputError("the grid's box must be finite and its spacings positive");
  const double nodes = double(grid.n[0]) * grid.n[1] * grid.n[2];
  if (nodes > std::numeric_limits<int>::max())
    throw InputError(grid_text(grid) + " is too large; use a smaller --resolution");
  check_memory(bytes_per_node * nodes, grid_text(grid), "use a smaller --resolution");
}

/// The box of the input; throws InputError unless it meets that of the grid.
Box box_on_grid(const PolygonSoup& input, const Grid& grid) {
  check_grid(grid);
  Box box = bounding_box(input);
  const Vec3 far = grid.point(grid.n[0] - 1, grid.n[1] - 1, grid.n[2] - 1);
  if ((grid.origin.array() > box.high.array()).any() || (far.array() < box.low.array()).any())
    throw InputError("the box of the grid misses the input");
  return box;
}

/// How fine a mesh is sampled for queries that have no grid.
constexpr double query_side = 0.01;

}  // namespace

void check_request(const SpaceRequest& request) {
  find_space_method(request.method).check(request.options);
}

Grid choose_grid(const PolygonSoup& input, const GridRequest& request) {
  if (request.resolution && request.spacing)
    throw InputError("only one of --resolution and --spacing can be given");
  if (request.resolution && *request.resolution < 2)
    throw InputError("option --resolution must be at least 2");
  if (request.spacing && !(*request.spacing > 0 && std::isfinite(*request.spacing)))
    throw InputError("option --spacing must be positive");
  if (!(request.padding >= 0 && request.padding <= 1e3))
    throw InputError("option --padding must be in [0, 1000]");
  Box box = bounding_box(input);
  if (request.bounds) {
    const auto& b = *request.bounds;
    const Box wanted{Vec3(b[0], b[1], b[2]), Vec3(b[3], b[4], b[5])};
    if (!(wanted.size().minCoeff() > 0) || !wanted.size().allFinite())
      throw InputError("option --bounds must be x0,y0,z0,x1,y1,z1 with x0 < x1, y0 < y1, z0 < z1");
    if ((wanted.low.array() > box.high.array()).any() ||
        (wanted.high.array() < box.low.array()).any())
      throw InputError("the box of --bounds misses the input");
    box = wanted;
  } else {
    const double longest = box.size().maxCoeff();
    if (!(longest > 0)) throw InputError("all points of the input are at one place");
    // Flat inputs still get nodes on both sides.
    const double margin = std::max(request.padding, 1e-3) * longest;
    box.low.array() -= margin;
    box.high.array() += margin;
  }
  const double longest = box.size().maxCoeff();
  const double spacing =
      request.spacing ? *request.spacing : longest / (request.resolution.value_or(64) - 1);
  Grid grid;
  for (int a = 0; a < 3; ++a) {
    const double cells = box.size()[a] / spacing;
    if (!(cells < 1e6))
      throw InputError("the grid would have more than a million nodes along an axis");
    const auto s = static_cast<std::size_t>(a);
    if (request.bounds) {
      grid.n[s] = std::max(2, static_cast<int>(std::lround(cells)) + 1);
      grid.spacing[a] = box.size()[a] / (grid.n[s] - 1);
      grid.origin[a] = box.low[a];
    } else {
      grid.n[s] = std::max(2, static_cast<int>(std::ceil(cells - 1e-9)) + 1);
      grid.spacing[a] = spacing;
      grid.origin[a] = (box.low[a] + box.high[a] - spacing * (grid.n[s] - 1)) / 2;
    }
  }
  check_grid(grid);
  return grid;
}

VecX grid_distance(const PolygonSoup& input, const Grid& grid, const SpaceRequest& request,
                   Task task, Report& report) {
  const SpaceMethod& method = find_space_method(request.method);
  method.check(request.options);
  const Frame frame(box_on_grid(input, grid));
  report.method = request.method;
  report.domain = "grid";
  report.sizes.emplace_back("nodes", static_cast<double>(grid.n_nodes()));
  const Grid local = frame.local(grid);
  // Errors at edges and corners are proportional to the spacing of samples: it must not exceed the
  // grid's.
  const SpaceProblem problem =
      make_problem(input, request, frame, local.spacing.minCoeff(), task, report);
  VecX phi;
  if (method.on_grid) {
    Task rest = task.stage(0.9, "distance");
    phi = method.on_grid(problem, local, request.options, rest, report);
  } else {
    const auto distance =
        method.pointwise(problem, request.options, task.stage(0.3, "preparing"), report);
    const Stopwatch watch(report, "evaluate");
    const Task rest = task.stage(0.6, "distance");
    phi.resize(static_cast<Eigen::Index>(grid.n_nodes()));
    const int rows = grid.n[1] * grid.n[2];
    parallel_for(static_cast<std::size_t>(rows), 1, [&](std::size_t row, std::size_t) {
      rest.checkpoint(static_cast<double>(row) / rows);
      const int j = static_cast<int>(row) % grid.n[1], k = static_cast<int>(row) / grid.n[1];
      for (int i = 0; i < grid.n[0]; ++i)
        phi[static_cast<Eigen::Index>(grid.node(i, j, k))] = distance->value(local.point(i, j, k));
    });
  }
  return phi * frame.unit;
}

TetField tet_distance(const PolygonSoup& input, const Grid& grid, const SpaceRequest& request,
                      VecX* on_grid, Task task, Report& report) {
  const SpaceMethod& method = find_space_method(request.method);
  if (request.method != "signed-heat")
    throw UnsupportedError("method " + request.method +
                           " does not run on tets; signed-heat does, and grids take all methods");
  const SpaceHeatOptions options =
      parse_options(method.info, space_heat_options(), request.options);
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
  const TetLattice lattice(local.origin, side, depth, source.points);
  building.checkpoint();
  const TetMesh& mesh = lattice.mesh();
  report.sizes.emplace_back("tets", mesh.n_tets());
  report.sizes.emplace_back("vertices", mesh.n_vertices());
  // The factor of the faces' matrix: about 60 numbers a face were seen.
  check_memory(2.1 * mesh.n_tets() * 60 * 16.0,
               "a lattice of " + std::to_string(mesh.n_tets()) + " tets",
               "use a smaller --resolution");
  const TetOperators ops = tet_operators(mesh);
  building.checkpoint();
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
  const VecX phi = signed_heat_tets(ops, terms, h, 0.01 * lattice.finest(), options,
                                    task.stage(0.8, "distance"), report);
  report_options(space_heat_options(), options, report);
  if (on_grid != nullptr) {
    on_grid->resize(static_cast<Eigen::Index>(grid.n_nodes()));
    for (int k = 0; k < grid.n[2]; ++k)
      for (int j = 0; j < grid.n[1]; ++j)
        for (int i = 0; i < grid.n[0]; ++i) {
          // Nodes on the far side of the box may lie outside by rounding.
          const Vec3 x = local.point(i, j, k)
                             .cwiseMin((local.origin.array() + side).matrix())
                             .cwiseMax(local.origin);
          const TetPoint p = lattice.locate(x);
          double value = 0;
          for (int c = 0; c < 4; ++c)
            value += p.barycentric[static_cast<std::size_t>(c)] * phi[mesh.tets(p.tet, c)];
          (*on_grid)[static_cast<Eigen::Index>(grid.node(i, j, k))] = frame.unit * value;
        }
  }
  TetField field{mesh, phi * frame.unit};
  field.mesh.points = (frame.unit * mesh.points).rowwise() + frame.centre.transpose();
  return field;
}

VecX query_distance(const PolygonSoup& input, const MatX3& queries, const SpaceRequest& request,
                    MatX3* gradients, Task task, Report& report) {
  const SpaceMethod& method = find_space_method(request.method);
  method.check(request.options);
  if (!method.pointwise) {
    std::string others;
    for (const SpaceMethod& m : space_methods())
      if (m.pointwise) others += (others.empty() ? "" : ", ") + m.info.name;
    throw UnsupportedError("method " + request.method +
                           " cannot be asked at single points; these can: " + others);
  }
  check_queries(queries);
  report.method = request.method;
  report.domain = "points";
  report.sizes.emplace_back("queries", static_cast<double>(queries.rows()));
  const Frame frame(bounding_box(input));
  const SpaceProblem problem = make_problem(input, request, frame, query_side, task, report);
  const auto distance =
      method.pointwise(problem, request.options, task.stage(0.3, "preparing"), report);
  const Stopwatch watch(report, "evaluate");
  return evaluate(*distance, frame.local(queries), gradients, task.stage(0.6, "distance")) *
         frame.unit;
}

VecX query_winding(const PolygonSoup& input, const MatX3& queries, const SpaceRequest& request,
                   Task task, Report& report) {
  check_queries(queries);
  report.method = "winding number";
  report.domain = "points";
  report.sizes.emplace_back("queries", static_cast<double>(queries.rows()));
  const Frame frame(bounding_box(input));
  const SpaceProblem problem =
      make_problem(input, request, frame, std::numeric_limits<double>::infinity(), task, report);
  const OrientedPoints& s = problem.samples;
  const WindingNumber winding = problem.is_cloud()
                                    ? WindingNumber(s.points, s.normals, s.areas)
                                    : WindingNumber(problem.surface.points, problem.triangles());
  const Stopwatch watch(report, "evaluate");
  const Task rest = task.stage(0.9, "winding number");
  const MatX3 local = frame.local(queries);
  VecX values(queries.rows());
  parallel_for(
      static_cast<std::size_t>(queries.rows()), 1024, [&](std::size_t begin, std::size_t end) {
        rest.checkpoint(static_cast<double>(begin) / static_cast<double>(queries.rows()));
        for (auto i = static_cast<Eigen::Index>(begin); i < static_cast<Eigen::Index>(end); ++i)
          values[i] = winding(local.row(i));
      });
  return values;
}

PolygonSoup fit_tori_cloud(const PolygonSoup& input, const SpaceRequest& request, Task task,
                           Report& report) {
  const SpaceMethod& method = find_space_method("tori");
  report.method = method.info.name;
  report.domain = "points";
  const Frame frame(bounding_box(input));
  const SpaceProblem problem = make_problem(input, request, frame, query_side, task, report);
  const auto distance =
      method.pointwise(problem, request.options, task.stage(0.9, "fitting"), report);
  const Tori& fitted = dynamic_cast<const Tori&>(*distance);
  std::vector<Torus> tori = fitted.tori();
  for (Torus& t : tori) t = frame.global(t);
  return cloud_of_tori((frame.unit * fitted.points()).rowwise() + frame.centre.transpose(), tori);
}

}  // namespace littoral
