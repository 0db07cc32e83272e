// Voxels: files, masks, boundaries with corrected normals.

#include <gtest/gtest.h>
#include <zlib.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <vector>

#include "domain_shapes.h"
#include "io/volume/read_voxels.h"
#include "io/volume/volume.h"
#include "littoral/error.h"

namespace littoral {
namespace {

std::string vol_header(int version, const std::string& more = "") {
  return "X: 3\nY: 2\nZ: 2\nVoxel-Size: 1\n" + more + "Version: " + std::to_string(version) +
         "\n.\n";
}

const std::string voxels("\1\0\0\2\0\0\0\0\0\0\0\3", 12);

TEST(VoxelFiles, PlainAndPackedVolumesAreTheSame) {
  const io::VoxelMask plain = io::read_vol_bytes(vol_header(2) + voxels, "a.vol");
  EXPECT_EQ(plain.grid.n, (std::array<int, 3>{3, 2, 2}));
  EXPECT_EQ(plain.inside[plain.grid.node(0, 1, 0)], 2);  // x fastest
  EXPECT_EQ(plain.inside[plain.grid.node(2, 1, 1)], 3);
  uLongf size = compressBound(12);
  std::string packed(size, '\0');
  ASSERT_EQ(compress(reinterpret_cast<Bytef*>(packed.data()), &size,
                     reinterpret_cast<const Bytef*>(voxels.data()), 12),
            Z_OK);
  packed.resize(size);
  EXPECT_EQ(io::read_vol_bytes(vol_header(3) + packed, "b.vol").inside, plain.inside);
  for (std::size_t cut = 0; cut < packed.size(); ++cut)
    EXPECT_THROW(io::read_vol_bytes(vol_header(3) + packed.substr(0, cut), "c.vol"), InputError);
}

TEST(VoxelFiles, DamagedVolumesAreErrors) {
  for (const std::string& bytes :
       {std::string(), std::string("."), vol_header(2), vol_header(2) + voxels.substr(1),
        std::string("X: 3\nY: 2\n.\n") + voxels, std::string("X: 0\nY: 2\nZ: 2\n.\n") + voxels,
        std::string("X: 99999\nY: 99999\nZ: 99999\n.\n") + voxels,
        std::string("X: 3\nY 2\nZ: 2\n.\n") + voxels})
    EXPECT_THROW(io::read_vol_bytes(bytes, "a.vol"), InputError) << bytes;
  EXPECT_THROW(io::read_vol_bytes(vol_header(4) + voxels, "a.vol"), UnsupportedError);
}

TEST(VoxelFiles, VolumesOfNumbersAreMasks) {
  Volume field;
  field.grid = {{3, 3, 3}, Vec3(1, 2, 3), Vec3::Constant(0.5)};
  field.values = VecX::Zero(27);
  field.values[static_cast<Eigen::Index>(field.grid.node(1, 0, 2))] = 7;
  const auto folder = std::filesystem::temp_directory_path();
  for (const char* extension : {".nrrd", ".vti", ".npy"}) {
    const auto path = folder / (std::string("littoral_voxels_test") + extension);
    io::write_volume(path, field);
    const io::VoxelMask mask = io::read_voxels(path);
    for (std::size_t i = 0; i < 27; ++i)
      EXPECT_EQ(mask.inside[i] != 0, i == field.grid.node(1, 0, 2)) << extension << i;
    if (std::string(extension) != ".npy") {
      EXPECT_EQ(mask.grid.spacing, field.grid.spacing);
      EXPECT_EQ(mask.grid.origin, field.grid.origin);
    }
    Volume bad = field;
    bad.values[3] = -1;
    io::write_volume(path, bad);
    EXPECT_THROW(io::read_voxels(path), InputError);
    bad.values[3] = std::nan("");
    io::write_volume(path, bad);
    EXPECT_THROW(io::read_voxels(path), InputError);
    std::filesystem::remove(path);
  }
}

TEST(VoxelBoundary, OneVoxelIsACube) {
  Grid grid{{1, 1, 1}, Vec3(5, 6, 7), Vec3(1, 2, 4)};
  const VoxelSurface cube = boundary_of_voxels(grid, {1});
  EXPECT_EQ(cube.mesh.n_vertices(), 8);
  EXPECT_EQ(cube.mesh.n_faces(), 6);
  EXPECT_EQ(Vec3(cube.mesh.points().colwise().minCoeff()), Vec3(4.5, 5, 5));
  EXPECT_EQ(Vec3(cube.mesh.points().colwise().maxCoeff()), Vec3(5.5, 7, 9));
  for (int f = 0; f < 6; ++f) {
    const auto c = cube.mesh.face(f);
    const Vec3 a = cube.mesh.point(c[0]), b = cube.mesh.point(c[1]), d = cube.mesh.point(c[3]);
    const Vec3 centre = 0.5 * (b + d) - grid.origin, outward = (b - a).cross(d - a);
    EXPECT_GT(outward.dot(centre), 0);
    EXPECT_NEAR(outward.normalized().dot(cube.face_normals.row(f)), 1, 1e-12);
  }
  EXPECT_THROW(boundary_of_voxels(grid, {0}), InputError);
}

TEST(VoxelBoundary, NormalsAreTheSameInAnyUnit) {
  const int n = 9;
  Grid grid{{n, n, n}, Vec3::Zero(), Vec3(1, 1.5, 0.75)};
  std::vector<unsigned char> ball(grid.n_nodes());
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i)
        ball[grid.node(i, j, k)] = Vec3(i - 4, j - 4, k - 4).squaredNorm() <= 10;
  const MatX3 normals = boundary_of_voxels(grid, ball).face_normals;
  for (const double unit : {1e-200, 1e-3, 1e200}) {
    Grid scaled = grid;
    scaled.spacing *= unit;
    const MatX3 same = boundary_of_voxels(scaled, ball).face_normals;
    EXPECT_LT((same - normals).cwiseAbs().maxCoeff(), 1e-12) << unit;
  }
}

TEST(VoxelBoundary, SpacingsMustBePositive) {
  for (const Vec3& spacing : {Vec3(1, 0, 1), Vec3(1, 1, -1), Vec3(1e308, 1, 1)}) {
    const Grid grid{{3, 1, 1}, Vec3::Zero(), spacing};
    EXPECT_THROW(boundary_of_voxels(grid, {1, 1, 1}), InputError) << spacing.transpose();
  }
}

TEST(VoxelBoundary, CorrectedNormalsConverge) {
  double error[2];
  for (int l = 0; l < 2; ++l) {
    const test::Shape s = test::sphere(test::Domain::voxels, 12 << (2 * l));
    error[l] = 0;
    for (int f = 0; f < s.soup.n_faces(); ++f) {
      Vec3 centre = Vec3::Zero();
      for (int v : s.soup.face(f)) centre += s.soup.points.row(v).transpose() / 4;
      const Vec3 n = s.face_normals.row(f);
      error[l] += std::acos(std::min(1.0, n.dot(centre.normalized()))) / s.soup.n_faces();
    }
  }
  EXPECT_LT(error[0], 0.12);
  EXPECT_LT(error[1], error[0] / std::exp2(2 * 0.6));  // order 2/3 is proven
}

TEST(VoxelBoundary, CorrectedNormalsPointAwayFromTheCentroidInABallOfTheExtentsSize) {
  // Ellipsoids longest along one axis or another: the ball is 0.5 n^(2/3) voxels large, at least
  // 2.5 and at most 10.
  const auto beyond = [](const Vec3& x, const Vec3& half) {
    return x.cwiseQuotient(half).squaredNorm() > 1;
  };
  for (const Vec3& half :
       {Vec3(3.2, 4.1, 13.3), Vec3(12.6, 3.4, 3.9), Vec3(3.3, 14.2, 4.4), Vec3(2.2, 2.4, 1.9)}) {
    Grid grid;
    for (int a = 0; a < 3; ++a) grid.n[a] = 2 * static_cast<int>(half[a]) + 4;
    grid.origin = Vec3(1, -2, 3);
    grid.spacing = Vec3::Constant(0.25);
    const Vec3 middle(0.5 * (grid.n[0] - 1), 0.5 * (grid.n[1] - 1), 0.5 * (grid.n[2] - 1));
    std::vector<unsigned char> inside(grid.n_nodes());
    std::vector<Vec3> voxels;
    Eigen::Vector3d low = Vec3::Constant(1e9), high = -low;
    for (int k = 0; k < grid.n[2]; ++k)
      for (int j = 0; j < grid.n[1]; ++j)
        for (int i = 0; i < grid.n[0]; ++i) {
          if (beyond(Vec3(i, j, k) - middle, half)) continue;
          inside[grid.node(i, j, k)] = 1;
          voxels.emplace_back(i, j, k);
          low = low.cwiseMin(voxels.back());
          high = high.cwiseMax(voxels.back());
        }
    const double extent = (high - low).maxCoeff() + 1;
    const double radius = std::clamp(0.5 * std::pow(extent, 2.0 / 3), 2.5, 10.0);
    const VoxelSurface surface = boundary_of_voxels(grid, inside);
    EXPECT_GT(surface.mesh.n_faces(), 50);
    for (int f = 0; f < surface.mesh.n_faces(); ++f) {
      Vec3 centre = Vec3::Zero(), sum = Vec3::Zero();
      for (const int v : surface.mesh.face(f))
        centre += (surface.mesh.point(v) - grid.origin).cwiseQuotient(grid.spacing) / 4;
      for (const Vec3& x : voxels)
        if ((x - centre).norm() <= radius) sum += centre - x;
      EXPECT_LT((sum.normalized() - surface.face_normals.row(f).transpose()).norm(), 1e-9)
          << half.transpose() << ", " << f;
    }
  }
}

}  // namespace
}  // namespace littoral
