// Vectors of sources on polygon meshes: at each node what the definition says, written out in
// space.
#include "sources/systems/nodal_source_system.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>
#include <set>
#include <vector>

#include "domain/mesh/polygon_surface.h"
#include "littoral/report.h"
#include "operators/nodal.h"
#include "test_meshes.h"

namespace littoral {
namespace {

/// Quads and a few triangles on the plane, from a grid whose points are moved at random.
PolygonSoup flat_polygons(int n, double amount) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> jitter(-amount, amount);
  PolygonSoup soup;
  soup.points.resize((n + 1) * (n + 1), 3);
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i)
      soup.points.row(i + (n + 1) * j) << i + jitter(random), j + jitter(random), 0;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = i + (n + 1) * j, b = a + 1, c = a + n + 2, d = a + n + 1;
      if ((i + 2 * j) % 5 == 0 && amount > 0) {
        soup.add_face(std::array{a, b, c});
        soup.add_face(std::array{a, c, d});
      } else {
        soup.add_face(std::array{a, b, c, d});
      }
    }
  return soup;
}

struct OnPolygons {
  explicit OnPolygons(const PolygonSoup& soup) : mesh(soup), S(polygon_surface(mesh, report)) {}

  Vec3 node(int i) const { return mesh.point(i) / S.place->unit; }
  Vec3 position(const SurfacePoint& p) const { return S.refined->position(p) / S.place->unit; }
  /// The corners of the polygon that a face of the refined mesh is part of.
  std::vector<int> corners_about(int face) const {
    const auto& offsets = S.face_offsets;
    const auto at = std::upper_bound(offsets.begin(), offsets.end(), face) - offsets.begin() - 1;
    const auto corners = mesh.face(static_cast<int>(at));
    return {corners.begin(), corners.end()};
  }
  MatX3 in_space(const std::vector<DofVector>& vectors) const {
    MatX3 out = MatX3::Zero(mesh.n_vertices(), 3);
    for (const auto& [i, z] : vectors) {
      const TangentFrame frame(S.normals.row(i));
      out.row(i) += z.real() * frame.x + z.imag() * frame.y;
    }
    return out;
  }

  Report report;
  SurfaceMesh mesh;
  NodalSurface S;
};

double turn(const Vec3& a, const Vec3& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

TEST(NodalSources, PointsGiveDirectionsAwayByTheAnglesOfTheirFaces) {
  const OnPolygons on(flat_polygons(5, 0.25));
  const SurfaceMesh& fine = *on.S.refined;
  std::vector<SurfacePoint> points{SurfacePoint::at_vertex(14),
                                   SurfacePoint::at_vertex(0),
                                   SurfacePoint::at_vertex(3),
                                   SurfacePoint::at_vertex(37),
                                   SurfacePoint::in_face(8, 0.2, 0.5, 0.3),
                                   SurfacePoint::in_face(20, 0.6, 0.1, 0.3)};
  for (int e = 3; e < fine.n_edges(); e += 17) points.push_back(SurfacePoint::on_edge(e, 0.3));
  for (const SurfacePoint& p : points) {
    PlacedSources sources;
    sources.add_point(p, 0);
    const SourceSystem system = nodal_source_system(on.S, sources);
    EXPECT_TRUE(system.X0.empty());
    const Vec3 x = on.position(p);
    MatX3 expected = MatX3::Zero(on.mesh.n_vertices(), 3);
    double all = 0;
    for (int f = 0; f < fine.n_faces(); ++f) {
      std::array<Vec3, 3> to;
      double area = 0, parts = 0, angle = 0;
      for (std::size_t k = 0; k < 3; ++k)
        to[k] = fine.point(fine.face(f)[k]) / on.S.place->unit - x;
      area = (to[1] - to[0]).cross(to[2] - to[0]).norm();
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 &u = to[k], &w = to[(k + 1) % 3];
        const double part = u.cross(w).norm();
        parts += part;
        if (part > 1e-12 * area || (u.norm() > 1e-9 && w.norm() > 1e-9 && u.dot(w) < 0))
          angle += turn(u, w);
      }
      if (parts > (1 + 1e-9) * area) continue;  // the point lies outside
      all += angle;
      const std::vector<int> corners = on.corners_about(f);
      for (const int i : corners)
        if (const Vec3 d = on.node(i) - x; d.norm() > 1e-9)
          expected.row(i) += angle / static_cast<double>(corners.size()) * d.normalized();
    }
    expected *= on.S.spacing / all;
    EXPECT_LT((on.in_space(system.X0_points) - expected).cwiseAbs().maxCoeff(), 1e-9 * on.S.spacing)
        << static_cast<int>(p.on) << " " << p.element;
  }
}

/// A curve of straight pieces through faces of the refined mesh.
PlacedSources curve_on(const SurfaceMesh& fine, const MatX3& line, bool is_signed) {
  Sources sources;
  sources.space_curves.emplace_back();
  sources.space_curves[0].points = line;
  sources.space_curves[0].is_signed = is_signed;
  Report report;
  return place_sources(fine, sources, report);
}

