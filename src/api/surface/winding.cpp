#include "api/surface/winding.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "api/surface/discretization.h"
#include "api/surface/edge_chains.h"
#include "api/surface/face_chains.h"
#include "base/counted.h"
#include "base/index.h"
#include "base/lazy.h"
#include "base/stopwatch.h"
#include "domain/mesh/split_at_jumps.h"
#include "domain/mesh/unique_faces.h"
#include "littoral/error.h"
#include "methods/winding/dual_winding.h"
#include "methods/winding/nonconforming_winding.h"
#include "sources/curves/conform.h"
#include "sources/surface/surface_points.h"
#include "sources/surface/triangle_sources.h"

namespace littoral {

namespace {

Polylines polylines(const SurfaceMesh& mesh, const VecX& times) {
  Polylines lines;
  for (const std::vector<int>& chain : edge_chains(mesh, times)) {
    MatX3& line = lines.emplace_back(index(chain.size()), 3);
    for (std::size_t i = 0; i < chain.size(); ++i) line.row(index(i)) = mesh.point(chain[i]);
  }
  return lines;
}

double total_length(const Polylines& lines) {
  double length = 0;
  for (const MatX3& line : lines)
    for (Eigen::Index i = 1; i < line.rows(); ++i)
      length += (line.row(i) - line.row(i - 1)).stableNorm();
  return length;
}

/// The cut mesh with one vertex for every value that meets at it.
PolygonSoup split_by_value(const SurfaceMesh& mesh, const FaceTriangles& triangle_of_face,
                           const JumpCalculus& J, const WindingNumbers& numbers) {
  // Open corners belong to their face alone; others to all with the same label and value to 1e-6.
  Rows<std::int64_t, 3> key = Rows<std::int64_t, 3>::Zero(mesh.n_faces(), 3);
  for (int f = 0; f < mesh.n_faces(); ++f) {
    const int t = triangle_of_face[f];
    for (int k = 0; t >= 0 && k < 3; ++k) {
      const std::int64_t value = std::llround(numbers.w.u(t, k) * 1e6);
      key(f, k) = numbers.w.open[J.node(t, k)] ? (std::int64_t{1} << 62) + f
                                               : value * (1 << 20) + numbers.region[t];
    }
  }
  SplitSurface split = split_at_jumps(mesh, key);
  const auto n = index(split.corner.size());
  VecX winding = VecX::Zero(n), region = winding, weight = VecX::Ones(n);
  for (Eigen::Index v = 0; v < n; ++v) {
    const auto [f, k] = split.corner[v];
    const int t = triangle_of_face[f];
    if (t < 0) continue;
    winding[v] = numbers.w.u(t, k);
    region[v] = numbers.region[t];
    if (numbers.w.open[J.node(t, k)]) weight[v] = 0;
  }
  split.soup.scalars = {{"winding", winding}, {"region", region}, {"weight", weight}};
  return std::move(split.soup);
}

/// The label of the largest part of every face of the mesh that was cut.
VecXi labels_of_faces(const SurfaceMesh& mesh, const WindingAnswer& answer, const JumpCalculus& J) {
  std::vector<std::map<int, double>> area(mesh.n_faces());
  for (int f = 0; f < answer.cut.mesh.n_faces(); ++f)
    if (const int t = answer.triangle_of_face[f]; t >= 0)
      area[answer.cut.parent_face[f]][answer.numbers.region[t]] += J.area[t];
  VecXi region = VecXi::Zero(mesh.n_faces());
  for (int f = 0; f < mesh.n_faces(); ++f) {
    double largest = 0;
    for (const auto& [label, a] : area[f])
      if (a > largest) {
        largest = a;
        region[f] = label;
      }
  }
  return region;
}

/// An answer without copies of faces, in the numbers of the input.
void number_as_input(const UniqueFaces& unique, WindingAnswer& answer) {
  const VecXi region = answer.region;
  answer.region.resize(index(unique.face_of_input.size()));
  for (Eigen::Index f = 0; f < answer.region.size(); ++f)
    answer.region[f] = region[unique.face_of_input[f]];
  for (int& f : answer.cut.parent_face) f = unique.input_face[f];
  for (SurfacePoint& p : answer.cut.point)
    if (p.on == SurfacePoint::On::face) p.element = unique.input_face[p.element];
}

std::vector<CurvePiece> drawn_pieces(const SurfaceMesh& mesh, Sources drawn, Task& task,
                                     Report& report) {
  drawn.chains.clear();
  if (drawn.empty()) return {};
  return signed_pieces(
      place_sources(domain_of(mesh), drawn, task.stage(0.02, "placing the sources"), report),
      report);
}

ConformingCurves conforming(const SurfaceMesh& mesh, const std::vector<CurvePiece>& pieces,
                            Formulation formulation, Report& report) {
  if (pieces.empty() || formulation == Formulation::nonconforming)
    return {cut_mesh(mesh, {}), VecX::Zero(mesh.n_edges()), false};
  const Stopwatch watch(report, "cut");
  return conform(mesh, pieces);
}

std::vector<SegmentInFace> in_faces(const SurfaceMesh& mesh, const IntrinsicTriangulation& T,
                                    const std::vector<CurvePiece>& pieces) {
  std::vector<SegmentInFace> segments;
  for (const CurvePiece& piece : pieces) {
    if (T.triangle_of_face[piece.face] < 0) continue;
    const std::vector<TriangleSources::Segment> parts = segments_of(mesh, T, piece);
    for (const TriangleSources::Segment& s : parts) {
      SegmentInFace& out = segments.emplace_back();
      out.face = s.triangle;
      const TriangleShape shape = T.shape(s.triangle);
      for (int k = 0; k < 3; ++k) {
        out.vector += (s.b[k] - s.a[k]) * shape.p[k] / static_cast<double>(parts.size());
        out.middle[k] = (s.a[k] + s.b[k]) / 2;
      }
    }
  }
  return segments;
}

/// One polyline for every run of pieces of a curve.
Polylines polylines(const SurfaceMesh& mesh, const std::vector<CurvePiece>& pieces) {
  Polylines lines;
  for (std::size_t i = 0; i < pieces.size();) {
    std::size_t end = i;
    while (end < pieces.size() && pieces[end].curve == pieces[i].curve) ++end;
    MatX3& line = lines.emplace_back(index(end - i) + 1, 3);
    const auto at = [&](const CurvePiece& piece, const std::array<double, 3>& b) {
      return mesh.position(SurfacePoint::in_face(piece.face, b[0], b[1], b[2]));
    };
    line.row(0) = at(pieces[i], pieces[i].a);
    for (Eigen::Index row = 1; i < end; ++i, ++row) line.row(row) = at(pieces[i], pieces[i].b);
  }
  return lines;
}

void require_manifold_edges(const SurfaceMesh& mesh, const JumpCalculus& J, const VecX& curve) {
  for (int e = 0; e < J.n_edges; ++e)
    if (curve[e] != 0 && !J.manifold[e])
      throw UnsupportedError("the curve runs along the edge between vertices " +
                             std::to_string(mesh.edges()(e, 0)) + " and " +
                             std::to_string(mesh.edges()(e, 1)) +
                             ", where more than two faces meet and it has no sides; write it as a "
                             "chain of faces (c)");
}

/// Faces at edges of three or more are not glued there: the edge is a boundary of each.
void warn_of_nonmanifold_edges(const SurfaceMesh& mesh, const JumpCalculus& J, Report& report) {
  int count = 0, first = -1;
  for (int e = 0; e < J.n_edges; ++e)
    if (!J.manifold[e]) {
      if (count++ == 0) first = e;
    }
  if (count == 0) return;
  report.warn("nonmanifold-edges",
              counted(count, "edge has", "edges have") +
                  " more than two faces, the first between vertices " +
                  std::to_string(mesh.edges()(first, 0)) + " and " +
                  std::to_string(mesh.edges()(first, 1)) +
                  "; the surface was taken apart there; formulation dual goes on across them");
}

void check_combination(const SurfaceWinding& options) {
  const auto formulation = options.formulation;
  if (formulation != Formulation::primal &&
      options.boundary_condition != BoundaryCondition::natural)
    throw UnsupportedError("option boundary-condition: free boundaries need formulation primal",
                           "options-conflict");
  if (formulation != Formulation::primal && options.intrinsic_delaunay)
    throw UnsupportedError("option intrinsic-delaunay needs formulation primal",
                           "options-conflict");
  if (formulation == Formulation::nonconforming && options.labels == Labels::cut)
    throw UnsupportedError(
        "option labels: cut needs curves along edges, formulation primal or dual",
        "options-conflict");
}

std::shared_ptr<const DelaunayJumps> better_triangles(const SurfaceMesh& cut, const JumpSurface& on,
                                                      const VecX& curve,
                                                      const SurfaceWinding& options,
                                                      const Task& task, Report& report) {
  if (!options.intrinsic_delaunay) return nullptr;
  const Stopwatch watch(report, "retriangulation");
  return std::make_shared<const DelaunayJumps>(
      delaunay_jumps(cut, on.T, *on.J, curve, task, report));
}

class WindingOnSurface {
 public:
  explicit WindingOnSurface(WindingDomain domain)
      : domain_(std::move(domain)), unique_(domain_.mesh) {}

