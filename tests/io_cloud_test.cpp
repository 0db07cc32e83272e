// Readers of point clouds: .pc, .xyz, .pcd.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "shared_data.h"
#include "surface_bytes.h"

namespace littoral::io {
namespace {

using test::error_of;
using test::read;
using ::testing::HasSubstr;

TEST(IoPc, ReadsPointsAndNormalsInterleavedOrInBlocks) {
  for (const char* text :
       {"v 1 2 3\nvn 0 0 1\nv 4 5 6\nvn 0 1 0\n", "v 1 2 3\nv 4 5 6\nvn 0 0 1\nvn 0 1 0"}) {
    const PolygonSoup cloud = read(text, ".pc");
    ASSERT_EQ(cloud.points.rows(), 2);
    EXPECT_EQ(cloud.points.row(1), Eigen::RowVector3d(4, 5, 6));
    EXPECT_EQ(cloud.normals.row(1), Eigen::RowVector3d(0, 1, 0));
    EXPECT_EQ(cloud.n_faces(), 0);
  }
  EXPECT_EQ(read("v 1 2 3 # no normals\n", ".pc").normals.rows(), 0);
}

TEST(IoPc, SaysWhatIsWrong) {
  EXPECT_EQ(error_of("", ".pc"), "a.pc: no points");
  EXPECT_EQ(error_of("v 1 2 3\nv 1 2 3\nvn 1 0 0", ".pc"), "a.pc: 2 points but 1 normals");
  EXPECT_THAT(error_of("v 1 2\n", ".pc"), HasSubstr("a.pc:1: "));
  EXPECT_THAT(error_of("v 1 2 3\nf 1 2 3\n", ".pc"), HasSubstr("a.pc:2: expected 'v x y z'"));
}

TEST(IoXyz, SixColumnsHaveNormalsAndOthersDoNot) {
  EXPECT_EQ(read("1 2 3 0 0 1\n4 5 6 1 0 0\n", ".xyz").normals.rows(), 2);
  const PolygonSoup coloured = read("2\n1 2 3 117 73 49 255\n4 5 6 91 87 74 255\n", ".xyz");
  EXPECT_EQ(coloured.points.rows(), 2);
  EXPECT_EQ(coloured.normals.rows(), 0);
  EXPECT_THAT(error_of("1 2 3\n1 2 3 4\n", ".xyz"), HasSubstr("a.xyz:2: a row of 4 numbers"));
  EXPECT_THAT(error_of("1 2\n", ".xyz"), HasSubstr("x y z are needed"));
  EXPECT_THAT(error_of("1 b 2\n", ".xyz"), HasSubstr("a.xyz:1: expected a number"));
}

std::string pcd(const std::string& data, int points) {
  return "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z rgb normal_x normal_y normal_z\nSIZE 4 4 4 1 8 8 "
         "8\nTYPE F F F U F F F\nCOUNT 1 1 1 2 1 1 1\nWIDTH 2\nHEIGHT 1\nPOINTS " +
         std::to_string(points) + "\nDATA " + data;
}

TEST(IoPcd, TextAndBinaryAgree) {
  std::string body;
  for (int r = 0; r < 2; ++r) {
    const float p[3] = {1.0f + r, 2, 3};
    const double n[3] = {0, 0.5, 1};
    body.append(reinterpret_cast<const char*>(p), sizeof p);
    body.append(2, '\xff');
    body.append(reinterpret_cast<const char*>(n), sizeof n);
  }
  const PolygonSoup binary = read(pcd("binary\n" + body, 2), ".pcd");
  const PolygonSoup text = read(pcd("ascii\n1 2 3 9 9 0 .5 1\n2 2 3 9 9 0 .5 1\n", 2), ".pcd");
  EXPECT_EQ(binary.points, text.points);
  EXPECT_EQ(binary.normals, text.normals);
  EXPECT_EQ(text.points(1, 0), 2);
  EXPECT_EQ(text.normals(0, 1), 0.5);
}

TEST(IoPcd, SaysWhatIsWrong) {
  EXPECT_THAT(error_of(pcd("ascii\n1 2 3 9 9 0 .5 1\n", 2), ".pcd"), HasSubstr("2 points"));
  EXPECT_THAT(error_of(pcd("binary\nabc", 2000000000), ".pcd"), HasSubstr("promises"));
  EXPECT_THAT(error_of(pcd("binary_compressed\n", 2), ".pcd"), HasSubstr("not supported"));
  EXPECT_THAT(error_of("FIELDS x y\nPOINTS 0\nDATA ascii\n", ".pcd"), HasSubstr("no x, y and z"));
  EXPECT_THAT(error_of("FIELDS x y z\nPOINTS 0\nDATA ascii\n", ".pcd"), HasSubstr("no points"));
  EXPECT_THAT(error_of("FIELDS x y z\n", ".pcd"), HasSubstr("ends before DATA"));
}

TEST(IoClouds, ReadsSharedFiles) {
  LITTORAL_NEEDS_SHARED("data/clouds");
  const std::filesystem::path clouds = test::shared() / "data/clouds";
  EXPECT_EQ(read_surface(clouds / "bunny.pc").normals.rows(), 1430);
  EXPECT_EQ(read_surface(clouds / "bunny.pcd").points.rows(), 397);
  EXPECT_GT(read_surface(clouds / "points_cloudcompare.xyz").points.rows(), 10);
  EXPECT_EQ(read_surface(clouds / "snail.ply").normals.rows(), 4096);
}

}  // namespace
}  // namespace littoral::io
