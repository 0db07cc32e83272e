// The public interface: what a program that includes littoral.h sees.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <thread>

#include "littoral/littoral.h"

using namespace littoral;
using testing::HasSubstr;
using testing::ThrowsMessage;

namespace {

/// A square of n x n cells over [0, 1]^2, two triangles each.
struct Square {
  int n;
  Eigen::MatrixXd V;
  Eigen::MatrixXi F;

  explicit Square(int cells) : n(cells), V((n + 1) * (n + 1), 3), F(2 * n * n, 3) {
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) V.row(vertex(i, j)) << double(i) / n, double(j) / n, 0;
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        F.row(2 * (j * n + i)) << vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1);
        F.row(2 * (j * n + i) + 1) << vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1);
      }
  }
  int vertex(int i, int j) const { return j * (n + 1) + i; }
  Mesh mesh() const { return {V, F}; }
  /// Up the line x = i / n: positive to the left.
  Sources line(int i) const {
    return Sources().add(Curve::along_vertices({vertex(i, 0), vertex(i, n)}));
  }
};

PolygonSoup cube() {
  PolygonSoup soup;
  soup.points.resize(8, 3);
  for (int v = 0; v < 8; ++v) soup.points.row(v) << v % 2, v / 2 % 2, v / 4;
  for (const auto& face : {std::array{0, 2, 3, 1}, std::array{4, 5, 7, 6}, std::array{0, 1, 5, 4},
                           std::array{2, 6, 7, 3}, std::array{0, 4, 6, 2}, std::array{1, 3, 7, 5}})
    soup.add_face(face);
  return soup;
}

}  // namespace

TEST(FrontMesh, TakesAnyStorageOrderAndIntegers) {
  const Square square(2);
  const Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor> rows = square.V.cast<float>();
  const Eigen::Matrix<std::int64_t, Eigen::Dynamic, Eigen::Dynamic> columns =
      square.F.cast<std::int64_t>();
  const Mesh a = square.mesh(), b(rows, columns);
  EXPECT_EQ(a.points(), b.points());
  EXPECT_EQ(a.soup().corners, b.soup().corners);
  EXPECT_EQ(a.kind(), "triangle mesh");
  Eigen::MatrixXi mixed(2, 4);
  mixed << 0, 1, 4, 3, 1, 2, 5, -1;  // a quad and a triangle
  const Mesh polygons(square.V, mixed);
  EXPECT_EQ(polygons.kind(), "polygon mesh");
  EXPECT_EQ(polygons.soup().face(1).size(), 3U);
}

TEST(FrontMesh, RefusesWhatIsNoMeshNamingTheElement) {
  const Square square(1);
  Eigen::MatrixXi F = square.F;
  F(1, 2) = 9;
  EXPECT_THAT([&] { Mesh(square.V, F); },
              ThrowsMessage<InputError>(
                  HasSubstr("face 1 refers to vertex 9; there are 4 vertices, counted from 0")));
  F(1, 2) = -2;
  EXPECT_THROW(Mesh(square.V, F), InputError);
  Eigen::MatrixXd V = square.V;
  V(3, 1) = std::nan("");
  EXPECT_THAT([&] { Mesh(V, square.F); }, ThrowsMessage<InputError>(HasSubstr("3")));
  EXPECT_THROW(Mesh(square.V.leftCols(2).eval(), square.F), InputError);
  EXPECT_THROW(Mesh(square.V, square.F.leftCols(2).eval()), InputError);
  PolygonSoup soup = cube();
  soup.corners[5] = 77;
  EXPECT_THAT([&] { Mesh m(soup); },
              ThrowsMessage<InputError>(HasSubstr("face 1 refers to vertex 77")));
  EXPECT_THROW(square.mesh().interpolate(VecX::Zero(3), SurfacePoint::at_vertex(0)), InputError);
  EXPECT_THROW(square.mesh().position(SurfacePoint::in_face(2, 1, 0, 0)), InputError);
}