  WindingAnswer solve(const Sources& sources, SurfaceWinding& options, Task& task,
                      Report& report) const {
    if (!unique_.any_copies()) return solve_unique(sources, options, task, report);
    report.sizes.emplace_back("copies of faces", unique_.n_copies());
    WindingAnswer answer =
        solve_unique(unique_.on_mesh(*domain_.mesh, sources), options, task, report);
    number_as_input(unique_, answer);
    return answer;
  }

 private:
  WindingAnswer solve_unique(const Sources& sources, SurfaceWinding& options, Task& task,
                             Report& report) const {
    const SurfaceMesh& mesh = *unique_.mesh;
    if (!sources.chains.empty()) options.formulation = Formulation::dual;
    const Formulation formulation = options.formulation;
    check_combination(options);
    const std::vector<CurvePiece> pieces = drawn_pieces(mesh, sources, task, report);
    ConformingCurves curves = conforming(mesh, pieces, formulation, report);
    if (curves.is_cut && !sources.chains.empty())
      throw UnsupportedError(
          (sources.chains[0].origin.empty() ? "" : sources.chains[0].origin + ": ") +
          "chains of faces go with curves along edges, not through faces");
    WindingAnswer answer{{}, std::move(curves.cut), {}, {}, {}, {}, {}, {}};
    const SurfaceMesh& cut = answer.cut.mesh;
    if (curves.is_cut) report.sizes.emplace_back("cut_faces", cut.n_faces());
    task.checkpoint();
    // Without cuts the mesh is the input, numbers and all.
    const auto made = [&] { return std::make_shared<const JumpSurface>(cut, report); };
    const auto on = curves.is_cut ? made() : uncut_.get(made);
    const IntrinsicTriangulation& T = on->T;
    const auto& J = on->J;
    answer.triangle_of_face = T.triangle_of_face;
    const Task work = task.stage(0.9, "winding");
    if (formulation == Formulation::dual) {
      DualCurve curve{curves.times, pairs_at_nonmanifold_edges(*J)};
      require_manifold_edges(cut, *J, curve.edge);
      add_chains(sources.chains, *J, triangles_of_input(answer.triangle_of_face), curve);
      answer.numbers = dual_winding(*J, curve, options, work, report);
    } else {
      require_manifold_edges(cut, *J, curves.times);
      warn_of_nonmanifold_edges(cut, *J, report);
      answer.numbers =
          formulation == Formulation::primal
              ? WindingSolver(J, better_triangles(cut, *on, curves.times, options, work, report))
                    .solve(curves.times, options, work, report)
              : nonconforming_winding(*J, in_faces(cut, T, pieces), options, work, report);
    }
    answer.region = labels_of_faces(mesh, answer, *J);
    answer.shown = split_by_value(cut, answer.triangle_of_face, *J, answer.numbers);
    answer.completed = polylines(cut, answer.numbers.completed);
    const VecX& bounding = answer.numbers.bounding;
    if (formulation == Formulation::nonconforming)
      answer.bounding = polylines(cut, pieces);
    else
      answer.bounding = polylines(cut, bounding);
    answer.nonbounding = polylines(cut, answer.numbers.curve - bounding);
    report.sizes.emplace_back("bounding_length", total_length(answer.bounding));
    report.sizes.emplace_back("nonbounding_length", total_length(answer.nonbounding));
    report.sizes.emplace_back("completed_length", total_length(answer.completed));
    return answer;
  }

