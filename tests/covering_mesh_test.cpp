// Intrinsic Delaunay on what is not a manifold: fixed edges, the tufted cover, polygons, and every
// small file at hand.

#include "domain/mesh/covering_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "heat_helpers.h"
#include "io/read.h"
#include "littoral/error.h"
#include "one_call.h"
#include "shared_data.h"
#include "sources/surface/retriangulate_sources.h"
#include "spatial/triangulate.h"
#include "test_meshes.h"

namespace littoral {
namespace {

/// Three pages of long thin triangles that meet along the x axis; the first page is y > 0.
PolygonSoup book(int n) {
  PolygonSoup soup;
  const PolygonSoup page = test::grid_soup(n, n);
  const int m = page.n_vertices();
  soup.points.resize(0, 3);
  std::vector<int> spine;
  for (int k = 0; k < 3; ++k) {
    const double turn = 2 * std::acos(-1.0) / 3 * k;
    std::vector<int> number(static_cast<std::size_t>(m));
    for (int v = 0; v < m; ++v) {
      const double x = 8 * page.points(v, 0) + 3 * page.points(v, 1), y = page.points(v, 1);
      const bool on_spine = y == 0;
      if (on_spine && k > 0) {
        number[v] = spine[v];
        continue;
      }
      number[v] = static_cast<int>(soup.points.rows());
      soup.points.conservativeResize(soup.points.rows() + 1, 3);
      soup.points.bottomRows(1) << x, y * std::cos(turn), y * std::sin(turn);
    }
    if (k == 0) spine = number;
    for (int f = 0; f < page.n_faces(); ++f) {
      const auto c = page.face(f);
      test::add_triangle(soup, number[c[0]], number[c[1]], number[c[2]]);
    }
  }
  return soup;
}

double covering_size(const Report& report, const std::string& name) {
  for (const auto& [key, value] : report.sizes)
    if (key == name) return value;
  return -1;
}

VecX distance(const SurfaceMesh& mesh, const Sources& sources, const std::string& method,
              bool intrinsic, Report& report) {
  OptionValues options;
  if (intrinsic) options.emplace_back("intrinsic-delaunay", "on");
  return test::surface_distance(mesh, sources, AnyMethod::named(method, options), report);
}

TEST(CoveringMesh, HasTwoFacesAtEveryEdgeAndTheSameLaplacianTwice) {
  Report report;
  const SurfaceMesh mesh(book(6));
  const IntrinsicTriangulation T = intrinsic_triangulation(mesh, report);
  const CoveringMesh cover = covering_mesh(mesh, T);
  for (int e = 0; e < cover.mesh.n_edges(); ++e) {
    ASSERT_EQ(cover.mesh.edge_faces(e).size(), 2U);
    int along = 0;
    for (int f : cover.mesh.edge_faces(e))
      for (int k = 0; k < 3; ++k)
        if (cover.T.side_edge(f, k) == e) along += cover.T.along(f, k);
    EXPECT_EQ(along, 0) << "the faces of an edge run along it in opposite directions";
  }
  const Operators once = triangle_operators(T), twice = triangle_operators(cover.T);
  EXPECT_LE((twice.scalar.L - 2 * once.scalar.L).norm(), 1e-12 * once.scalar.L.norm());
  EXPECT_LE((twice.scalar.M - 2 * once.scalar.M).norm(), 1e-12 * once.scalar.M.norm());
}

TEST(CoveringMesh, CarriesPointsToAllSheets) {
  Report report;
  const SurfaceMesh mesh(book(4));
  const IntrinsicTriangulation T = intrinsic_triangulation(mesh, report);
  const CoveringMesh cover = covering_mesh(mesh, T);
  int of_three = -1;
  for (int e = 0; e < mesh.n_edges(); ++e)
    if (mesh.edge_faces(e).size() == 3) of_three = e;
  ASSERT_GE(of_three, 0);
  const std::vector<SurfacePoint> points = {SurfacePoint::at_vertex(7),
                                            SurfacePoint::in_face(5, 0.2, 0.3, 0.5),
                                            SurfacePoint::on_edge(of_three, 0.25)};
  const std::size_t sheets[] = {1, 2, 3};
  for (int i = 0; i < 3; ++i) {
    PlacedSources sources;
    sources.points = {points[i]};
    const auto on = covering_sources(mesh, T, cover, sources).points;
    EXPECT_EQ(on.size(), sheets[i]);
    for (const SurfacePoint& p : on)
      EXPECT_LE((cover.mesh.position(p) - mesh.position(points[i])).norm(), 1e-14);
  }
}

TEST(CoveringMesh, CarriesPointsOnAnyEdgeAndCurvesAlongThem) {
  Report report;
  PolygonSoup soup = book(3);
  for (int f = 0; f < soup.n_faces(); f += 2)  // corners begin anywhere, some faces are turned
    std::rotate(soup.corners.begin() + 3 * f, soup.corners.begin() + 3 * f + 1 + f % 3 / 2,
                soup.corners.begin() + 3 * f + 3);
  for (int f = 0; f < soup.n_faces(); f += 5)
    std::swap(soup.corners[3 * static_cast<std::size_t>(f)],
              soup.corners[3 * static_cast<std::size_t>(f) + 1]);
  const SurfaceMesh mesh(soup);
  const IntrinsicTriangulation T = intrinsic_triangulation(mesh, report);
  const CoveringMesh cover = covering_mesh(mesh, T);
  for (int e = 0; e < mesh.n_edges(); ++e) {
    PlacedSources sources;
    sources.add_point(SurfacePoint::on_edge(e, 0.2), 0.5);
    for (int f : mesh.edge_faces(e)) {
      CurvePiece piece;
      piece.face = f;
      piece.edge = e;
      sources.pieces.push_back(piece);
    }
    const PlacedSources on = covering_sources(mesh, T, cover, sources);
    std::set<int> edges;
    for (std::size_t i = 0; i < on.points.size(); ++i) {
      EXPECT_EQ(on.points[i].on, SurfacePoint::On::edge);
      EXPECT_EQ(on.point_value(i), 0.5);
      EXPECT_LE((cover.mesh.position(on.points[i]) - mesh.position(sources.points[0])).norm(),
                1e-14);
      edges.insert(on.points[i].element);
    }
    // As many sheets as faces, but both sides of a boundary are one.
    EXPECT_EQ(edges.size(), mesh.edge_faces(e).size()) << e;
    ASSERT_EQ(on.pieces.size(), mesh.edge_faces(e).size());
    for (const CurvePiece& piece : on.pieces) {
      EXPECT_EQ(edges.count(piece.edge), 1u);
      const auto faces = cover.mesh.edge_faces(piece.edge);
      EXPECT_EQ(std::count(faces.begin(), faces.end(), piece.face), 1);
    }
  }
}

TEST(CoveringMesh, MakesDistanceInABookBetter) {
  const SurfaceMesh mesh(book(12));
  for (const SurfacePoint& source :
       {SurfacePoint::at_vertex(6), SurfacePoint::in_face(70, 0.2, 0.3, 0.5)}) {
    Sources sources;
    sources.points = {source};
    Report report;
    const VecX exact = distance(mesh, sources, "exact", false, report);
    double error[2];
    for (int intrinsic = 0; intrinsic < 2; ++intrinsic) {
      Report sizes;
      const VecX phi = distance(mesh, sources, "unsigned-heat", intrinsic, sizes);
      error[intrinsic] = (phi - exact).cwiseAbs().mean() / exact.maxCoeff();
      if (intrinsic) {
        EXPECT_LE(covering_size(sizes, "intrinsic_edges_not_delaunay"), 5);  // at folded corners
      }
    }
    EXPECT_LT(error[1], 0.5 * error[0]);
    EXPECT_LT(error[1], 0.03);
  }
}

TEST(CoveringMesh, IsNotForVectors) {
  // A straight line across a square meets the boundary at an angle; at the back of the cover the
  // field would come towards it.
  const SurfaceMesh mesh(test::jittered_grid_soup(16, 16, 0.2));
  MatX3 line(2, 3);
  line << 0.05, 0.2, 0, 0.95, 0.7, 0;
  Report report;
  const IntrinsicTriangulation T = intrinsic_triangulation(mesh, report);
  const PlacedSources sources = place_sources(mesh, test::space_curve(line), report);
  const CoveringMesh cover = covering_mesh(mesh, T);
  const auto error = [&](const SurfaceMesh& on, const IntrinsicTriangulation& triangles,
                         const PlacedSources& placed) {
    const auto ops = std::make_shared<const Operators>(triangle_operators(triangles));
    const SourceSystem terms = source_system(on, triangles, placed);
    const VecX phi = SignedHeatSolver(ops, 1).solve(terms, {}, {}, report);
    const Vec3 d = (line.row(1) - line.row(0)).normalized();
    double sum = 0;
    for (int v = 0; v < mesh.n_vertices(); ++v) {
      const Vec3 x = mesh.point(v) - Vec3(line.row(0));
      sum += std::abs(phi[v] - (d.x() * x.y() - d.y() * x.x())) / mesh.n_vertices();
    }
    return sum;
  };
  EXPECT_GT(error(cover.mesh, cover.T, covering_sources(mesh, T, cover, sources)),
            3 * error(mesh, T, sources));
}

TEST(FixedEdges, AreSplitUntilTheyAreDelaunay) {
  for (const PolygonSoup& soup : {book(12), test::jittered_grid_soup(40, 3, 0.2)}) {
    const SurfaceMesh mesh(soup);
    Sources curve;
    curve.curves.emplace_back();
    for (int v : {2, 3, 4}) curve.curves[0].nodes.push_back(SurfacePoint::at_vertex(v));
    Report report;
    distance(mesh, curve, "signed-heat", true, report);
    EXPECT_LE(covering_size(report, "intrinsic_edges_not_delaunay"), 5);  // at sharp corners
    EXPECT_GT(covering_size(report, "intrinsic_vertices_added"), 0);
  }
}

TEST(Retriangulated, PointsInAnyFaceAreKeptWhereTheyAre) {
  const SurfaceMesh mesh(test::jittered_grid_soup(5, 4, 0.2));
  Report report;
  const IntrinsicTriangulation T = intrinsic_triangulation(mesh, report);
  for (const int f : {0, 1, mesh.n_faces() - 1}) {
    PlacedSources sources;
    sources.add_point(SurfacePoint::in_face(f, 0.2, 0.5, 0.3), 0.25);
    const Retriangulated fine = retriangulated(mesh, T, sources, {}, report, {});
    ASSERT_EQ(fine.sources.points.size(), 1u) << f;
    EXPECT_EQ(fine.sources.point_value(0), 0.25);
    EXPECT_LT(
        (fine.mesh.position(fine.sources.points[0]) - mesh.position(sources.points[0])).norm(),
        1e-9);
  }
}

TEST(PolygonOptions, RunOnTriangles) {
  PolygonSoup quads;
  quads.points = test::grid_soup(12, 12).points;
  for (int j = 0; j < 12; ++j)
    for (int i = 0; i < 12; ++i) {
      const int a = i + 13 * j;
      quads.add_face(std::array{a, a + 1, a + 14, a + 13});
    }
  const SurfaceMesh mesh(quads), cut(triangulate(quads));
  MatX3 circle = test::circle(0.5, 0.5, 0, 0.3, 40);
  for (const char* option : {"intrinsic-delaunay", "discontinuous", "bounding-only"}) {
    Report report, same;
    const AnyMethod method = AnyMethod::named("signed-heat", {{option, "on"}});
    const VecX phi = test::surface_distance(mesh, test::space_curve(circle), method, report);
    const VecX expected = test::surface_distance(cut, test::space_curve(circle), method, same);
    EXPECT_EQ(phi, expected) << option;
    EXPECT_EQ(std::ranges::count(report.warnings, "polygons-cut", &Warning::code), 1);
  }
  // Sources on the elements of the polygons find their places.
  Sources points;
  points.points = {SurfacePoint::on_edge(mesh.find_edge(20, 33), 0.25),
                   SurfacePoint::in_face(100, 0.3, 0.2, 0.5)};
  Report report;
  const VecX phi =
      test::surface_distance(mesh, points, UnsignedHeat{.intrinsic_delaunay = true}, report);
  for (int v = 0; v < mesh.n_vertices(); ++v) {
    double nearest = 10;
    for (const SurfacePoint& p : points.points)
      nearest = std::min(nearest, (mesh.point(v) - mesh.position(p)).norm());
    EXPECT_NEAR(phi[v], nearest, 0.05);
  }
}

/// Meshes of at most `most` faces in a folder of the shared data that can be read and computed on.
void expect_all_end(const std::string& folder, int most) {
  LITTORAL_NEEDS_SHARED(folder);
  const std::set<std::string> kinds = {".obj", ".off", ".ply", ".stl"};
  int done = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(test::shared() / folder)) {
    if (!kinds.count(entry.path().extension().string()) || entry.file_size() > 400000) continue;
    SCOPED_TRACE(entry.path().filename().string());
    try {
      const SurfaceMesh read(io::read_surface(entry.path().string()));
      if (read.n_faces() == 0 || read.n_faces() > most) continue;
      const SurfaceMesh mesh(triangulate(read.soup()));
      Sources source = test::vertex_points({mesh.face(0)[0]});
      Report report;
      const VecX phi = distance(mesh, source, "unsigned-heat", true, report);
      EXPECT_EQ(phi.size(), mesh.n_vertices());
      EXPECT_FALSE(phi.hasNaN());
      EXPECT_LE(covering_size(report, "intrinsic_vertices_added"), 3 * mesh.n_vertices() + 1001);
      ++done;
    } catch (const Error&) {
      // files that are no meshes, and meshes without extent
    }
  }
  EXPECT_GE(done, 8);
}

TEST(IntrinsicDelaunaySlow, EndsOnGeneratedMeshes) { expect_all_end("data/generated", 700); }
TEST(IntrinsicDelaunaySlow, EndsOnSurfaces) { expect_all_end("data/surfaces", 1500); }
TEST(IntrinsicDelaunaySlow, EndsOnSoups) { expect_all_end("data/soups", 1000); }
TEST(IntrinsicDelaunaySlow, EndsOnFormats) { expect_all_end("data/formats", 1000); }

}  // namespace
}  // namespace littoral
