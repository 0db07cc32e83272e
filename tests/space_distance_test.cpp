// Distance in space through the front door: methods against exact distances, invariance, errors.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <utility>

#include "api/space/sdf.h"
#include "io/read.h"
#include "littoral/error.h"
#include "littoral/littoral.h"
#include "methods/implicit/closest_point.h"
#include "shared_data.h"
#include "space_helpers.h"
#include "spatial/triangulate.h"

namespace littoral {
namespace {

using test::message_of;
using ::testing::HasSubstr;

SpaceRequest by(const std::string& method, const OptionValues& options = {}) {
  return {AnyMethod::named(method, options)};
}

VecX on_grid(const PolygonSoup& input, const Grid& grid, const std::string& method,
             const OptionValues& options = {}) {
  Report report;
  return grid_distance(input, grid, by(method, options), Task(), report);
}

VecX ask(const PolygonSoup& input, const MatX3& queries, const std::string& method,
         MatX3* gradients = nullptr) {
  Report report;
  return query_distance(input, queries, by(method), gradients, Task(), report);
}

TEST(SpaceDistanceSlow, SignedHeatOnBoxTorusAndCylinderFallsWithTheSpacing) {
  const Vec3 half(0.5, 0.6, 0.7);
  const PolygonSoup shapes[] = {test::box_soup(half), test::torus_soup(96, 48, 0.7, 0.3),
                                test::cylinder_soup(96, 0.5, 0.6)};
  const double order[] = {0.5, 0.6, 0.2};  // observed, less a margin: edges are rounded
  for (int s = 0; s < 3; ++s) {
    const auto error = [&](int n) {
      const Grid grid = test::cube_grid(n, 1.2);
      return test::mean_error(grid, on_grid(shapes[s], grid, "signed-heat"), [&](const Vec3& x) {
        return s == 0   ? test::box_distance(x, half)
               : s == 1 ? test::torus_distance(x, 0.7, 0.3)
                        : test::cylinder_distance(x, 0.5, 0.6);
      });
    };
    const double coarse = error(17), fine = error(49);
    EXPECT_LT(fine, 0.025) << s;
    EXPECT_GT(std::log(coarse / fine) / std::log(3.0), order[s]) << s;
  }
}

TEST(SpaceDistance, OnTheSurfaceItIsPlainZero) {
  const PolygonSoup box = test::box_soup(Vec3(0.5, 0.5, 0.5));
  const Grid grid = test::cube_grid(9, 1);  // nodes 0.25 apart: 98 of them on the box
  for (const char* method : {"auto", "winding", "closest-point"}) {
    const Sdf sdf = signed_distance(box, AnyMethod::named(method));
    int on = 0;
    const auto look = [&](double value) {
      if (value != 0) return;
      ++on;
      EXPECT_FALSE(std::signbit(value)) << method;
    };
    for (const double value : sdf.sample(grid).values) look(value);
    for (const double value : on_grid(box, grid, method)) look(value);
    look(sdf({0.5, 0, 0}));
    look(sdf({0, 0.1, -0.5}));
    EXPECT_EQ(on, 2 * 98 + 2) << method;
  }
}

TEST(SpaceDistance, ClosestPointMethodsAreExactOnClosedMeshes) {
  const Vec3 half(0.5, 0.6, 0.7);
  const MatX3 queries = test::random_points(500, 1.5);
  for (const char* method : {"winding", "closest-point"}) {
    MatX3 gradients;
    const VecX values = ask(test::box_soup(half), queries, method, &gradients);
    for (Eigen::Index i = 0; i < queries.rows(); ++i) {
      EXPECT_NEAR(values[i], test::box_distance(queries.row(i), half), 1e-9) << method;
      EXPECT_NEAR(gradients.row(i).norm(), 1, 1e-9);
    }
  }
}

TEST(SpaceDistance, ClosestPointMethodsOnGridsAreThemselvesNodeByNode) {
  // Closed, and where all is open and the side is that of the nearest face.
  PolygonSoup open = test::octasphere_soup(4);
  MatX3i faces = triangles_of(open);
  faces.conservativeResize(faces.rows() / 2 - 7, 3);
  const PolygonSoup torus = triangulate(test::off_centre_torus());
  const Grid grid = test::cube_grid(33, 1.3);
  for (const SignRule rule : {SignRule::winding, SignRule::pseudonormal})
    for (const auto& [points, triangles] :
         {std::pair(open.points, faces), std::pair(torus.points, triangles_of(torus))}) {
      const auto distance = closest_point_distance(points, triangles, rule);
      const VecX fast = distance->on_grid(grid, Task()),
                 slow = distance->PointwiseDistance::on_grid(grid, Task());
      EXPECT_LE((fast.cwiseAbs() - slow.cwiseAbs()).cwiseAbs().maxCoeff(), 1e-15);
      EXPECT_LE((fast - slow).cwiseAbs().maxCoeff(), 1e-15);
    }
}

TEST(SpaceDistance, PseudonormalIsRightWhereFaceNormalsAreNot) {
  // Above the tip of a thin pyramid the nearest point is the tip, which belongs to all faces.
  PolygonSoup tip;
  tip.points.resize(4, 3);
  tip.points << 0, 0, 1, 1, 0, -3, -0.5, 0.866, -3, -0.5, -0.866, -3;
  const int faces[4][3] = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}};
  for (const auto& f : faces) tip.add_face(f);
  MatX3 queries(3, 3);
  queries << 0.3, 0, 1.1, 0, 0, 1.5, 0, 0, 0;
  const VecX values = ask(tip, queries, "closest-point");
  EXPECT_NEAR(values[0], std::hypot(0.3, 0.1), 1e-9);
  EXPECT_NEAR(values[1], 0.5, 1e-9);
  EXPECT_LT(values[2], 0);
}