TEST(FrontDistance, OfALineIsLinearAndSigned) {
  const Square square(8);
  const Mesh mesh = square.mesh();
  const Field d = distance(mesh, square.line(4), Exact{});
  const Field s = distance(mesh, square.line(4));
  for (int v = 0; v < mesh.n_vertices(); ++v) {
    EXPECT_NEAR(d.values[v], std::abs(square.V(v, 0) - 0.5), 1e-12);
    EXPECT_NEAR(s.values[v], 0.5 - square.V(v, 0), 1e-12);
  }
  EXPECT_NEAR(d.at(SurfacePoint::in_face(0, 0.5, 0.25, 0.25)),
              0.5 - mesh.position(SurfacePoint::in_face(0, 0.5, 0.25, 0.25))[0], 1e-12);
  EXPECT_EQ(s.report.method, "auto");
  EXPECT_EQ(s.confidence.size(), 0);
  EXPECT_EQ(distance(mesh, square.line(4), Automatic{.confidence = true}).confidence,
            VecX::Ones(mesh.n_vertices()));
  ASSERT_EQ(d.isolines(0.2).size(), 2U);
  for (const MatX3& line : d.isolines(0.2))
    for (Eigen::Index i = 0; i < line.rows(); ++i)
      EXPECT_NEAR(std::abs(line(i, 0) - 0.5), 0.2, 1e-12);
}

TEST(FrontDistance, TypedOptionsAndNamesAreTheSame) {
  const Square square(6);
  const Mesh mesh = square.mesh();
  const VecX typed =
      distance(mesh, square.line(3), SignedHeat{.time_scale = 4, .constraint = Constraint::none})
          .values;
  const VecX named =
      distance(mesh, square.line(3),
               AnyMethod::named("signed-heat", {{"time-scale", "4"}, {"constraint", "none"}}))
          .values;
  EXPECT_EQ(typed, named);
  EXPECT_THAT([&] { distance(mesh, square.line(3), SignedHeat{.time_scale = -1}); },
              ThrowsMessage<InputError>(HasSubstr("time-scale")));
  EXPECT_THAT([&] { distance(mesh, square.line(3), AnyMethod::named("signed-heet")); },
              ThrowsMessage<InputError>(HasSubstr("signed-heat")));
  EXPECT_THAT([&] { distance(Mesh(cube()), square.line(0), Exact{}); },
              ThrowsMessage<UnsupportedError>(HasSubstr("polygon mesh")));
}

TEST(FrontDistance, ASolverServesManySourcesFromManyThreads) {
  const Square square(12);
  const DistanceSolver solver(square.mesh(), SignedHeat{});
  std::vector<VecX> alone(8), together(8);
  for (int i = 0; i < 8; ++i) alone[i] = solver.solve(square.line(i + 2)).values;
  const DistanceSolver fresh(square.mesh(), SignedHeat{});
  std::vector<std::thread> threads;
  for (int i = 0; i < 8; ++i)
    threads.emplace_back(
        [&, i] { together[i] = fresh.solve(square.line(i + 2), {.threads = 1}).values; });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(alone, together);
  EXPECT_EQ(solver.report().domain, "triangle mesh");
}

TEST(FrontDistance, ContextReportsStopsAndLimits) {
  const Square square(40);
  const Mesh mesh = square.mesh();
  double last = 0;
  int calls = 0;
  Context context;
  context.progress = [&](double fraction, const std::string&) {
    EXPECT_GE(fraction, last);
    EXPECT_LE(fraction, 1);
    last = fraction;
    ++calls;
  };
  context.threads = 1;
  const VecX one = distance(mesh, square.line(9), {}, context).values;
  EXPECT_GT(calls, 3);
  EXPECT_EQ(last, 1);
  EXPECT_EQ(one, distance(mesh, square.line(9), {}, {.threads = 2}).values);
  Context stopped;
  stopped.cancel.cancel();
  EXPECT_THROW(distance(mesh, square.line(9), {}, stopped), Cancelled);
  Context small;
  small.memory_limit = 1000;
  std::vector<SurfacePoint> all;
  for (int v = 0; v < mesh.n_vertices(); ++v) all.push_back(SurfacePoint::at_vertex(v));
  EXPECT_THAT([&] { distance_matrix(mesh, all, Symmetric{}, small); },
              ThrowsMessage<IoError>(HasSubstr("memory")));
  const Sdf f = signed_distance(cube());
  EXPECT_THROW(f.sample(Grid::around(f, {.resolution = 40}), small), IoError);
  EXPECT_NO_THROW(f.sample(Grid::around(f, {.resolution = 10})));  // the limit went with its call
  last = 0;                                                        // of a call that is two
  EXPECT_EQ(offset(f, Grid::around(f, {.resolution = 10}), {0.1}, {}, context).size(), 1u);
  EXPECT_EQ(last, 1);
}

