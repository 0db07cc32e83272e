#include "sources/systems/vector_dofs.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <unordered_map>

#include "base/index.h"
#include "littoral/error.h"
#include "sources/surface/surface_points.h"
#include "sources/surface/triangle_sources.h"
#include "sources/systems/constraint_rows.h"
#include "sources/systems/source_parts.h"

namespace littoral {

namespace {

/// Adds vectors to X0 and forgets what cancels: a curve and its reverse leave exactly nothing.
class Measure {
 public:
  void add(int dof, Complex z) {
    Sum& of = sums_[dof];
    of.vector += z;
    of.total += std::abs(z);
  }
  void add(std::vector<DofVector>& vectors) {
    for (const auto& [dof, z] : vectors) add(dof, z);
    vectors.clear();
  }
  /// Of the few dofs that have any, ascending.
  std::vector<DofVector> take() const {
    std::vector<DofVector> out;
    for (const auto& [dof, of] : sums_)
      if (!(Vec2(of.vector.real(), of.vector.imag()).norm() <= 1e-13 * of.total))
        out.emplace_back(dof, of.vector);
    std::sort(out.begin(), out.end(),
              [](const DofVector& a, const DofVector& b) { return a.first < b.first; });
    return out;
  }

 private:
  struct Sum {
    Complex vector = 0;
    double total = 0;
  };
  std::unordered_map<int, Sum> sums_;
};

/// Adds a stretch of an unsigned curve with both of its sides equally strong: where crossed edges
/// have their midpoints mostly on one side, that side would otherwise win everywhere far away.
void add_balanced(std::vector<SidedContribution>& stretch, Measure& X0) {
  double total[2] = {0, 0};
  for (const SidedContribution& side : stretch) total[side.left] += std::abs(side.z);
  const bool both = total[0] > 0 && total[1] > 0;
  for (const SidedContribution& side : stretch)
    X0.add(side.dof, both ? side.z * (0.5 * (total[0] + total[1]) / total[side.left]) : side.z);
  stretch.clear();
}

/// A.2, type C: at the two ends of an unsigned curve, radial vectors in the faces beyond the end,
/// weighted by the length of the last piece.
void add_end(const SurfaceMesh& mesh, const IntrinsicTriangulation& T, const SurfacePoint& end,
             const CurvePiece& last, const VectorDofs& dofs, std::vector<DofVector>& out) {
  std::vector<int> without;
  if (last.edge >= 0)
    for (int face : mesh.edge_faces(last.edge)) without.push_back(T.triangle_of_face[face]);
  else
    without.push_back(T.triangle_of_face[last.face]);
  dofs.add_radial(triangles_around(mesh, T, end, without), last.length / T.unit, out);
}

bool same_point(const SurfacePoint& p, const SurfacePoint& q) {
  return p.on == q.on && p.element == q.element && (p.on == SurfacePoint::On::vertex || p.b == q.b);
}

/// Where the source is sampled, and how much of it the sample stands for.
struct Sample {
  std::vector<std::pair<int, double>> hats;  // vertex, value
  double length;
  int node;  // of the connected part
  bool is_point;
  double value;
};
using Samples = std::vector<Sample>;

/// The samples' rows `mean` and, by batches, the unsigned measure u0.
void add_samples(const IntrinsicTriangulation& T, const Samples& samples, SourceNodes& nodes,
                 SourceSystem& system) {
  std::map<int, int> part_of_root;
  std::vector<char> is_point;  // parts
  std::vector<PartStart> starts;
  double least = 0;
  for (const Sample& s : samples) least = std::min(least, s.value);
  for (const Sample& s : samples) {
    const auto [it, added] = part_of_root.try_emplace(nodes.root(s.node), is_point.size());
    if (added) is_point.push_back(1);
    if (!s.is_point) is_point[it->second] = 0;
    // Distances are needed roughly only.
    for (const auto& [v, value] : s.hats)
      starts.push_back({v, it->second, s.value - least + (1 - value) * T.mean_edge_length});
  }
  const std::vector<int> batch = batches_of_parts(T, starts, int_size(is_point));
  // Points and curves apart, and what is counted from different values.
  std::map<std::tuple<int, bool, double>, int> column;
  std::vector<double> value_of;  // columns
  const auto column_of = [&](int part, double value) {
    const auto [it, added] = column.try_emplace({batch[part], is_point[part] != 0, value},
                                                system.batch_of_points.size());
    if (added) {
      system.batch_of_points.push_back(is_point[part]);
      value_of.push_back(value);
    }
    return it->second;
  };
  std::map<int, double> value_of_part;
  for (const Sample& s : samples)
    value_of_part.try_emplace(part_of_root.at(nodes.root(s.node)), s.value);
  for (const auto& [part, value] : value_of_part) column_of(part, value);
  Triplets mean, u0;
  system.mean_weight.resize(samples.size());
  system.mean_value.resize(samples.size());
  for (std::size_t r = 0; r < samples.size(); ++r) {
    const Sample& s = samples[r];
    const int to = column_of(part_of_root.at(nodes.root(s.node)), s.value);
    system.mean_weight[r] = s.length;
    system.mean_value[r] = s.value;
    for (const auto& [v, value] : s.hats) {
      mean.emplace_back(r, v, value);
      u0.emplace_back(v, to, s.length * value);
      if (T.component[v] >= 0) system.reached[T.component[v]] = 1;
    }
  }
  system.mean = matrix_of_few(std::move(mean), index(samples.size()), T.n_vertices);
  system.batch_value = Eigen::Map<const VecX>(value_of.data(), index(value_of.size()));
  system.u0 = matrix_of_few(std::move(u0), T.n_vertices, index(system.batch_of_points.size()));
}

/// Exact distance to the nearest point, counted from its value, on the triangles that hold one. A
/// point close to a curve is left out: what is held along the curve must not depend on it. Returns
/// for each point whether it is in.
std::vector<char> add_near(const SurfaceMesh& mesh, const IntrinsicTriangulation& T,
                           const PlacedSources& sources, SourceSystem& system) {
  std::vector<char> by_curve(T.n_vertices, 0);
  for (const CurvePiece& piece : sources.pieces)
    for (int k = 0; k < 3; ++k)
      if (piece.edge < 0 || piece.a[k] > 0 || piece.b[k] > 0)
        by_curve[mesh.face(piece.face)[k]] = 1;
  system.d0 = VecX::Constant(T.n_vertices, infinity);
  std::vector<char> in(sources.points.size(), 0);
  for (std::size_t i = 0; i < sources.points.size(); ++i) {
    const auto where = triangles_around(mesh, T, sources.points[i]);
    bool free = true;
    for (const PointInFace& place : where)
      for (int k = 0; k < 3; ++k) free = free && !by_curve[T.faces(place.face, k)];
    if (!free) continue;
    in[i] = 1;
    const double value = sources.point_value(i) / T.unit;
    for (const PointInFace& place : where) {
      const TriangleShape t = T.shape(place.face);
      system.near.push_back(place.face);
      for (int k = 0; k < 3; ++k) {
        double& d = system.d0[T.faces(place.face, k)];
        d = std::min(d, value + std::abs(t.p[k] - t.at(place.b)));
      }
    }
  }
  std::sort(system.near.begin(), system.near.end());
  system.near.erase(std::unique(system.near.begin(), system.near.end()), system.near.end());
  system.d0 = (system.d0.array() < infinity).select(system.d0, 0.0);
  return in;
}

}  // namespace

VecX SourceSystem::vectors(int dofs) const {
  VecX out = VecX::Zero(2 * Eigen::Index{dofs});
  for (const auto* some : {&X0, &X0_points})
    for (const auto& [dof, z] : *some) out.segment<2>(2 * dof) += Vec2(z.real(), z.imag());
  return out;
}

SourceSystem source_system(const SurfaceMesh& mesh, const IntrinsicTriangulation& T,
                           const PlacedSources& sources, const VectorDofs& dofs,
                           bool exact_near_points) {
  SourceSystem system;
  std::vector<DofVector> vectors;
  system.only_points = sources.pieces.empty();
  system.reached.assign(T.n_components, 0);
  const double h = T.mean_edge_length;
  Measure X0, X0_points;
  SourceNodes nodes;
  ConstraintRowBuilder rows(h);
  Samples samples;
  std::vector<SidedContribution> stretch;
  double stretch_length = 0;
  for (std::size_t i = 0; i < sources.pieces.size(); ++i) {
    const CurvePiece& piece = sources.pieces[i];
    if (T.triangle_of_face[piece.face] < 0) continue;
    if (piece.is_signed)
      dofs.add_signed(piece, vectors);
    else
      dofs.add_unsigned(piece, stretch);
    X0.add(vectors);
    stretch_length += piece.length / T.unit;
    const bool curve_ends =
        i + 1 == sources.pieces.size() || sources.pieces[i + 1].curve != piece.curve;
    if (curve_ends || stretch_length > 2.5 * h) {
      add_balanced(stretch, X0);
      stretch_length = 0;
    }
    const double value = piece.value / T.unit;
    int ends[2];
    for (int side = 0; side < 2; ++side) {
      const auto& b = side ? piece.b : piece.a;
      ends[side] = nodes.id(simplest(mesh, SurfacePoint::in_face(piece.face, b[0], b[1], b[2])));
      if (piece.edge >= 0) nodes.weight[ends[side]] += 0.5 * piece.length / T.unit / h;
      nodes.value[ends[side]] = std::min(nodes.value[ends[side]], value);
    }
    nodes.join(ends[0], ends[1]);
    const auto c = mesh.face(piece.face);
    std::vector<std::pair<int, double>> middle;
    for (int k = 0; k < 3; ++k) middle.emplace_back(c[k], 0.5 * (piece.a[k] + piece.b[k]));
    samples.push_back({middle, piece.length / T.unit, ends[0], false, value});
    if (i > 0 && sources.pieces[i - 1].curve != piece.curve) rows.end_run();
    if (piece.edge < 0)
      rows.add_piece(middle, piece.length / T.unit, ends[0], value);
    else
      rows.end_run();
    if (piece.is_signed) continue;
    const auto& line = sources.nodes[piece.curve];
    if (same_point(line.front(), line.back())) continue;
    const bool first = i == 0 || sources.pieces[i - 1].curve != piece.curve;
    if (first) add_end(mesh, T, nodes.points[ends[0]], piece, dofs, vectors);
    if (curve_ends) add_end(mesh, T, nodes.points[ends[1]], piece, dofs, vectors);
    X0.add(vectors);
  }
  system.d0 = VecX::Zero(T.n_vertices);
  const std::vector<char> near = exact_near_points ? add_near(mesh, T, sources, system)
                                                   : std::vector<char>(sources.points.size(), 0);
  for (std::size_t i = 0; i < sources.points.size(); ++i) {
    const SurfacePoint& p = sources.points[i];
    const double value = sources.point_value(i) / T.unit;
    // A point weighs as much as a curve of one edge's length: the balance does not depend on units.
    dofs.add_radial(triangles_around(mesh, T, p), h, vectors);
    X0_points.add(vectors);
    const int node = nodes.id(p);
    nodes.weight[node] += 1;
    nodes.value[node] = std::min(nodes.value[node], near[i] ? 0 : value);
    samples.push_back({hats(mesh, p), h, node, true, value});
  }
  add_samples(T, samples, nodes, system);
  if (std::find(system.reached.begin(), system.reached.end(), 1) == system.reached.end())
    throw InputError("no source lies on a face with three different vertices", "nothing-there");
  system.X0 = X0.take();
  system.X0_points = X0_points.take();
  rows.write(mesh, nodes, system);
  return system;
}

}  // namespace littoral
