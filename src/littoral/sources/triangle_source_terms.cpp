#include "littoral/sources/triangle_source_terms.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>

#include "littoral/base/error.h"
#include "littoral/operators/triangles.h"
#include "littoral/sources/surface_points.h"

namespace littoral {

namespace {

Complex at(const TriangleShape& t, const std::array<double, 3>& b) {
  return b[0] * t.p[0] + b[1] * t.p[1] + b[2] * t.p[2];
}

/// Adds vectors to X0 and forgets what cancels: a curve and its reverse leave exactly nothing.
class Measure {
 public:
  explicit Measure(int n_edges) : X0_(VecX::Zero(2 * n_edges)), total_(VecX::Zero(n_edges)) {}
  void add(int edge, Complex z) {
    X0_[2 * edge] += z.real();
    X0_[2 * edge + 1] += z.imag();
    total_[edge] += std::abs(z);
  }
  VecX take() {
    for (Eigen::Index e = 0; e < total_.size(); ++e)
      if (X0_.segment<2>(2 * e).norm() <= 1e-13 * total_[e]) X0_.segment<2>(2 * e).setZero();
    return std::move(X0_);
  }

 private:
  VecX X0_, total_;
};

/// Triangles around a point, with its barycentrics; `without` lists triangles to leave out.
std::vector<PointInFace> around(const SurfaceMesh& mesh, const IntrinsicTriangulation& T,
                                const SurfacePoint& p, const std::vector<int>& without = {}) {
  std::vector<PointInFace> where;
  for (int face : faces_at(mesh, p)) {
    const int t = T.triangle_of_face[face];
    if (t < 0 || std::find(without.begin(), without.end(), t) != without.end()) continue;
    if (const auto b = barycentrics_in(mesh, p, face)) where.push_back({t, *b});
  }
  return where;
}

/// Eq. 11 without the factor phi_ij(m): length times normal, to the edge the piece runs along or to
/// all three edges of its face.
void add_signed(const IntrinsicTriangulation& T, const CurvePiece& piece, Measure& X0) {
  const int f = T.triangle_of_face[piece.face];
  const TriangleShape t = T.shape(f);
  const Complex tangent = at(t, piece.b) - at(t, piece.a);
  const Complex N = Complex(0, 1) * tangent;  // already times its length, to the left in this frame
  for (int k = 0; k < 3; ++k)
    if (piece.edge < 0 || T.side_edge(f, k) == piece.edge)
      X0.add(T.side_edge(f, k), T.face_to_edge(t, f, k, N));
}

/// Contributions of an unsigned curve, by the side they point to.
struct Push {
  int edge;
  Complex z;
  bool left;
};

/// Adds a stretch of an unsigned curve with both of its sides equally strong: where crossed edges
/// have their midpoints mostly on one side, that side would otherwise win everywhere far away.
void add_balanced(std::vector<Push>& stretch, Measure& X0) {
  double total[2] = {0, 0};
  for (const Push& push : stretch) total[push.left] += std::abs(push.z);
  const bool both = total[0] > 0 && total[1] > 0;
  for (const Push& push : stretch)
    X0.add(push.edge, both ? push.z * (0.5 * (total[0] + total[1]) / total[push.left]) : push.z);
  stretch.clear();
}

/// A.2, type A, also inside faces: away from the nearest point of the piece at each edge midpoint.
void add_unsigned(const IntrinsicTriangulation& T, const CurvePiece& piece, int f,
                  const std::array<double, 3>& a, const std::array<double, 3>& b,
                  std::vector<Push>& out) {
  const TriangleShape t = T.shape(f);
  const Complex start = at(t, a), along = at(t, b) - start;
  const double length = std::abs(along);
  if (!(length > 0)) return;
  for (int k = 0; k < 3; ++k) {
    if (T.side_edge(f, k) == piece.edge) continue;
    const Complex m = 0.5 * (t.p[k] + t.p[(k + 1) % 3]);
    const double s =
        std::clamp((std::conj(along) * (m - start)).real() / (length * length), 0.0, 1.0);
    const Complex away = m - (start + s * along);
    if (std::abs(away) <= 1e-12 * length) continue;  // the curve passes through the midpoint
    const Complex z = away / std::abs(away) * length;
    out.push_back({T.side_edge(f, k), T.face_to_edge(t, f, k, z),
                   (std::conj(along) * away).imag() * T.orientation[f] > 0});
  }
}

void add_unsigned_curve_piece(const SurfaceMesh& mesh, const IntrinsicTriangulation& T,
                              const CurvePiece& piece, std::vector<Push>& out) {
  if (piece.edge < 0) {
    add_unsigned(T, piece, T.triangle_of_face[piece.face], piece.a, piece.b, out);
    return;
  }
  // Along an edge: the same from every face at the edge.
  const auto corners = mesh.face(piece.face);
  auto on_edge = [&](const std::array<double, 3>& b) {
    double head = 0;
    for (int k = 0; k < 3; ++k)
      if (corners[k] == mesh.edges()(piece.edge, 1)) head = b[k];
    return SurfacePoint::on_edge(piece.edge, head);
  };
  const SurfacePoint p = simplest(mesh, on_edge(piece.a)), q = simplest(mesh, on_edge(piece.b));
  for (int face : mesh.edge_faces(piece.edge)) {
    const int f = T.triangle_of_face[face];
    if (f < 0) continue;
    const auto a = barycentrics_in(mesh, p, face), b = barycentrics_in(mesh, q, face);
    if (a && b) add_unsigned(T, piece, f, *a, *b, out);
  }
}

/// A.2, type C: at the two ends of an unsigned curve, radial vectors in the faces beyond the end,
/// weighted by the length of the last piece.
void add_end(const SurfaceMesh& mesh, const IntrinsicTriangulation& T, const SurfacePoint& end,
             const CurvePiece& last, Measure& X0) {
  std::vector<int> without;
  if (last.edge >= 0)
    for (int face : mesh.edge_faces(last.edge)) without.push_back(T.triangle_of_face[face]);
  else
    without.push_back(T.triangle_of_face[last.face]);
  std::vector<std::pair<int, Complex>> radial;
  add_radial_measure(T, around(mesh, T, end, without), last.length / T.unit, radial);
  for (const auto& [e, z] : radial) X0.add(e, z);
}

bool same_point(const SurfacePoint& p, const SurfacePoint& q) {
  return p.on == q.on && p.element == q.element && (p.on == SurfacePoint::On::vertex || p.b == q.b);
}

/// Nodes as unknowns of union-find: nodes at the same place belong to one connected part.
class Nodes {
 public:
  int id(const SurfacePoint& p) {
    const auto key = p.on == SurfacePoint::On::vertex
                         ? std::make_tuple(0, p.element, std::array<double, 3>{1, 0, 0})
                         : std::make_tuple(int(p.on), p.element, p.b);
    const auto [it, added] = ids_.try_emplace(key, static_cast<int>(points.size()));
    if (added) {
      points.push_back(p);
      weight.push_back(0);
      parent_.push_back(it->second);
    }
    return it->second;
  }
  void join(int a, int b) { parent_[std::max(root(a), root(b))] = std::min(root(a), root(b)); }
  int root(int a) {
    while (parent_[a] != a) a = parent_[a] = parent_[parent_[a]];
    return a;
  }
  std::vector<SurfacePoint> points;
  std::vector<double> weight;