TEST(FrontDistance, MatrixBetweenPointsInsideFaces) {
  const Square square(10);
  const Mesh mesh = square.mesh();
  const std::vector<SurfacePoint> from = {SurfacePoint::at_vertex(0),
                                          SurfacePoint::in_face(57, 0.2, 0.3, 0.5)};
  const std::vector<SurfacePoint> to = {SurfacePoint::at_vertex(square.vertex(10, 10)),
                                        SurfacePoint::at_vertex(0)};
  const DistanceMatrix D = distance_matrix(mesh, from, to, Exact{});
  ASSERT_EQ(D.values.rows(), 2);
  ASSERT_EQ(D.values.cols(), 2);
  for (std::size_t i = 0; i < 2; ++i)
    for (std::size_t j = 0; j < 2; ++j)
      EXPECT_NEAR(D.values(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)),
                  (mesh.position(from[i]) - mesh.position(to[j])).norm(), 1e-12);
  EXPECT_THROW(distance_matrix(mesh, from, to, Symmetric{}), UnsupportedError);
  EXPECT_EQ(distance_matrix(mesh, {}, to, Exact{}).values.rows(), 0);
  EXPECT_THROW(distance_matrix(mesh, {SurfacePoint::at_vertex(999)}, Exact{}), InputError);
}

TEST(FrontWinding, RegionsOfALoop) {
  const Square square(8);
  const Mesh mesh = square.mesh();
  const Sources loop = Sources().add(
      Curve::along_vertices({square.vertex(2, 2), square.vertex(6, 2), square.vertex(6, 6),
                             square.vertex(2, 6), square.vertex(2, 2)}));
  const Regions r = winding(mesh, loop);
  for (int f = 0; f < mesh.n_faces(); ++f) {
    const Vec3 x = mesh.position(SurfacePoint::in_face(f, 1 / 3.0, 1 / 3.0, 1 / 3.0));
    const bool inside = x[0] > 0.25 && x[0] < 0.75 && x[1] > 0.25 && x[1] < 0.75;
    EXPECT_EQ(r.region[f], inside ? 1 : 0);
  }
  EXPECT_TRUE(r.nonbounding.empty());
  EXPECT_EQ(winding(mesh, loop.reversed()).region, -r.region);
}

TEST(FrontSpace, DistanceToACube) {
  const Sdf f = signed_distance(cube());
  EXPECT_NEAR(f(Vec3(0.5, 0.5, 0.5)), -0.5, 1e-12);
  EXPECT_NEAR(f(Vec3(2, 2, 2)), std::sqrt(3.0), 1e-12);
  EXPECT_NEAR(f.gradient(Vec3(2, 0.5, 0.5))[0], 1, 1e-12);
  MatX3 X(2, 3);
  X << 0.5, 0.5, 0.4, 3, 0.5, 0.5;
  const DistanceSamples at = f.with_gradients(X);
  EXPECT_EQ(at.values, f.at(X));
  EXPECT_NEAR(at.values[1], 2, 1e-12);
  EXPECT_NEAR(at.gradients(0, 2), -1, 1e-12);
  X(1, 2) = std::nan("");
  EXPECT_THAT([&] { f.at(X); }, ThrowsMessage<InputError>(HasSubstr("1")));
  EXPECT_EQ(f.bounds().row(1), Eigen::RowVector3d(1, 1, 1));

  const Volume v = f.sample(Grid::around(f, {.resolution = 24}));
  const Mesh shell = isosurface(v, 0.1);
  EXPECT_EQ(shell.n_components(), 1);
  for (int i = 0; i < shell.n_vertices(); ++i) EXPECT_NEAR(f(shell.points().row(i)), 0.1, 0.02);
  EXPECT_EQ(offset(v, {0.1, -0.1}).size(), 2U);
  EXPECT_THROW(isosurface(v, 99), InputError);
  EXPECT_NEAR(winding_number(cube(), MatX3(X.topRows(1)))[0], 1, 1e-3);
}