  /// Without cuts.
  FaceTriangles triangles_of_input(const FaceTriangles& triangle_of_face) const {
    if (!unique_.any_copies()) return triangle_of_face;
    std::vector<int> out;
    for (const int f : unique_.face_of_input) out.push_back(triangle_of_face[f]);
    return FaceTriangles(std::move(out));
  }

  WindingDomain domain_;
  UniqueFaces unique_;
  Kept<JumpSurface> uncut_;  // of `unique_`
};

}  // namespace

std::string WindingDomain::kind() const { return domain_of(*mesh).kind(); }

template <>
std::vector<Method<WindingDomain>> library_methods() {
  return {make_method<WindingDomain>(
      {SurfaceWinding::method,
       "Regions that (broken) signed curves bound on a surface, and curves that bound nothing.",
       {"triangle mesh"},
       {},
       "Feng, Gillespie, Crane: Winding Numbers on Discrete Surfaces (2023)"},
      winding_options(),
      [](const WindingDomain& domain, const SurfaceWinding& options, SolveHint, const Task&,
         Report&) {
        check_combination(options);
        return [method = std::make_shared<const WindingOnSurface>(domain)](
                   const Sources& sources, SurfaceWinding& used, Task& task, Report& report) {
          return method->solve(sources, used, task, report);
        };
      })};
}

Sources bounding_sources(const WindingAnswer& answer) {
  Sources sources;
  for (const auto& chain : edge_chains(answer.cut.mesh, answer.numbers.bounding)) {
    Curve curve;
    for (int v : chain) curve.nodes.push_back(answer.cut.point[v]);
    sources.curves.push_back(std::move(curve));
  }
  return sources;
}

}  // namespace littoral