 private:
  std::map<std::tuple<int, int, std::array<double, 3>>, int> ids_;
  std::vector<int> parent_;
};

/// Hat functions at a point: (vertex, value).
std::vector<std::pair<int, double>> hats(const SurfaceMesh& mesh, const SurfacePoint& p) {
  switch (p.on) {
    case SurfacePoint::On::vertex:
      return {{p.element, 1.0}};
    case SurfacePoint::On::edge:
      return {{mesh.edges()(p.element, 0), p.b[0]}, {mesh.edges()(p.element, 1), p.b[1]}};
    case SurfacePoint::On::face:
      break;
  }
  const auto c = mesh.face(p.element);
  return {{c[0], p.b[0]}, {c[1], p.b[1]}, {c[2], p.b[2]}};
}

/// Constraint rows. A curve along edges, and every point, holds values at its nodes. A curve
/// through faces holds means over stretches of about 2.5 edge lengths: as many conditions as
/// crossed edges would leave a linear function on the crossed triangles no choice but zero at all
/// their corners.
class ConstraintRows {
 public:
  struct Row {
    std::vector<std::pair<int, double>> entries;  // vertex, coefficient; may repeat a vertex
    double weight = 0;                            // length, mean edge lengths
    int node = 0;                                 // a node of the same connected part
  };
  explicit ConstraintRows(double h) : h_(h) {}

  void add_piece(const std::vector<std::pair<int, double>>& middle, double length, int node) {
    run_.push_back({middle, length / h_, node});
  }
  /// Ends a stretch of consecutive pieces inside faces.
  void end_run() {
    double total = 0;
    for (const Row& piece : run_) total += piece.weight;
    const double block = total / std::max(1.0, std::round(total / 2.5));
    double passed = 0;
    int blocks = -1;
    for (const Row& piece : run_) {
      const int at = static_cast<int>((passed + 0.5 * piece.weight) / block);
      if (at != blocks) rows.push_back({{}, 0, piece.node});
      blocks = at;
      for (const auto& [v, value] : piece.entries)
        rows.back().entries.emplace_back(v, piece.weight * value);
      rows.back().weight += piece.weight;
      passed += piece.weight;
    }
    run_.clear();
  }
  std::vector<Row> rows;