TEST(FrontSpaceSlow, FromAsFarAsNumbersGoEveryInputIsAPoint) {
  const Vec3 direction(0.6, 0.48, 0.64);
  PolygonSoup inward = cube();
  for (int f = 0; f < inward.n_faces(); ++f)
    std::reverse(inward.corners.begin() + inward.face_offsets[static_cast<std::size_t>(f)],
                 inward.corners.begin() + inward.face_offsets[static_cast<std::size_t>(f) + 1]);
  for (const AnyMethod& method :
       std::vector<AnyMethod>{{}, HopfCole{}, Planar{}, LogSumExp{}, Tori{}}) {
    const Sdf f = signed_distance(cube(), method);
    for (const double distance : {1e12, 1e14, 1e20, 1e100, 1e155, 1e300}) {
      const Vec3 x = distance * direction;
      // The mean of distances to planes is none to a point.
      const double tolerance = method.name() == "planar" && distance < 1e13 ? 0.5 : 1e-6;
      EXPECT_NEAR(f(x) / distance, 1, tolerance) << method.name() << " " << distance;
      EXPECT_NEAR(f.gradient(x).dot(direction), 1, tolerance) << method.name();
      EXPECT_EQ(f.at(MatX3(x.transpose()))[0], f(x));
    }
  }
  EXPECT_NEAR(signed_distance(inward, HopfCole{})(1e155 * direction), -1e155, 1e149);
}

TEST(FrontSpace, MethodsThatNeedAGridSayAndAreSampled) {
  const Sdf heat = signed_distance(cube(), SpaceSignedHeat{});
  EXPECT_THAT([&] { heat(Vec3::Zero()); }, ThrowsMessage<UnsupportedError>(HasSubstr("grid")));
  const Volume v = heat.sample(Grid::around(heat, {.resolution = 24}));
  EXPECT_LT(v.values.minCoeff(), -0.3);
  EXPECT_THROW(signed_distance(PolygonSoup{}), InputError);
  EXPECT_THROW(signed_distance(cube(), Exact{}), InputError);  // no method in space
}

TEST(FrontSpace, ShapesCombine) {
  PolygonSoup moved = cube();
  moved.points.col(0).array() += 0.5;
  const Sdf a = signed_distance(cube()), b = signed_distance(moved);
  const Vec3 in_both(0.75, 0.5, 0.5), in_a(0.25, 0.5, 0.5), in_b(1.25, 0.5, 0.5);
  EXPECT_LT(unite(a, b)(in_b), 0);
  EXPECT_GT(intersect(a, b)(in_a), 0);
  EXPECT_LT(intersect(a, b)(in_both), 0);
  EXPECT_LT(subtract(a, b)(in_a), 0);
  EXPECT_GT(subtract(a, b)(in_both), 0);
  EXPECT_EQ(unite(a, b).bounds()(1, 0), 1.5);
  const Sdf sampled = signed_distance(a.sample(Grid::around(a, {.resolution = 33})));
  EXPECT_NEAR(sampled(Vec3(0.5, 0.5, 0.5)), -0.5, 0.03);
}

TEST(FrontTets, ASolverServesManySources) {
  TetMesh mesh;
  mesh.points.resize(5, 3);
  mesh.points << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1;
  mesh.tets.resize(2, 4);
  mesh.tets << 0, 1, 2, 3, 1, 2, 3, 4;
  const TetDistanceSolver solver(mesh);
  TetSources from;
  from.vertices = {0};
  const TetField d = solver.solve(from);
  EXPECT_EQ(d.values, solver.solve(from).values);
  EXPECT_NEAR((d.values - distance(mesh, from).values).cwiseAbs().maxCoeff(), 0, 1e-12);
  EXPECT_NEAR(d.values[0], 0, 0.05);
  EXPECT_GT(d.values[4], 0.9);
  from.vertices = {7};
  EXPECT_THAT([&] { solver.solve(from); }, ThrowsMessage<InputError>(HasSubstr("7")));
}

