#include "sources/systems/nodal_source_system.h"

#include <algorithm>
#include <cmath>

#include "operators/nodal.h"
#include "sources/systems/vector_dofs.h"

namespace littoral {

namespace {

using Row = Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator;

class NodeDofs : public VectorDofs {
 public:
  explicit NodeDofs(const NodalSurface& S)
      : S_(S), mesh_(*S.refined), unit_(S.place->unit), face_of_(S.place->n_faces()) {
    for (int f = 0; f < S.place->triangle_of_face.size(); ++f)
      if (const int t = S.place->triangle_of_face[f]; t >= 0) face_of_[t] = f;
  }

  void add_signed(const CurvePiece& piece, std::vector<DofVector>& out) const override {
    // N at a node is the left normal n x tangent, in the node's tangent plane (section 8.5).
    const Vec3 along = at(piece.face, piece.b) - at(piece.face, piece.a);
    const Vec3 left = piece.left ? along : Vec3(-along);  // of which
    const auto corners = mesh_.face(piece.face);
    for (int k = 0; k < 3; ++k)
      for (Row it(S_.P, corners[k]); it; ++it) {
        const double weight = 0.5 * (piece.a[k] + piece.b[k]) * it.value();
        if (weight == 0) continue;
        const TangentFrame frame(S_.normals.row(it.col()));
        out.emplace_back(it.col(), weight * frame.coordinates(frame.n.cross(left)));
      }
  }

  void add_unsigned(const CurvePiece& piece, std::vector<SidedContribution>& out) const override {
    const Vec3 start = at(piece.face, piece.a), along = at(piece.face, piece.b) - start;
    // The curve may run close to an edge without touching it: the nodes beyond count as well.
    std::vector<int> around;
    double size = 0;  // of the face
    const auto corners = mesh_.face(piece.face);
    for (int k = 0; k < 3; ++k) {
      size = std::max(size, (node(corners[k]) - node(corners[(k + 1) % 3])).norm());
      for (int f : mesh_.vertex_faces(corners[k])) {
        const std::vector<int> more = nodes_of(f);
        around.insert(around.end(), more.begin(), more.end());
      }
    }
    std::sort(around.begin(), around.end());
    around.erase(std::unique(around.begin(), around.end()), around.end());
    for (int i : around) {
      const double s = std::clamp(along.dot(node(i) - start) / along.squaredNorm(), 0.0, 1.0);
      const TangentFrame frame(S_.normals.row(i));
      const Complex away = frame.coordinates(node(i) - (start + s * along));
      const Complex left = frame.coordinates(frame.n.cross(along));  // as long as the piece
      // A node next to the curve is on neither side: which one would be up to rounding.
      // Nodes farther than the next ones add nothing.
      const double distance = std::abs(away), d = distance / size;
      const double share = std::min(1.0, 2 * d) * std::clamp(1.75 - d, 0.0, 1.0);
      if (!(share > 1e-6)) continue;
      out.push_back(
          {i, std::abs(left) * share * away / distance, (std::conj(left) * away).real() > 0});
    }
  }

  void add_radial(std::span<const PointInFace> where, double weight,
                  std::vector<DofVector>& out) const override {
    const std::size_t first = out.size();
    double Theta = 0;
    for (const auto& [t, b] : where) {
      const TriangleShape shape = S_.place->shape(t);
      const Complex x = b[0] * shape.p[0] + b[1] * shape.p[1] + b[2] * shape.p[2];
      double angle = 0;
      for (int k = 0; k < 3; ++k) {
        const Complex u = shape.p[k] - x, w = shape.p[(k + 1) % 3] - x;
        if (b[(k + 2) % 3] != 0 && u != 0.0 && w != 0.0) angle += std::abs(std::arg(w / u));
      }
      Theta += angle;
      const int face = face_of_[t];
      const Vec3 p = at(face, b);
      const std::vector<int> around = nodes_of(face);
      for (int i : around) {
        const Complex z = away(p, i, S_.spacing);
        if (z != 0.0) out.emplace_back(i, angle / static_cast<double>(around.size()) * z);
      }
    }
    for (std::size_t i = first; i < out.size(); ++i) out[i].second *= weight / Theta;
  }

 private:
  Vec3 node(int i) const { return mesh_.point(i) / unit_; }
  Vec3 at(int face, const std::array<double, 3>& b) const {
    const auto c = mesh_.face(face);
    return b[0] * node(c[0]) + b[1] * node(c[1]) + b[2] * node(c[2]);
  }
  /// The nodes that have a say in a face of the refined mesh.
  std::vector<int> nodes_of(int face) const {
    std::vector<int> nodes;
    for (int v : mesh_.face(face))
      for (Row it(S_.P, v); it; ++it) nodes.push_back(it.col());
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    return nodes;
  }
  /// Unit direction from a point to a node in the node's frame; 0 for a node at the point.
  Complex away(const Vec3& p, int i, double scale) const {
    const Complex z = TangentFrame(S_.normals.row(i)).coordinates(node(i) - p);
    return std::abs(z) > 1e-9 * scale ? z / std::abs(z) : Complex(0);
  }

  const NodalSurface& S_;
  const SurfaceMesh& mesh_;
  double unit_;
  std::vector<int> face_of_;  // triangle of `place` -> face
};

/// From triangles sources are placed on to cells, where exact distances are known at all corners.
void on_cells(const NodalSurface& S, SourceSystem& system) {
  std::vector<char> known(S.n_nodes(), 0);
  for (int t : system.near)
    for (int k = 0; k < 3; ++k) known[S.place->faces(t, k)] = 1;
  system.near.clear();
  for (int c = 0; c < S.cells->n_faces(); ++c) {
    const auto v = S.cells->faces.row(c);
    if (known[v[0]] && known[v[1]] && known[v[2]]) system.near.push_back(c);
  }
}

}  // namespace

SourceSystem nodal_source_system(const NodalSurface& S, const PlacedSources& sources) {
  // Exact distances would be needed at all nodes of a polygon.
  const bool at_vertices = S.P.rows() == S.P.cols();
  SourceSystem system = source_system(*S.refined, *S.place, sources, NodeDofs(S), at_vertices);
  // What is held at vertices of the refined mesh is held at the nodes that determine them.
  const SpMat P = S.P;
  system.u0 = SpMat(P.transpose() * system.u0);
  system.A = SpMat(system.A * P);
  system.mean = SpMat(system.mean * P);
  if (at_vertices)
    on_cells(S, system);
  else
    system.d0 = VecX::Zero(P.cols());
  return system;
}

}  // namespace littoral