TEST(SpaceDistanceSlow, KernelMethodsApproximateTheSphereAndTheirGradientsAreDerivatives) {
  const PolygonSoup sphere = test::octasphere_soup(5);
  MatX3 queries = test::random_points(40, 1.6);
  for (const char* method : {"hopf-cole", "planar", "log-sum-exp"}) {
    MatX3 gradients;
    const VecX values = ask(sphere, queries, method, &gradients);
    for (Eigen::Index i = 0; i < queries.rows(); ++i) {
      const double exact = queries.row(i).norm() - 1;
      if (std::abs(exact) < 0.15 || exact < -0.8) continue;
      EXPECT_NEAR(values[i], exact, 0.1) << method;
      const double h = 1e-5;
      for (int a = 0; a < 3; ++a) {
        MatX3 both(2, 3);
        both << queries.row(i), queries.row(i);
        both(0, a) += h;
        both(1, a) -= h;
        const VecX v = ask(sphere, both, method);
        EXPECT_NEAR(gradients(i, a), (v[0] - v[1]) / (2 * h), 1e-5) << method;
      }
      if (i > 5) break;
    }
  }
}

TEST(SpaceDistanceSlow, FarAwayNothingUnderflows) {
  MatX3 far(1, 3);
  far << 1e4, 0, 0;
  for (const char* method : {"hopf-cole", "planar", "log-sum-exp", "winding", "closest-point"})
    EXPECT_NEAR(ask(test::octasphere_soup(3), far, method)[0], 1e4, 200) << method;
}

