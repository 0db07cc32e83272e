#pragma once
// Exact and fast-marching distance in one call, and a slow exact answer to compare with.

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <random>

#include "domain/mesh/edge_sides.h"
#include "heat_helpers.h"
#include "methods/geodesic/exact_polyhedral.h"
#include "methods/geodesic/fast_marching.h"
#include "test_meshes.h"

namespace littoral::test {

template <class Method>
auto geodesic(Method method, const SurfaceMesh& mesh, const Sources& sources, Report& report,
              const Task& task = {}) {
  const IntrinsicTriangulation T = intrinsic_triangulation(mesh, report);
  return method(T, triangle_sources(mesh, T, place_sources(mesh, sources, report)), task, report);
}
inline ExactDistance exact_once(const IntrinsicTriangulation& T, const TriangleSources& sources,
                                const Task& task, Report& report) {
  return exact_polyhedral(T, sources, task, report);
}
inline VecX exact(const SurfaceMesh& mesh, const Sources& sources) {
  Report report;
  return geodesic(exact_once, mesh, sources, report).distance;
}
inline VecX marched(const SurfaceMesh& mesh, const Sources& sources) {
  Report report;
  return geodesic(fast_marching, mesh, sources, report);
}

/// A ring of n columns of circumference 2 pi (as a polygon in space, lengths exact) and `rows` rows
/// of faces; vertex j n + i is column i of level j.
inline SurfaceMesh ring(int n, int rows, double row_height) {
  PolygonSoup soup;
  const double turn = 2 * std::acos(-1.0), radius = turn / n / 2 / std::sin(turn / 2 / n);
  soup.points.resize(n * (rows + 1), 3);
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i < n; ++i) {
      const double a = turn * i / n;
      soup.points.row(j * n + i) << radius * std::cos(a), radius * std::sin(a), row_height * j;
    }
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = j * n + i, b = j * n + (i + 1) % n;
      add_triangle(soup, a, b, b + n);
      add_triangle(soup, a, b + n, a + n);
    }
  return SurfaceMesh(soup);
}

/// A few random triangles glued at random along edges: nonmanifold, with boundary, bent.
inline PolygonSoup scrap(unsigned seed, int n_faces) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> u(-1, 1);
  PolygonSoup soup;
  std::vector<Vec3> points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  std::vector<std::array<int, 2>> edges = {{0, 1}, {1, 2}, {2, 0}};
  add_triangle(soup, 0, 1, 2);
  while (soup.n_faces() < n_faces) {
    const auto [a, b] = edges[random() % edges.size()];
    int c = static_cast<int>(points.size());
    if (random() % 3 == 0) c = static_cast<int>(random() % points.size());
    if (c == a || c == b) continue;
    if (c == static_cast<int>(points.size()))
      points.push_back((points[a] + points[b]) / 2 + Vec3(u(random), u(random), u(random)));
    add_triangle(soup, a, b, c);
    edges.push_back({b, c});
    edges.push_back({c, a});
  }
  soup.points.resize(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i)
    soup.points.row(static_cast<Eigen::Index>(i)) = points[i];
  return soup;
}

/// The mesh in vertices.txt and faces_1based.txt of a folder.
inline SurfaceMesh one_based_mesh(const std::filesystem::path& folder) {
  std::ifstream vertices(folder / "vertices.txt"), faces(folder / "faces_1based.txt");
  std::vector<double> x{std::istream_iterator<double>(vertices), {}};
  const std::vector<int> f{std::istream_iterator<int>(faces), {}};
  PolygonSoup soup;
  soup.points = Eigen::Map<MatX3>(x.data(), static_cast<Eigen::Index>(x.size() / 3), 3);
  for (std::size_t i = 0; i + 2 < f.size(); i += 3)
    add_triangle(soup, f[i] - 1, f[i + 1] - 1, f[i + 2] - 1);
  return SurfaceMesh(soup);
}

