// Winding numbers on surfaces: exact integers, nonbounding loops, invariances, references.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <fstream>
#include <numeric>
#include <random>

#include "io/read.h"
#include "littoral/error.h"
#include "one_call.h"
#include "operators/jump_calculus.h"
#include "shared_data.h"
#include "test_meshes.h"
#include "torus_loops.h"

namespace littoral {
namespace {

using test::nu, test::nv, test::meridian, test::longitude, test::disk;

Curve curve_of(std::vector<int> vertices) {
  Curve curve;
  for (int v : vertices) curve.nodes.push_back(SurfacePoint::at_vertex(v));
  return curve;
}

bool in_quads(int face, int i0, int i1, int j0, int j1) {
  const int i = face / 2 / nv, j = face / 2 % nv;
  return i >= i0 && i < i1 && j >= j0 && j < j1;
}

TEST(WindingSolver, AClosedCurveOnASphereGivesExactIntegers) {
  const SurfaceMesh mesh(test::octasphere_soup(3));
  // The boundary of the northern cap z > 0.5, faces on its left.
  Sources sources;
  std::vector<char> inside(mesh.n_faces());
  for (int f = 0; f < mesh.n_faces(); ++f) {
    double z = 0;
    for (int v : mesh.face(f)) z += mesh.point(v).z() / 3;
    inside[f] = z > 0.5;
  }
  for (int f = 0; f < mesh.n_faces(); ++f)
    for (int k = 0; inside[f] && k < 3; ++k)
      for (int g : mesh.edge_faces(mesh.side_edge(f, k)))
        if (!inside[g])
          sources.curves.push_back(curve_of({mesh.face(f)[k], mesh.face(f)[(k + 1) % 3]}));
  const WindingAnswer answer = test::surface_winding(mesh, sources);
  for (int f = 0; f < mesh.n_faces(); ++f) {
    ASSERT_EQ(answer.region[f], inside[f]);
    for (int k = 0; k < 3; ++k) ASSERT_NEAR(answer.numbers.w.u(f, k), inside[f], 1e-10);
  }
  EXPECT_TRUE(answer.nonbounding.empty());
  EXPECT_EQ(answer.numbers.completed, answer.numbers.curve);
  // The other way round it is -1 inside; twice along, 2.
  const WindingAnswer reversed = test::surface_winding(mesh, sources.reversed());
  EXPECT_EQ(reversed.region, -answer.region);
  Sources twice = sources;
  twice.curves.insert(twice.curves.end(), sources.curves.begin(), sources.curves.end());
  EXPECT_EQ(test::surface_winding(mesh, twice).region, 2 * answer.region);
}

TEST(WindingSolver, ALoopThatBoundsNothingIsFound) {
  const SurfaceMesh mesh(test::torus_soup(nu, nv));
  Sources sources;
  sources.curves = {curve_of(meridian(3)), curve_of(disk(8, 12, 2, 6))};
  const WindingAnswer answer = test::surface_winding(mesh, sources);
  for (int f = 0; f < mesh.n_faces(); ++f) {
    ASSERT_EQ(answer.region[f], in_quads(f, 8, 12, 2, 6)) << "face " << f;
    for (int k = 0; k < 3; ++k) ASSERT_NEAR(answer.numbers.w.u(f, k), answer.region[f], 1e-8);
  }
  ASSERT_EQ(answer.nonbounding.size(), 1u);
  EXPECT_EQ(answer.nonbounding[0].rows(), nv + 1);
  EXPECT_LT(std::abs(answer.numbers.gap), 1e-6);
  // Rounding without decomposition puts regions elsewhere.
  const WindingAnswer naive =
      test::surface_winding(mesh, sources, SurfaceWinding{.keep_nonbounding = true});
  EXPECT_NE(naive.region, answer.region);
}

TEST(WindingSolver, TwoLoopsThatBoundTogetherAreKept) {
  const SurfaceMesh mesh(test::torus_soup(nu, nv));
  Sources sources;
  std::vector<int> back = meridian(9);
  std::reverse(back.begin(), back.end());
  sources.curves = {curve_of(meridian(3)), curve_of(back)};
  const WindingAnswer answer = test::surface_winding(mesh, sources);
  EXPECT_TRUE(answer.nonbounding.empty());
  // Between the loops or outside of them: the larger part is 0.
  const int sign = answer.region[2 * nv * 5];
  EXPECT_EQ(std::abs(sign), 1);
  for (int f = 0; f < mesh.n_faces(); ++f)
    ASSERT_EQ(answer.region[f], in_quads(f, 3, 9, 0, nv) ? sign : 0);
}

TEST(WindingSolver, AGapChangesNoLabel) {
  const SurfaceMesh mesh(test::torus_soup(nu, nv));
  std::vector<int> loop = disk(6, 14, 2, 10), tube = meridian(20), length = longitude(13);
  loop.erase(loop.end() - 3, loop.end());
  loop.erase(loop.begin(), loop.begin() + 1);
  tube.erase(tube.end() - 3, tube.end());
  Sources sources;
  sources.curves = {curve_of(loop), curve_of(tube)};
  const WindingAnswer answer = test::surface_winding(mesh, sources);
  double wrong = 0;
  for (int f = 0; f < mesh.n_faces(); ++f)
    wrong += answer.region[f] != static_cast<int>(in_quads(f, 6, 14, 2, 10));
  EXPECT_LT(wrong / mesh.n_faces(), 0.02);
  // The broken loop round the tube bounds nothing, and most of the curve knows.
  ASSERT_EQ(answer.nonbounding.size(), 1u);
  const WindingAnswer cut =
      test::surface_winding(mesh, sources, SurfaceWinding{.labels = Labels::cut});
  wrong = 0;
  for (int f = 0; f < mesh.n_faces(); ++f)
    wrong += cut.region[f] != static_cast<int>(in_quads(f, 6, 14, 2, 10));
  EXPECT_LT(wrong / mesh.n_faces(), 0.02);
}

TEST(WindingSolver, DependsNeitherOnNumberingNorScaleNorPlace) {
  const PolygonSoup soup = test::torus_soup(nu, nv);
  std::vector<int> loop = disk(6, 14, 2, 10), tube = meridian(20);
  loop.pop_back();
  Sources sources;
  sources.curves = {curve_of(loop), curve_of(tube)};
  const WindingAnswer before = test::surface_winding(SurfaceMesh(soup), sources);
  std::mt19937 random(5);
  std::vector<int> vertex(soup.n_vertices()), face(soup.n_faces());
  std::iota(vertex.begin(), vertex.end(), 0);
  std::iota(face.begin(), face.end(), 0);
  std::shuffle(vertex.begin(), vertex.end(), random);
  std::shuffle(face.begin(), face.end(), random);
  PolygonSoup other;
  other.points.resize(soup.n_vertices(), 3);
  for (int v = 0; v < soup.n_vertices(); ++v)
    other.points.row(vertex[v]) = 1e3 * soup.points.row(v).array() + 1e5;
  for (int f : face) {
    const auto corners = soup.face(f);
    test::add_triangle(other, vertex[corners[1]], vertex[corners[2]], vertex[corners[0]]);
  }
  for (Curve& curve : sources.curves)
    for (SurfacePoint& node : curve.nodes) node.element = vertex[node.element];
  const WindingAnswer after = test::surface_winding(SurfaceMesh(other), sources);
  for (int f = 0; f < soup.n_faces(); ++f) EXPECT_EQ(after.region[f], before.region[face[f]]);
}

TEST(WindingSolver, CurvesMayEndAtTheFirstVertexAndTheLast) {
  // Nodes where a curve ends are no unknowns; which they are does not matter.
  const PolygonSoup soup = test::octasphere_soup(2);
  const int n = soup.n_vertices();
  PolygonSoup other;
  other.points = soup.points.colwise().reverse();
  for (int f = 0; f < soup.n_faces(); ++f) {
    const auto c = soup.face(f);
    test::add_triangle(other, n - 1 - c[0], n - 1 - c[1], n - 1 - c[2]);
  }
  const SurfaceMesh mesh(soup), turned(other);
  // Along edges from vertex 0, an octant's corner, to the next corner but one edge.
  std::vector<int> line{0};
  while (line.size() < 4)
    for (int e = 0; e < mesh.n_edges(); ++e) {
      const auto ends = mesh.edges().row(e);
      const int to = ends[0] == line.back() ? ends[1] : ends[1] == line.back() ? ends[0] : -1;
      if (to < 0 || mesh.point(to).z() != 0 || mesh.point(to).y() <= mesh.point(line.back()).y())
        continue;
      line.push_back(to);
      break;
    }
  std::vector<int> reversed = line;
  for (int& v : reversed) v = n - 1 - v;
  Sources a, b;
  a.curves = {curve_of(line)};
  b.curves = {curve_of(reversed)};
  const WindingAnswer first = test::surface_winding(mesh, a),
                      last = test::surface_winding(turned, b);
  const MatX3 difference = first.numbers.w.u - last.numbers.w.u;
  EXPECT_LT((difference.array() - difference(0, 0)).abs().maxCoeff(), 1e-9);
}

/// Every face cut into four at the middles of its sides; its faces 4 f to 4 f + 3.
SurfaceMesh quartered(const SurfaceMesh& mesh) {
  PolygonSoup soup;
  const int n = mesh.n_vertices();
  soup.points.resize(n + mesh.n_edges(), 3);
  soup.points.topRows(n) = mesh.points();
  for (int e = 0; e < mesh.n_edges(); ++e)
    soup.points.row(n + e) =
        0.5 * (mesh.point(mesh.edges()(e, 0)) + mesh.point(mesh.edges()(e, 1)));
  for (int f = 0; f < mesh.n_faces(); ++f) {
    const auto v = mesh.face(f);
    const int m[3] = {n + mesh.side_edge(f, 0), n + mesh.side_edge(f, 1), n + mesh.side_edge(f, 2)};
    for (int k = 0; k < 3; ++k) test::add_triangle(soup, v[k], m[k], m[(k + 2) % 3]);
    test::add_triangle(soup, m[0], m[1], m[2]);
  }
  return SurfaceMesh(soup);
}

TEST(WindingSolver, RefinementChangesNoRegion) {
  const SurfaceMesh mesh(test::torus_soup(nu, nv)), fine = quartered(mesh);
  std::vector<int> loop = disk(6, 14, 2, 10), tube = meridian(20);
  for (const bool broken : {false, true}) {
    if (broken) loop.resize(loop.size() - 3), tube.resize(tube.size() - 2);
    Sources coarse_sources, fine_sources;
    coarse_sources.curves = fine_sources.curves = {curve_of(loop), curve_of(tube)};
    const VecXi coarse = test::surface_winding(mesh, coarse_sources).region;
    const VecXi refined = test::surface_winding(fine, fine_sources).region;
    int differ = 0;
    for (int f = 0; f < fine.n_faces(); ++f) differ += refined[f] != coarse[f / 4];
    EXPECT_LE(differ, broken ? 0.01 * fine.n_faces() : 0);
  }
}

TEST(WindingSolver, CurvesThroughFacesCutTheMeshAndMapBack) {
  const SurfaceMesh mesh(test::jittered_grid_soup(20, 20, 0.3));
  Sources sources;
  MatX3 ring(41, 3);
  for (int i = 0; i <= 40; ++i) {
    const double a = 2 * std::acos(-1.0) * (i % 40) / 40;
    ring.row(i) << 0.5 + 0.3 * std::cos(a), 0.5 + 0.3 * std::sin(a), 0;
  }
  sources.space_curves.push_back({ring, true, "ring"});
  const WindingAnswer answer = test::surface_winding(mesh, sources);
  const SurfaceMesh& cut = answer.cut.mesh;
  EXPECT_GT(cut.n_faces(), mesh.n_faces());
  double area = 0, inside = 0;
  for (int f = 0; f < cut.n_faces(); ++f) {
    const Vec3 a = cut.point(cut.face(f)[0]), b = cut.point(cut.face(f)[1]);
    const Vec3 c = cut.point(cut.face(f)[2]);
    const double part = 0.5 * (b - a).cross(c - a).z();
    EXPECT_GT(part, 0);  // nothing turned over
    area += part;
    const Vec3 middle = (a + b + c) / 3 - Vec3(0.5, 0.5, 0);
    const int label = answer.numbers.region[answer.triangle_of_face[f]];
    inside += label * part;
    if (std::abs(middle.norm() - 0.3) > 0.01) {
      EXPECT_EQ(label, middle.norm() < 0.3);
    }
  }
  EXPECT_NEAR(area, 1, 1e-12);
  EXPECT_NEAR(inside, 20 * 0.09 * std::sin(2 * std::acos(-1.0) / 40), 1e-3);
  EXPECT_EQ(answer.region.size(), mesh.n_faces());
}

TEST(WindingSolver, CrossingSegmentsGetACommonVertex) {
  PolygonSoup soup;
  soup.points.resize(3, 3);
  soup.points << 0, 0, 0, 1, 0, 0, 0, 1, 0;
  test::add_triangle(soup, 0, 1, 2);
  const SurfaceMesh mesh(soup);
  const CutMesh cut = cut_mesh(mesh, {{0, {0.75, 0.25, 0}, {0.25, 0.25, 0.5}},
                                      {0, {0.75, 0, 0.25}, {0.25, 0.5, 0.25}},
                                      {0, {0.6, 0.2, 0.2}, {0.2, 0.4, 0.4}}});
  EXPECT_EQ(cut.path[0].size(), 3u + 0u);
  int common = -1;
  for (int v : cut.path[0])
    if (std::find(cut.path[1].begin(), cut.path[1].end(), v) != cut.path[1].end()) common = v;
  ASSERT_GE(common, 0);
  EXPECT_LT((cut.mesh.point(common) - Vec3(0.25, 0.25, 0)).norm(), 1e-9);
  double area = 0;
  for (int f = 0; f < cut.mesh.n_faces(); ++f) {
    const auto c = cut.mesh.face(f);
    const Vec3 a = cut.mesh.point(c[0]);
    area += 0.5 * (cut.mesh.point(c[1]) - a).cross(cut.mesh.point(c[2]) - a).z();
  }
  EXPECT_NEAR(area, 0.5, 1e-12);
  for (const auto& path : cut.path)
    for (std::size_t i = 0; i + 1 < path.size(); ++i)
      EXPECT_GE(cut.mesh.find_edge(path[i], path[i + 1]), 0);
}

TEST(WindingSolver, OneEdgeOfThreeFacesDoesNotRefuseTheMesh) {
  const PolygonSoup plain = test::octasphere_soup(2);
  PolygonSoup fin = plain;
  int far = 0;  // from the equator
  while (plain.points(plain.face(far)[0], 2) < 0.3 || plain.points(plain.face(far)[1], 2) < 0.3)
    ++far;
  const int a = plain.face(far)[0], b = plain.face(far)[1], top = fin.n_vertices();
  fin.points.conservativeResize(top + 1, 3);
  fin.points.row(top) = 1.5 * (plain.points.row(a) + plain.points.row(b));
  test::add_triangle(fin, a, b, top);
  Sources equator;
  std::vector<int> line;
  for (int v = 0; v < plain.n_vertices(); ++v)
    if (std::abs(plain.points(v, 2)) < 1e-9) line.push_back(v);
  std::sort(line.begin(), line.end(), [&](int v, int w) {
    return std::atan2(plain.points(v, 1), plain.points(v, 0)) <
           std::atan2(plain.points(w, 1), plain.points(w, 0));
  });
  line.push_back(line.front());
  equator.curves = {Curve::along_vertices(line)};
  const SurfaceMesh mesh(plain), with_fin(fin);
  for (const Formulation formulation : {Formulation::primal, Formulation::nonconforming}) {
    SurfaceWinding options;
    options.formulation = formulation;
    Report report;
    const WindingAnswer answer =
        solve_once<WindingDomain>(options, {domain_of(with_fin).mesh}, equator, {}, report);
    const VecXi expected =
        solve_once<WindingDomain>(options, {domain_of(mesh).mesh}, equator, {}, report).region;
    EXPECT_EQ(answer.region.head(mesh.n_faces()), expected);
    EXPECT_TRUE(
        std::any_of(report.warnings.begin(), report.warnings.end(), [](const auto& warning) {
          return warning.text.find("more than two faces") != std::string::npos;
        }));
  }
  SignedHeat options;
  options.bounding_only = true;
  Report report;
  const VecX phi =
      solve_once<SurfaceDomain>(options, domain_of(with_fin), equator, {}, report).values;
  for (int v = 0; v < mesh.n_vertices(); ++v) {
    if (std::abs(plain.points(v, 2)) < 0.2) continue;
    EXPECT_EQ(phi[v] > 0, plain.points(v, 2) > 0) << v;
  }
}

TEST(WindingSolver, RefusesWhatHasNoSides) {
  const SurfaceMesh mesh(test::octasphere_soup(2));
  Sources sources;
  sources.points.push_back(SurfacePoint::at_vertex(3));
  EXPECT_THROW(test::surface_winding(mesh, sources), InputError);
  PolygonSoup book = test::grid_soup(1, 1);
  book.points.conservativeResize(5, 3);
  book.points.row(4) << 0.5, 0.5, 1;
  test::add_triangle(book, 0, 3, 4);  // three faces at the diagonal
  Sources line;
  line.curves = {curve_of({0, 3})};  // along the edge of three faces
  EXPECT_THROW(test::surface_winding(SurfaceMesh(book), line), UnsupportedError);
}

double wrong_share(const std::string& mesh_name, const std::string& curve,
                   const std::string& truth) {
  const auto folder = test::shared() / "data/generated/curves";
  const SurfaceMesh mesh(io::read_surface(folder / (mesh_name + ".obj")));
  Report report;
  const Sources sources = io::read_sources(folder / curve, mesh, {}, report);
  const WindingAnswer answer = test::surface_winding(mesh, sources);
  std::ifstream in(folder / truth);
  double wrong = 0, total = 0;
  // Up to one integer, as which part is outside is a convention.
  std::vector<int> label(mesh.n_faces());
  for (int& l : label) in >> l;
  double best = 1;
  for (int shift = -2; shift <= 2; ++shift) {
    wrong = total = 0;
    for (int f = 0; f < mesh.n_faces(); ++f) {
      const Vec3 a = mesh.point(mesh.face(f)[0]);
      const double area =
          (mesh.point(mesh.face(f)[1]) - a).cross(mesh.point(mesh.face(f)[2]) - a).norm();
      total += area;
      if (answer.region[f] + shift != label[f]) wrong += area;
    }
    best = std::min(best, wrong / total);
  }
  return best;
}

TEST(SurfaceWindingData, LabelsOfClosedCurvesAreExact) {
  LITTORAL_NEEDS_SHARED("data/generated/curves");
  EXPECT_EQ(wrong_share("sphere_cap", "sphere_cap.txt", "sphere_cap.labels.txt"), 0);
  EXPECT_EQ(wrong_share("sphere_cap", "sphere_two_caps.swn.txt", "sphere_two_caps.labels.txt"), 0);
  EXPECT_EQ(wrong_share("torus_disc", "torus_band.txt", "torus_band.labels.txt"), 0);
  EXPECT_EQ(wrong_share("torus_disc", "torus_disc.swn.txt", "torus_disc.labels.txt"), 0);
  EXPECT_EQ(wrong_share("base_half", "base_half.swn.txt", "base_half.labels.txt"), 0);
}

TEST(SurfaceWindingData, ALoopThatBoundsNothingBesideADisk) {
  LITTORAL_NEEDS_SHARED("data/generated/curves");
  const auto folder = test::shared() / "data/generated/curves";
  const SurfaceMesh mesh(io::read_surface(folder / "torus_disc.obj"));
  Report report;
  const auto curves = io::read_sources(folder / "torus_meridian_and_disc.txt", mesh, {}, report);
  Sources disk, meridian;
  meridian.curves = {curves.curves[0]};
  disk.curves = {curves.curves[1]};
  const WindingAnswer both = test::surface_winding(mesh, curves),
                      alone = test::surface_winding(mesh, disk);
  EXPECT_EQ(both.region, alone.region);
  EXPECT_EQ((both.region.array() == 1).count(), 60);
  EXPECT_EQ(test::surface_winding(mesh, meridian).region, VecXi::Zero(mesh.n_faces()));
}

TEST(SurfaceWindingData, LabelsOfBrokenCurvesAreNearlySo) {
  LITTORAL_NEEDS_SHARED("data/generated/curves");
  for (const std::string name : {"sphere_cap", "sphere_two_caps"})
    EXPECT_LT(wrong_share("sphere_cap", name + ".broken20.swn.txt", name + ".labels.txt"), 0.03);
  for (const std::string name : {"torus_disc", "torus_band"})
    EXPECT_LT(wrong_share("torus_disc", name + ".broken20.swn.txt", name + ".labels.txt"), 0.03);
}

}  // namespace
}  // namespace littoral