TEST(SpaceDistanceSlow, MovesAndScalesWithTheInput) {
  const PolygonSoup torus = test::off_centre_torus();
  const Grid grid = test::cube_grid(17, 1.2);
  for (const char* method : {"auto", "signed-heat", "winding", "planar"}) {
    const VecX base = on_grid(torus, grid, method);
    for (const double scale : {1e-3, 1.0, 1e3}) {
      PolygonSoup moved = torus;
      const Vec3 shift = Vec3(1, -2, 0.5) * 1e6 * scale;
      moved.points = (scale * torus.points).rowwise() + shift.transpose();
      Grid there = grid;
      there.origin = scale * grid.origin + shift;
      there.spacing *= scale;
      const VecX values = on_grid(moved, there, method);
      EXPECT_LT((values / scale - base).cwiseAbs().maxCoeff(), 2e-3) << method << " " << scale;
    }
  }
}

TEST(SpaceDistance, FlippingNegatesAndOrderDoesNotMatter) {
  const PolygonSoup torus = test::off_centre_torus();
  PolygonSoup relabelled = torus;
  for (int f = 0; f < torus.n_faces(); ++f)
    for (int k = 0; k < 3; ++k)
      relabelled.corners[3 * f + k] = torus.face(torus.n_faces() - 1 - f)[(k + 1) % 3];
  const Grid grid = test::cube_grid(17, 1.2);
  Report report;
  SpaceRequest flipped = by("signed-heat");
  flipped.flip = true;
  const VecX base = on_grid(torus, grid, "signed-heat");
  EXPECT_LT((grid_distance(torus, grid, flipped, Task(), report) + base).cwiseAbs().maxCoeff(),
            2e-3);
  EXPECT_LT((on_grid(relabelled, grid, "signed-heat") - base).cwiseAbs().maxCoeff(), 2e-3);
}

TEST(SpaceDistance, HolesAndFlippedFacesChangeLittle) {
  PolygonSoup sphere = test::octasphere_soup(4);
  const Grid grid = test::cube_grid(25, 1.5);
  PolygonSoup broken;
  broken.points = sphere.points;
  for (int f = 0; f < sphere.n_faces(); ++f) {
    std::vector<int> face(sphere.face(f).begin(), sphere.face(f).end());
    if (f % 17 == 0) continue;                                // holes
    if (f % 13 == 0) std::reverse(face.begin(), face.end());  // flipped
    broken.add_face(face);
  }
  const VecX values = on_grid(broken, grid, "signed-heat");
  EXPECT_LT(test::mean_error(grid, values, [](const Vec3& x) { return x.norm() - 1; }), 0.02);
}

TEST(SpaceDistance, GridsFitTheInputOrTheBounds) {
  const PolygonSoup box = test::box_soup({2, 1, 0.5});
  GridOptions request;
  request.resolution = 33;
  request.padding = 0.5;
  const Grid grid = choose_grid(box, request);
  EXPECT_EQ(grid.n[0], 33);
  EXPECT_NEAR(grid.spacing[0], 8.0 / 32, 1e-12);
  EXPECT_NEAR(grid.point(32, 0, 0)[0] + grid.origin[0], 0, 1e-9);
  request.bounds = {-1, -1, -1, 3, 1, 2.1};
  const Grid bounded = choose_grid(box, request);
  EXPECT_LT((bounded.point(bounded.n[0] - 1, bounded.n[1] - 1, bounded.n[2] - 1) - Vec3(3, 1, 2.1))
                .norm(),
            1e-9);
  EXPECT_NEAR(bounded.spacing[2], 0.125, 0.01);
}