TEST(NodalSources, SignedCurvesGiveTheirNormalsByTheValuesOfNodesAtTheirMiddles) {
  const OnPolygons on(flat_polygons(6, 0.25));
  MatX3 line(4, 3);
  line << 0.6, 1.1, 0, 2.4, 2.2, 0, 3.1, 4.7, 0, 5.2, 5.1, 0;
  PlacedSources sources = curve_on(*on.S.refined, line, true);
  const MatX P = on.S.P;
  for (const bool left : {true, false}) {
    MatX3 expected = MatX3::Zero(on.mesh.n_vertices(), 3);
    Vec3 whole = Vec3::Zero();
    for (CurvePiece& piece : sources.pieces) {
      piece.left = left;
      const auto corners = on.S.refined->face(piece.face);
      Vec3 along = Vec3::Zero();
      VecX values = VecX::Zero(P.cols());
      for (std::size_t k = 0; k < 3; ++k) {
        along += (piece.b[k] - piece.a[k]) * on.S.refined->point(corners[k]) / on.S.place->unit;
        values += (piece.a[k] + piece.b[k]) / 2 * P.row(corners[k]).transpose();
      }
      const Vec3 normal = (left ? 1 : -1) * Vec3::UnitZ().cross(along);
      whole += normal;
      expected += values * normal.transpose();
    }
    const double up = on.S.normals(0, 2);  // of the surface, up or down
    const SourceSystem system = nodal_source_system(on.S, sources);
    const MatX3 found = on.in_space(system.X0);
    EXPECT_LT((found - up * expected).cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_LT((found.colwise().sum().transpose() - up * whole).norm(), 1e-9);
    EXPECT_TRUE(system.X0_points.empty());
  }
}

TEST(NodalSources, UnsignedCurvesPushTheNodesBesideThemAway) {
  // Along the middle of a row of squares: both sides are alike, and as strong as each other.
  const int n = 9;
  const OnPolygons on(flat_polygons(n, 0));
  MatX3 line(2, 3);
  line << 2.25, 4.5, 0, 6.75, 4.5, 0;
  const PlacedSources sources = curve_on(*on.S.refined, line, false);
  const SourceSystem system = nodal_source_system(on.S, sources);
  const MatX3 found = on.in_space(system.X0);
  const double unit = on.S.place->unit;
  // Pieces give each node of the polygons around twice its distance over the longest side, one at
  // most, less what lies beyond 3/4 of that; ends besides give directions away from them.
  MatX3 expected = MatX3::Zero(on.mesh.n_vertices(), 3);
  const SurfaceMesh& fine = *on.S.refined;
  for (const CurvePiece& piece : sources.pieces) {
    const auto at = [&](const std::array<double, 3>& b) {
      Vec3 x = Vec3::Zero();
      for (std::size_t k = 0; k < 3; ++k) x += b[k] * fine.point(fine.face(piece.face)[k]) / unit;
      return x;
    };
    const Vec3 a = at(piece.a), b = at(piece.b);
    double size = 0;
    std::set<int> around;
    for (std::size_t k = 0; k < 3; ++k) {
      const int v = fine.face(piece.face)[k], w = fine.face(piece.face)[(k + 1) % 3];
      size = std::max(size, (fine.point(v) - fine.point(w)).norm() / unit);
      for (const int f : fine.vertex_faces(v))
        for (const int i : on.corners_about(f)) around.insert(i);
    }
    for (const int i : around) {
      const double s = std::clamp((on.node(i) - a).dot(b - a) / (b - a).squaredNorm(), 0., 1.);
      const Vec3 away = on.node(i) - (a + s * (b - a));
      const double d = away.norm() / size;
      expected.row(i) +=
          (b - a).norm() * std::min(1., 2 * d) * std::clamp(1.75 - d, 0., 1.) * away.normalized();
    }
  }
  int compared = 0;
  for (int i = 0; i < on.mesh.n_vertices(); ++i) {
    const Vec3 x = on.mesh.point(i);
    if (x[0] < 3.5 || x[0] > 5.5) continue;  // beside the ends
    EXPECT_LT((found.row(i) - expected.row(i)).norm(), 1e-9 * on.S.spacing) << x.transpose();
    compared += expected.row(i).norm() > 0;
  }
  EXPECT_GE(compared, 4);
  const auto mirrored = [&](int i) { return (n - i % (n + 1)) + (n + 1) * (i / (n + 1)); };
  for (int i = 0; i < on.mesh.n_vertices(); ++i) {
    const Vec3 there(-found(mirrored(i), 0), found(mirrored(i), 1), found(mirrored(i), 2));
    EXPECT_LT((found.row(i).transpose() - there).norm(), 1e-9) << i;
    if (on.mesh.point(i)[1] < 4.5 - 2 || on.mesh.point(i)[1] > 4.5 + 2) {
      EXPECT_EQ(found.row(i).norm(), 0);
    }
  }
}

}  // namespace
}  // namespace littoral