 private:
  double h_;
  std::vector<Row> run_;
};

}  // namespace

SourceTerms source_terms(const SurfaceMesh& mesh, const IntrinsicTriangulation& T,
                         const PreparedSources& sources) {
  SourceTerms terms;
  Measure X0(T.n_edges());
  terms.u0 = VecX::Zero(T.n_vertices);
  terms.only_points = sources.pieces.empty();
  terms.reached.assign(T.n_components, 0);
  Triplets mean, rows;
  std::vector<double> mean_weight;
  const double h = T.mean_edge_length;
  auto sample = [&](const std::vector<std::pair<int, double>>& at_point, double length) {
    const int row = static_cast<int>(mean_weight.size());
    mean_weight.push_back(length);
    for (const auto& [v, value] : at_point) {
      mean.emplace_back(row, v, value);
      terms.u0[v] += length * value;
      if (T.component[v] >= 0) terms.reached[T.component[v]] = 1;
    }
  };

  Nodes nodes;
  ConstraintRows curve_rows(h);
  std::vector<Push> stretch;
  double stretch_length = 0;
  for (std::size_t i = 0; i < sources.pieces.size(); ++i) {
    const CurvePiece& piece = sources.pieces[i];
    if (T.triangle_of_face[piece.face] < 0) continue;
    if (piece.is_signed)
      add_signed(T, piece, X0);
    else
      add_unsigned_curve_piece(mesh, T, piece, stretch);
    stretch_length += piece.length / T.unit;
    const bool curve_ends =
        i + 1 == sources.pieces.size() || sources.pieces[i + 1].curve != piece.curve;
    if (curve_ends || stretch_length > 2.5 * h) {
      add_balanced(stretch, X0);
      stretch_length = 0;
    }
    const auto c = mesh.face(piece.face);
    std::vector<std::pair<int, double>> middle;
    for (int k = 0; k < 3; ++k) middle.emplace_back(c[k], 0.5 * (piece.a[k] + piece.b[k]));
    sample(middle, piece.length / T.unit);
    int ends[2];
    for (int side = 0; side < 2; ++side) {
      const auto& b = side ? piece.b : piece.a;
      ends[side] = nodes.id(simplest(mesh, SurfacePoint::in_face(piece.face, b[0], b[1], b[2])));
      if (piece.edge >= 0) nodes.weight[ends[side]] += 0.5 * piece.length / T.unit / h;
    }
    nodes.join(ends[0], ends[1]);
    if (i > 0 && sources.pieces[i - 1].curve != piece.curve) curve_rows.end_run();
    if (piece.edge < 0)
      curve_rows.add_piece(middle, piece.length / T.unit, ends[0]);
    else
      curve_rows.end_run();
    if (piece.is_signed) continue;
    const auto& line = sources.nodes[piece.curve];
    if (same_point(line.front(), line.back())) continue;
    const bool first = i == 0 || sources.pieces[i - 1].curve != piece.curve;
    if (first) add_end(mesh, T, nodes.points[ends[0]], piece, X0);
    if (curve_ends) add_end(mesh, T, nodes.points[ends[1]], piece, X0);
  }
  curve_rows.end_run();
  for (const SurfacePoint& p : sources.points) {
    // A point weighs as much as a curve of one edge's length: the balance does not depend on units.
    std::vector<std::pair<int, Complex>> radial;
    add_radial_measure(T, around(mesh, T, p), h, radial);
    for (const auto& [e, z] : radial) X0.add(e, z);
    sample(hats(mesh, p), h);
    nodes.weight[nodes.id(p)] += 1;
  }
  if (std::find(terms.reached.begin(), terms.reached.end(), 1) == terms.reached.end())
    throw InputError("no source lies on a face with three different vertices");

  terms.X0 = X0.take();
  std::vector<ConstraintRows::Row> all = std::move(curve_rows.rows);
  for (std::size_t i = 0; i < nodes.points.size(); ++i)
    if (nodes.weight[i] > 0)
      all.push_back({hats(mesh, nodes.points[i]), nodes.weight[i], static_cast<int>(i)});
  std::map<int, int> group_of_root;
  terms.weight.resize(static_cast<Eigen::Index>(all.size()));
  for (std::size_t r = 0; r < all.size(); ++r) {
    double sum = 0;  // a mean, whatever the coefficients were weighted with
    for (const auto& [v, value] : all[r].entries) sum += value;
    for (const auto& [v, value] : all[r].entries)
      rows.emplace_back(static_cast<int>(r), v, value / sum);
    terms.weight[static_cast<Eigen::Index>(r)] = all[r].weight;
    const auto [it, added] = group_of_root.try_emplace(nodes.root(all[r].node), terms.n_groups);
    if (added) ++terms.n_groups;
    terms.group.push_back(it->second);
  }
  terms.A.resize(static_cast<Eigen::Index>(all.size()), T.n_vertices);
  terms.A.setFromTriplets(rows.begin(), rows.end());
  terms.mean.resize(static_cast<Eigen::Index>(mean_weight.size()), T.n_vertices);
  terms.mean.setFromTriplets(mean.begin(), mean.end());
  terms.mean_weight =
      Eigen::Map<VecX>(mean_weight.data(), static_cast<Eigen::Index>(mean_weight.size()));
  return terms;
}

}  // namespace littoral