TEST(SpaceDistance, SaysWhatIsWrong) {
  const PolygonSoup box = test::box_soup({1, 1, 1});
  const auto choose = [&](auto change) {
    GridOptions request;
    change(request);
    return message_of([&] { choose_grid(box, request); });
  };
  EXPECT_THAT(choose([](GridOptions& g) { g.resolution = 1; }), HasSubstr("option resolution"));
  EXPECT_THAT(choose([](GridOptions& g) { g.spacing = -1; }), HasSubstr("option spacing"));
  EXPECT_THAT(choose([](GridOptions& g) { g.bounds = {5, 5, 5, 6, 6, 6}; }), HasSubstr("misses"));
  EXPECT_THAT(choose([](GridOptions& g) { g.bounds = {1, 0, 0, 0, 1, 1}; }), HasSubstr("x0 < x1"));
  EXPECT_THAT(choose([](GridOptions& g) { g.spacing = 1e-9; }), HasSubstr("million"));
  EXPECT_THAT(choose([](GridOptions& g) { g.resolution = 1000000; }), HasSubstr("resolution"));
  const MatX3 query = MatX3::Zero(1, 3);
  EXPECT_THAT(message_of([&] { ask(box, query, "signed-heat"); }),
              HasSubstr("not on a set of points, on which there are: auto, winding"));
  EXPECT_THAT(message_of([&] { ask(box, query, "magic"); }), HasSubstr("unknown method"));
  EXPECT_THAT(message_of([&] { ask(box, MatX3::Constant(1, 3, std::nan("")), "winding"); }),
              HasSubstr("query point 0"));
  PolygonSoup bare;
  bare.points = test::random_points(10, 1);
  EXPECT_THAT(message_of([&] { ask(bare, query, "planar"); }),
              HasSubstr("option estimate-normals"));
  EXPECT_THAT(message_of([&] { ask(PolygonSoup(), query, "planar"); }), HasSubstr("no faces"));
}

// The authors' grids, with their diffusion time and constraint: the same sign at 99.4 % of the
// nodes, mean difference at most a cell.
struct AuthorsCase {
  const char *name, *input;
  double least;  // share of nodes with the same sign
};
class AuthorsGrids : public ::testing::TestWithParam<AuthorsCase> {};

TEST_P(AuthorsGrids, AgreeSlow) {
  const auto [name, input, least] = GetParam();
  LITTORAL_NEEDS_SHARED("reference/shm_grid");
  const auto folder = test::shared() / "reference/shm_grid" / name;
  const std::string header = io::read_bytes(folder / "header.json");
  const auto number = [&](const std::string& key, int item) {
    std::size_t at = header.find("\"" + key + "\"");
    at = header.find_first_of("-0123456789", at + key.size() + 2);
    for (; item > 0; --item) at = header.find(',', at) + 1;
    return std::strtod(header.c_str() + at, nullptr);
  };
  Grid grid;
  grid.n.fill(32);
  grid.spacing.setConstant(number("cell", 0));
  for (int a = 0; a < 3; ++a) grid.origin[a] = number("bbox_min", a);
  const std::string bytes = io::read_bytes(folder / "phi.f64");
  const VecX theirs = Eigen::Map<const VecX>(reinterpret_cast<const double*>(bytes.data()),
                                             static_cast<Eigen::Index>(grid.n_nodes()));
  const VecX ours = on_grid(io::read_surface(test::shared() / "data" / input), grid, "signed-heat",
                            {{"constraint", "zero-set"}});
  const double same = ((theirs.array() < 0) == (ours.array() < 0)).cast<double>().mean();
  const double difference = (theirs - ours).cwiseAbs().mean() / grid.spacing[0];
  RecordProperty("same_sign", std::to_string(same));
  RecordProperty("mean_difference_in_cells", std::to_string(difference));
  EXPECT_GE(same, least);
  EXPECT_LE(difference, 1);
}

INSTANTIATE_TEST_SUITE_P(Shared, AuthorsGrids,
                         ::testing::Values(AuthorsCase{"bunny_small_n32",
                                                       "soups/shm3d-bunny_small.obj", 0.995},
                                           AuthorsCase{"chair_n32", "soups/shm3d-chair.obj", 0.994},
                                           AuthorsCase{"bunny_pc_n32", "clouds/bunny.pc", 0.995},
                                           AuthorsCase{"rocker_pc_n32", "clouds/rocker.pc", 0.994}),
                         [](const auto& each) { return std::string(each.param.name); });

}  // namespace
}  // namespace littoral