/// Distance between all vertices of a small mesh by following every straight path through every
/// sequence of triangles (up to a bound on the length), bent at any vertex. Exponential time.
class GeodesicOracle {
 public:
  explicit GeodesicOracle(const SurfaceMesh& mesh) {
    Report report;
    T_ = intrinsic_triangulation(mesh, report);
    sides_ = edge_sides(T_);
    const int n = T_.n_vertices;
    d_ = Eigen::MatrixXd::Constant(n, n, std::numeric_limits<double>::infinity());
    d_.diagonal().setZero();
    for (int e = 0; e < T_.n_edges(); ++e) {
      const int a = T_.edges(e, 0), b = T_.edges(e, 1);
      d_(a, b) = d_(b, a) = (mesh.point(a) - mesh.point(b)).norm() / T_.unit;
    }
    close();  // along edges: a bound that cuts the search off
    const Eigen::MatrixXd bound = d_;
    for (int f = 0; f < T_.n_faces(); ++f)
      for (int k = 0; k < 3; ++k) {
        const auto t = triangle_shape(T_.length(f, k), T_.length(f, (k + 1) % 3),
                                      T_.length(f, (k + 2) % 3), false);
        from_ = T_.faces(f, k);
        limit_ = bound.row(from_).maxCoeff();
        unfold(f, (k + 1) % 3, true, t.p[1], t.p[2], t.p[1], t.p[2], 0);
      }
    close();
    d_ *= T_.unit;
  }
  double operator()(int a, int b) const { return d_(a, b); }

 private:
  static double cross(Complex a, Complex b) { return (std::conj(a) * b).imag(); }
  /// Rays from 0 between directions r (right) and l (left) leave face f through side k, from P
  /// (right) to Q (left); does the side start at P?
  void unfold(int f, int k, bool starts_at_P, Complex P, Complex Q, Complex r, Complex l,
              int depth) {
    if (depth > 20) return;
    for (const TriangleSide& s : sides_.at(T_.side_edge(f, k))) {
      if (s == TriangleSide(f, k)) continue;
      const bool at_P = starts_at_P == (T_.along(s.face(), s.k()) == T_.along(f, k));
      const double L = T_.length(s.face(), s.k());
      const auto t = triangle_shape(L, T_.length(s.face(), (s.k() + 1) % 3),
                                    T_.length(s.face(), (s.k() + 2) % 3), false);
      const double along = at_P ? t.p[2].real() : L - t.p[2].real();
      const Complex R = P + (Q - P) / std::abs(Q - P) * Complex(along, -t.p[2].imag());
      if (cross(r, R) >= -1e-12 && cross(R, l) >= -1e-12) {
        const int v = T_.faces(s.face(), (s.k() + 2) % 3);
        d_(from_, v) = d_(v, from_) = std::min(d_(v, from_), std::abs(R));
      }
      // Nearest point of an edge beyond the limit: no shortest path leads there.
      auto near = [&](Complex a, Complex b) {
        const double x = std::clamp(-(std::conj(b - a) * a).real() / std::norm(b - a), 0.0, 1.0);
        return std::abs(a + x * (b - a)) < limit_;
      };
      const int k1 = (s.k() + 1) % 3, k2 = (s.k() + 2) % 3;
      const Complex left = cross(R, l) > 0 ? R : l;  // bounds the rays through P R
      if (cross(r, left) > 1e-12 && near(P, R))
        unfold(s.face(), at_P ? k2 : k1, !at_P, P, R, r, left, depth + 1);
      const Complex right = cross(r, R) > 0 ? R : r;
      if (cross(right, l) > 1e-12 && near(R, Q))
        unfold(s.face(), at_P ? k1 : k2, !at_P, R, Q, right, l, depth + 1);
    }
  }
  void close() {
    const Eigen::Index n = d_.rows();
    for (Eigen::Index m = 0; m < n; ++m)
      for (Eigen::Index a = 0; a < n; ++a)
        for (Eigen::Index b = 0; b < n; ++b) d_(a, b) = std::min(d_(a, b), d_(a, m) + d_(m, b));
  }

  IntrinsicTriangulation T_;
  EdgeSides sides_;
  Eigen::MatrixXd d_;
  int from_ = 0;
  double limit_ = 0;
};

}  // namespace littoral::test
