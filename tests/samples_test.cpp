// Samples for learning: where points lie, and what is said of them, with known answers.

#include "littoral/samples.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

#include "base/platform/temporary_folder.h"
#include "base/random_numbers.h"
#include "io/zip_archive.h"
#include "littoral/error.h"
#include "test_meshes.h"

namespace littoral {
namespace {

using PhiloxWords = std::array<std::uint32_t, 4>;

TEST(RandomNumbers, PhiloxHasTheKnownAnswers) {
  // Of Random123, the authors' library: kat_vectors.
  EXPECT_EQ(philox({0, 0, 0, 0}, {0, 0}),
            (PhiloxWords{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  EXPECT_EQ(philox({0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff}, {0xffffffff, 0xffffffff}),
            (PhiloxWords{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (PhiloxWords{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(RandomNumbers, HaveTheirMoments) {
  constexpr int n = 100000;
  double mean = 0, square = 0, normal_mean = 0, normal_square = 0, normal_fourth = 0;
  for (int i = 0; i < n; ++i) {
    RandomNumbers random(7, 3, static_cast<std::uint64_t>(i));
    const double u = random.uniform(), z = random.about_normal();
    ASSERT_TRUE(u >= 0 && u < 1 && std::abs(z) <= 6);
    mean += u / n;
    square += u * u / n;
    normal_mean += z / n;
    normal_square += z * z / n;
    normal_fourth += z * z * z * z / n;
  }
  // Five standard deviations of each estimate.
  EXPECT_NEAR(mean, 0.5, 5 * std::sqrt(1.0 / 12 / n));
  EXPECT_NEAR(square, 1.0 / 3, 5 * std::sqrt((1.0 / 5 - 1.0 / 9) / n));
  EXPECT_NEAR(normal_mean, 0, 5 / std::sqrt(n));
  EXPECT_NEAR(normal_square, 1, 5 * std::sqrt(2.0 / n));
  EXPECT_NEAR(normal_fourth, 3 - 0.1, 5 * std::sqrt(96.0 / n)) << "a sum of 12 has 3 - 6/5/12";
}

/// Points x of the unit sphere, or of the cube [-1, 1]^3, in the samples' cube.
MatX3 in_input(const Samples& samples, const MatX3& points) {
  return (points * samples.half_side).rowwise() + samples.centre.transpose();
}

SampleOptions sample_counts(int surface, int space) {
  SampleOptions options;
  options.surface = surface;
  options.space = space;
  options.resolution = 24;
  options.numbers = SampleNumbers::float64;
  return options;
}

/// [-1, 1]^3 as 12 triangles.
PolygonSoup sampled_cube() {
  PolygonSoup cube;
  cube.points.resize(8, 3);
  for (int v = 0; v < 8; ++v) cube.points.row(v) << (v & 1) * 2 - 1, (v & 2) - 1, (v & 4) / 2 - 1;
  for (const std::vector<int>& face : {std::vector{0, 2, 3, 1},
                                       {4, 5, 7, 6},
                                       {0, 1, 5, 4},
                                       {2, 6, 7, 3},
                                       {0, 4, 6, 2},
                                       {1, 3, 7, 5}})
    for (const std::vector<int>& triangle :
         {std::vector{face[0], face[1], face[2]}, {face[0], face[2], face[3]}})
      cube.add_face(triangle);
  return cube;
}

double distance_of_cube(const Vec3& x) {
  const Vec3 q = x.cwiseAbs() - Vec3::Ones();
  return q.cwiseMax(0).norm() + std::min(q.maxCoeff(), 0.0);
}

TEST(Samples, DistancesOfACubeAreExact) {
  SampleOptions options = sample_counts(1000, 2000);
  const Samples samples = sample(sampled_cube(), options);
  EXPECT_NEAR(samples.half_side, 1.2, 1e-12) << "half the side and the margin of a tenth";
  const MatX3 points = in_input(samples, samples.points);
  for (Eigen::Index i = 0; i < points.rows(); ++i)
    ASSERT_NEAR(samples.distances[i] * samples.half_side, distance_of_cube(points.row(i)), 1e-9)
        << i;
  const MatX3 surface = in_input(samples, samples.surface_points);
  for (Eigen::Index i = 0; i < surface.rows(); ++i) {
    ASSERT_NEAR(distance_of_cube(surface.row(i)), 0, 1e-9) << i;
    ASSERT_NEAR(samples.surface_normals.row(i).norm(), 1, 1e-9);
    const Vec3 x = surface.row(i), normal = samples.surface_normals.row(i);
    ASSERT_GT(normal.dot(x), 0.5) << "outward";
    if (x.cwiseAbs().maxCoeff() - x.cwiseAbs().minCoeff() > 0.2 &&
        samples.surface_kinds[i] == SampleKind::uniform) {
      Eigen::Index axis = 0;
      x.cwiseAbs().maxCoeff(&axis);
      Vec3 others = x.cwiseAbs();
      others[axis] = 0;
      if (others.maxCoeff() < 0.9) {
        ASSERT_NEAR(std::abs(normal[axis]), 1, 1e-6);
      }
    }
  }
  EXPECT_GT(samples.confidence.mean(), 0.99);
}

TEST(Samples, AreUniformInTheCubeAndSplitByShares) {
  const Samples samples = sample(sampled_cube(), sample_counts(0, 8000));
  const auto count = [&](SampleKind kind) {
    return std::count(samples.kinds.begin(), samples.kinds.end(), kind);
  };
  EXPECT_EQ(count(SampleKind::uniform), 2000);
  EXPECT_EQ(count(SampleKind::curvature), 2000);
  EXPECT_EQ(count(SampleKind::near), 4000);
  // Moments of the uniform distribution on [-1, 1]: 0, 1/3; five standard deviations.
  const MatX3 uniform = samples.points.topRows(2000);
  for (int a = 0; a < 3; ++a) {
    EXPECT_NEAR(uniform.col(a).mean(), 0, 5 * std::sqrt(1.0 / 3 / 2000));
    EXPECT_NEAR(uniform.col(a).squaredNorm() / 2000, 1.0 / 3, 5 * std::sqrt(4.0 / 45 / 2000));
  }
  // The share inside is that of the volume.
  const double inside = static_cast<double>((samples.distances.head(2000).array() <= 0).count());
  const double share = std::pow(1 / samples.half_side, 3);
  EXPECT_NEAR(inside / 2000, share, 5 * std::sqrt(share * (1 - share) / 2000));
}

TEST(Samples, NearPointsHaveTheirDeviations) {
  SampleOptions options = sample_counts(0, 12000);
  options.uniform = options.curvature = 0;
  options.scales = {0.01, 0.1};
  const Samples samples = sample(sampled_cube(), options);
  for (const double scale : options.scales) {
    // About a face far from edges, the distance is the noise along its normal.
    double square = 0;
    int n = 0;
    for (Eigen::Index i = 0; i < 12000; ++i) {
      if (samples.deviations[i] != scale) continue;
      Vec3 x = in_input(samples, samples.points).row(i).cwiseAbs();
      std::sort(x.begin(), x.end());
      if (scale == 0.1 || x[1] > 0.9) continue;
      square += std::pow(samples.distances[i] / scale, 2);
      ++n;
    }
    if (scale == 0.1) continue;
    ASSERT_GT(n, 3000);
    EXPECT_NEAR(square / n, 1, 5 * std::sqrt(2.0 / n));
  }
}

TEST(Samples, SharpPointsOfACubeAreAtItsEdges) {
  SampleOptions options = sample_counts(4000, 0);
  const Samples samples = sample(sampled_cube(), options);
  int near_edge[2] = {0, 0};
  const MatX3 points = in_input(samples, samples.surface_points);
  for (Eigen::Index i = 0; i < 4000; ++i) {
    Vec3 x = points.row(i).cwiseAbs();
    std::sort(x.begin(), x.end());
    const bool sharp = samples.surface_kinds[i] == SampleKind::sharp;
    if (x[1] > 1 - 2 * 2.4 / 23) ++near_edge[sharp ? 1 : 0];  // within two cells
  }
  EXPECT_EQ(near_edge[1], 2000);
  // Uniform ones by the share of the area there.
  const double inner = std::pow(1 - 2 * 2.4 / 23, 2);
  EXPECT_NEAR(near_edge[0] / 2000.0, 1 - inner, 0.06);
}

TEST(Samples, AreUniformOnASphere) {
  const PolygonSoup sphere = test::octasphere_soup(4);
  SampleOptions options = sample_counts(9000, 0);
  options.sharp = 0;
  const Samples samples = sample(sphere, options);
  const MatX3 x = in_input(samples, samples.surface_points);
  // Moments of the sphere: E x = 0, E x_a^2 = 1/3 (variance 4/45), E x_a^4 = 1/5.
  for (int a = 0; a < 3; ++a) {
    EXPECT_NEAR(x.col(a).mean(), 0, 5 * std::sqrt(1.0 / 3 / 9000));
    EXPECT_NEAR(x.col(a).squaredNorm() / 9000, 1.0 / 3, 5 * std::sqrt(4.0 / 45 / 9000) + 0.003);
    EXPECT_NEAR(x.col(a).array().pow(4).mean(), 1.0 / 5, 0.012);
  }
  EXPECT_NEAR(x.rowwise().norm().mean(), 1, 0.002);
  const auto& sizes = samples.report.sizes;
  const auto open = std::find_if(sizes.begin(), sizes.end(),
                                 [](const auto& s) { return s.first == "surface open edges"; });
  ASSERT_NE(open, sizes.end());
  EXPECT_EQ(open->second, 0);
}

std::string file_of_samples(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(Samples, DependOnSeedAndNotOnThreads) {
  const TemporaryFolder folder("samples");
  const auto written = [&](std::uint64_t seed, int threads) {
    SampleOptions options = sample_counts(300, 300);
    options.seed = seed;
    options.resolution = 16;
    options.numbers = SampleNumbers::float32;
    const auto path = folder.path() / "a.npz";
    write(sample(sampled_cube(), options, {}, {}, {.threads = threads}), path, "cube");
    return file_of_samples(path) + file_of_samples(folder.path() / "a.json");
  };
  const std::string first = written(1, 1);
  EXPECT_EQ(first, written(1, 4));
  EXPECT_NE(first, written(2, 1));
}

TEST(Samples, HoldTheDistanceOfTheStoredPosition) {
  SampleOptions options = sample_counts(0, 500);
  options.numbers = SampleNumbers::float16;
  const Samples samples = sample(sampled_cube(), options);
  const MatX3 points = in_input(samples, samples.points);
  for (Eigen::Index i = 0; i < 500; ++i) {
    for (int a = 0; a < 3; ++a)
      ASSERT_EQ(samples.points(i, a),
                static_cast<double>(Eigen::half(float(samples.points(i, a)))));
    ASSERT_NEAR(samples.distances[i] * samples.half_side, distance_of_cube(points.row(i)), 1e-9);
  }
}

TEST(Samples, RefuseWhatMakesNoSense) {
  const auto refused = [](auto change) {
    SampleOptions options = sample_counts(10, 10);
    change(options);
    EXPECT_THROW(sample(sampled_cube(), options), InputError);
  };
  refused([](SampleOptions& o) { o.resolution = 2; });
  refused([](SampleOptions& o) { o.surface = -1; });
  refused([](SampleOptions& o) { o.uniform = 0.7, o.curvature = 0.7; });
  refused([](SampleOptions& o) { o.sharp = std::nan(""); });
  refused([](SampleOptions& o) { o.scales.clear(); });
  refused([](SampleOptions& o) { o.scales = {-1}; });
  EXPECT_THROW(sample(PolygonSoup(), sample_counts(1, 1)), InputError);
  const TemporaryFolder folder("samples");
  const Samples samples = sample(sampled_cube(), sample_counts(4, 4));
  EXPECT_THROW(write(samples, folder.path() / "a.txt", "cube"), UnsupportedError);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace littoral
