#include "sources/systems/triangle_source_system.h"

#include <algorithm>
#include <cmath>

#include "sources/surface/triangle_sources.h"
#include "sources/systems/vector_dofs.h"

namespace littoral {

namespace {

class EdgeDofs : public VectorDofs {
 public:
  EdgeDofs(const SurfaceMesh& mesh, const IntrinsicTriangulation& T) : mesh_(mesh), T_(T) {}

  // Eq. 11 without the factor phi_ij(m): length times normal, to the edge the piece runs along or
  // to all three edges of its face.
  void add_signed(const CurvePiece& piece, std::vector<DofVector>& out) const override {
    const int f = T_.triangle_of_face[piece.face];
    const TriangleShape t = T_.shape(f);
    const Complex tangent = t.at(piece.b) - t.at(piece.a);
    // Already times its length. A frame's imaginary axis is to the left.
    const Complex N = Complex(0, piece.left ? 1 : -1) * tangent;
    for (int k = 0; k < 3; ++k)
      if (piece.edge < 0 || T_.side_edge(f, k) == piece.edge)
        out.emplace_back(T_.side_edge(f, k), T_.face_to_edge(t, f, k, N));
  }

  void add_unsigned(const CurvePiece& piece, std::vector<SidedContribution>& out) const override {
    // Along an edge: the same from every face at the edge.
    for (const TriangleSources::Segment& part : segments_of(mesh_, T_, piece))
      add_beside(piece, part.triangle, part.a, part.b, out);
  }

  void add_radial(std::span<const PointInFace> where, double weight,
                  std::vector<DofVector>& out) const override {
    add_radial_measure(T_, where, weight, out);
  }

 private:
  /// A.2, type A, also inside faces: away from the nearest point of the piece at each edge
  /// midpoint.
  void add_beside(const CurvePiece& piece, int f, const std::array<double, 3>& a,
                  const std::array<double, 3>& b, std::vector<SidedContribution>& out) const {
    const TriangleShape t = T_.shape(f);
    const Complex start = t.at(a), along = t.at(b) - start;
    const double length = std::abs(along);
    if (!(length > 0)) return;
    for (int k = 0; k < 3; ++k) {
      if (T_.side_edge(f, k) == piece.edge) continue;
      const Complex m = 0.5 * (t.p[k] + t.p[(k + 1) % 3]);
      const double s =
          std::clamp((std::conj(along) * (m - start)).real() / (length * length), 0.0, 1.0);
      const Complex away = m - (start + s * along);
      if (std::abs(away) <= 1e-12 * length) continue;  // the curve passes through the midpoint
      const Complex z = away / std::abs(away) * length;
      out.push_back({T_.side_edge(f, k), T_.face_to_edge(t, f, k, z),
                     (std::conj(along) * away).imag() * T_.orientation[f] > 0});
    }
  }

  const SurfaceMesh& mesh_;
  const IntrinsicTriangulation& T_;
};

}  // namespace

SourceSystem source_system(const SurfaceMesh& mesh, const IntrinsicTriangulation& T,
                           const PlacedSources& sources) {
  return source_system(mesh, T, sources, EdgeDofs(mesh, T));
}

}  // namespace littoral