TEST(FrontTets, TetsAroundAnInputAreSmallNearIt) {
  const PolygonSoup input = cube();  // [0, 1]^3
  const TetMesh tets = tets_around(input, {.resolution = 17, .padding = 0.5});
  // They fill the cube on the grid, right-handed: a volume of 2^3.
  double volume = 0, least_near = 1, least_far = 1;
  for (int t = 0; t < tets.n_tets(); ++t) {
    const auto at = [&](int k) { return Vec3(tets.points.row(tets.tets(t, k))); };
    const double six = (at(1) - at(0)).cross(at(2) - at(0)).dot(at(3) - at(0));
    EXPECT_GT(six, 0);
    volume += six / 6;
    const Vec3 centre = (at(0) + at(1) + at(2) + at(3)) / 4, q = (centre.array() - 0.5).abs();
    double& least = std::abs(q.maxCoeff() - 0.5) < 0.06 ? least_near : least_far;
    if (&least == &least_near || q.maxCoeff() > 0.9) least = std::min(least, six / 6);
  }
  EXPECT_NEAR(volume, 8, 1e-9);
  EXPECT_LT(3 * least_near, least_far);
  EXPECT_GT(tets_around(input, {.resolution = 33, .padding = 0.5}).n_tets(), 3 * tets.n_tets());

  // A cloud will do, with normals or without.
  PolygonSoup points;
  points.points = input.points;
  EXPECT_GT(tets_around(points, {.resolution = 9}).n_tets(), 100);
  EXPECT_THROW(tets_around(input, {.resolution = 1}), InputError);
  EXPECT_THROW(tets_around({}, {.resolution = 9}), InputError);
}

TEST(FrontTets, AnIsosurfaceOfDistanceThroughTets) {
  const PolygonSoup input = cube();
  TetSources from;
  from.surface = input;
  const TetField d = distance(tets_around(input, {.resolution = 17, .padding = 0.5}), from);
  const Mesh inner = isosurface(d, -0.25);  // the cube shrunk by as much, with sharp edges
  EXPECT_NEAR(inner.points().minCoeff(), 0.25, 1e-9);
  EXPECT_NEAR(inner.points().maxCoeff(), 0.75, 1e-9);
  EXPECT_THAT([&] { isosurface(d, 5); }, ThrowsMessage<InputError>(HasSubstr("no tet takes")));
  EXPECT_THROW(isosurface({d.mesh, d.values.head(3), {}}), InputError);
}

TEST(FrontFiles, WriteAndRead) {
  const auto folder =
      std::filesystem::temp_directory_path() /
      ("littoral_front_" + std::to_string(::testing::UnitTest::GetInstance()->random_seed()) +
       std::to_string(std::hash<std::thread::id>()(std::this_thread::get_id())));
  std::filesystem::create_directories(folder);
  const Square square(4);
  const Field d = distance(square.mesh(), square.line(2));
  write(d, folder / "d.ply");
  const PolygonSoup back = read_soup(folder / "d.ply");
  EXPECT_EQ(back.scalars.at("distance"), d.values);
  write(d, folder / "d.png");
  EXPECT_GT(std::filesystem::file_size(folder / "d.png"), 1000U);
  const Sdf f = signed_distance(cube());
  const Volume v = f.sample(Grid::around(f, {.resolution = 8}));
  write(v, folder / "v.nrrd");
  EXPECT_EQ(read_volume(folder / "v.nrrd").values, v.values);
  EXPECT_THROW(read_mesh(folder / "missing.obj"), IoError);
  EXPECT_THROW(write(d, folder / "d.xyz123"), UnsupportedError);
  std::filesystem::remove_all(folder);
}
