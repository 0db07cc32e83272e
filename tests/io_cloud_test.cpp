// Readers of point clouds: .pc, .xyz, .pcd.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "io/binary.h"
#include "io/formats.h"
#include "io/write_table.h"
#include "io/zip_archive.h"
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
  EXPECT_EQ(error_of("", ".pc"), "a.pc: no points; the file is empty");
  EXPECT_EQ(error_of("v 1 2 3\nv 1 2 3\nvn 1 0 0", ".pc"), "a.pc: 2 points but 1 normal");
  EXPECT_THAT(error_of("v 1 2\n", ".pc"), HasSubstr("a.pc:1: "));
  EXPECT_THAT(error_of("v 1 2 3\nf 1 2 3\n", ".pc"), HasSubstr("a.pc:2: expected 'v x y z'"));
}

TEST(IoXyz, SixColumnsHaveNormalsAndOthersDoNot) {
  EXPECT_EQ(read("1 2 3 0 0 1\n4 5 6 1 0 0\n", ".xyz").normals.rows(), 2);
  const PolygonSoup coloured = read("2\n1 2 3 117 73 49 255\n4 5 6 91 87 74 255\n", ".xyz");
  EXPECT_EQ(coloured.points.rows(), 2);
  EXPECT_EQ(coloured.normals.rows(), 0);
  // Six columns without a minus sign: colours of bytes or of shares, normals where all are of unit
  // length.
  EXPECT_EQ(read("1 2 3 117 73 49\n4 5 6 255 0 0\n", ".xyz").normals.rows(), 0);
  EXPECT_EQ(read("1 2 3 0.5 0.25 0\n4 5 6 1 0 0\n", ".xyz").normals.rows(), 0);
  EXPECT_EQ(read("1 2 3 0.6 0 0.8\n4 5 6 0 0.8 0.6\n", ".xyz").normals.rows(), 2);
  EXPECT_EQ(read("1 2 3 0 0 -5\n4 5 6 20 0 0\n", ".xyz").normals.rows(), 2);
  EXPECT_EQ(read("1 2 3 0 0 2\n4 5 6 0 0 2\n", ".xyz").normals.rows(), 2);
  EXPECT_THAT(error_of("1 2 3\n1 2 3 4\n", ".xyz"),
              HasSubstr("a.xyz:2: expected 3 columns as in the first row, found 4"));
  EXPECT_THAT(error_of("1 2\n", ".xyz"), HasSubstr("'1 2', has 2 columns; x, y and z are needed"));
  EXPECT_THAT(error_of("1 b 2\n", ".xyz"), HasSubstr("a.xyz:1: expected a number"));
}

TEST(IoXyz, TakesNamesAndWhatSeparatesCells) {
  const MatX3 places = (MatX3(2, 3) << 1, 2, 3, 4, 5, 6).finished();
  const MatX3 normals = (MatX3(2, 3) << 0, 0, 1, 0, 1, 0).finished();
  for (const char* text :
       {"1,2,3,0,0,1\n4,5,6,0,1,0\n", "2\n1; 2; 3; 0; 0; 1\n4; 5; 6; 0; 1; 0\n",
        "x,y,z,nx,ny,nz\n1,2,3,0,0,1\n4,5,6,0,1,0\n", "nz ny z x y nx\n1 0 3 1 2 0\n0 1 6 4 5 0\n",
        "\"id\"\t\"X [m]\"\tY\tZ\tNormal_X\tNormal_Y\tNormal_Z\n"
        "a\t1\t2\t3\t0\t0\t1\nb\t4\t5\t6\t0\t1\t0\n"})
    for (const char* extension : {".xyz", ".asc"}) {
      const PolygonSoup cloud = read(text, extension);
      EXPECT_EQ(cloud.points, places) << text;
      EXPECT_EQ(cloud.normals, normals) << text;
    }
  const PolygonSoup coloured = read("//X Y Z R G B\n1 2 3 0 0 1\n4 5 6 0 1 0\n", ".asc");
  EXPECT_EQ(coloured.points, places);
  EXPECT_EQ(coloured.normals.rows(), 0);
  EXPECT_THAT(error_of("a b c\n1 2 3\n", ".xyz"), HasSubstr("names no columns x, y and z"));
  EXPECT_THAT(error_of("0,5 1,2 3,4\n", ".xyz"), HasSubstr("write a point, not a comma"));
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

/// LZF: at each place the longest copy of what came before, or else bytes as they are.
std::string packed_lzf(const std::string& bytes) {
  std::string out, plain;
  const auto flush = [&] {
    for (std::size_t at = 0; at < plain.size(); at += 32) {
      const std::string piece = plain.substr(at, 32);
      out += static_cast<char>(piece.size() - 1);
      out += piece;
    }
    plain.clear();
  };
  for (std::size_t at = 0; at < bytes.size();) {
    std::size_t best = 0, back = 0;
    for (std::size_t d = 1; d <= std::min<std::size_t>(at, 8192); ++d) {
      std::size_t n = 0;
      while (n < 264 && at + n < bytes.size() && bytes[at + n] == bytes[at + n - d]) ++n;
      if (n > best) best = n, back = d;
    }
    if (best < 3) {
      plain += bytes[at++];
      continue;
    }
    flush();
    const std::size_t length = best - 2, far = back - 1;
    out += static_cast<char>(std::min<std::size_t>(length, 7) << 5 | far >> 8);
    if (length >= 7) out += static_cast<char>(length - 7);
    out += static_cast<char>(far & 255);
    at += best;
  }
  flush();
  return out;
}

std::string with_sizes(const std::string& packed, std::size_t unpacked) {
  std::string out;
  for (const std::size_t size : {packed.size(), unpacked})
    for (int k = 0; k < 4; ++k) out += static_cast<char>(size >> 8 * k & 255);
  return out + packed;
}

TEST(IoPcd, CompressedFieldsFollowEachOther) {
  // 200 points on a line, so that there are copies longer than 8 bytes, and single bytes.
  const int n = 200;
  std::string body;
  const auto add = [&](auto value) {
    body.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  for (int r = 0; r < n; ++r) add(0.1f * static_cast<float>(r));
  for (int r = 0; r < n; ++r) add(2.0f);
  for (int r = 0; r < n; ++r) add(static_cast<float>(r % 3));
  body.append(2 * n, '\xff');
  for (int k = 0; k < 3; ++k)
    for (int r = 0; r < n; ++r) add(k == 1 ? 0.5 * r : 0.0);
  const std::string packed = packed_lzf(body);
  EXPECT_LT(packed.size(), body.size() / 2);
  const std::string file = pcd("binary_compressed\n" + with_sizes(packed, body.size()), n);
  const PolygonSoup cloud = read(file, ".pcd");
  ASSERT_EQ(cloud.points.rows(), n);
  for (int r = 0; r < n; ++r) {
    EXPECT_EQ(Vec3(cloud.points.row(r)), Vec3(0.1f * static_cast<float>(r), 2, r % 3));
    EXPECT_EQ(Vec3(cloud.normals.row(r)), Vec3(0, 0.5 * r, 0));
  }
  EXPECT_THAT(error_of(file.substr(0, file.size() - 1), ".pcd"), HasSubstr("the file ends within"));
  const auto damaged = [&](const std::string& bytes) {
    return error_of(pcd("binary_compressed\n" + with_sizes(bytes, body.size()), n), ".pcd");
  };
  EXPECT_THAT(damaged(packed.substr(0, packed.size() - 1)), HasSubstr("damaged"));
  EXPECT_THAT(damaged(packed + packed), HasSubstr("damaged"));
  EXPECT_THAT(damaged("\x20"), HasSubstr("damaged"));  // the distance is missing
  EXPECT_THAT(damaged(std::string("\x20\x00", 2)), HasSubstr("damaged"));  // nothing came before
  EXPECT_THAT(damaged("\x1f!"), HasSubstr("damaged"));                     // 32 bytes, there is one
}

TEST(IoPcd, SaysWhatIsWrong) {
  EXPECT_THAT(error_of(pcd("ascii\n1 2 3 9 9 0 .5 1\n", 2), ".pcd"), HasSubstr("2 points"));
  EXPECT_THAT(error_of(pcd("binary\nabc", 2000000000), ".pcd"), HasSubstr("promises"));
  EXPECT_THAT(error_of(pcd("gzip\n", 2), ".pcd"), HasSubstr("'gzip' is not known"));
  EXPECT_THAT(error_of(pcd("binary_compressed\n", 2), ".pcd"), HasSubstr("before the sizes"));
  EXPECT_THAT(error_of(pcd("binary_compressed\n" + with_sizes("", 7), 2), ".pcd"),
              HasSubstr("promise 7 bytes, the points take 76"));
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

std::string npy_bytes(const std::string& shape, const std::vector<double>& numbers) {
  std::ostringstream out;
  write_npy_header(out, shape, false);
  for (const double x : numbers) store_little(out, x);
  return out.str();
}

std::string npz_bytes(const std::vector<std::pair<std::string, std::string>>& members) {
  std::ostringstream out;
  write_zip(out, members);
  return out.str();
}

TEST(IoNpyCloud, PointsAloneOrWithNormals) {
  const PolygonSoup plain = read(npy_bytes("2, 3", {1, 2, 3, 4, 5, 6}), ".npy");
  EXPECT_EQ(plain.points, (MatX3(2, 3) << 1, 2, 3, 4, 5, 6).finished());
  EXPECT_EQ(plain.normals.rows(), 0);
  const PolygonSoup both = read(npy_bytes("2, 6", {1, 2, 3, 0, 0, 1, 4, 5, 6, 0, 1, 0}), ".npy");
  EXPECT_EQ(both.points, plain.points);
  EXPECT_EQ(both.normals, (MatX3(2, 3) << 0, 0, 1, 0, 1, 0).finished());
  const PolygonSoup archive =
      read(npz_bytes({{"points.npy", npy_bytes("2, 3", {1, 2, 3, 4, 5, 6})},
                      {"normals.npy", npy_bytes("2, 3", {0, 0, 1, 0, 1, 0})},
                      {"mass.npy", npy_bytes("2,", {7, 8})},
                      {"other.npy", npy_bytes("3,", {7, 8, 9})}}),
           ".npz");
  EXPECT_EQ(archive.points, plain.points);
  EXPECT_EQ(archive.normals, both.normals);
  ASSERT_EQ(archive.scalars.size(), 1u);
  EXPECT_EQ(archive.scalars.at("mass"), Eigen::Vector2d(7, 8));
}

TEST(IoNpyCloud, WhatAFileHoldsDecides) {
  const auto path = std::filesystem::path(testing::TempDir()) / "littoral_held.npy";
  const auto is_cloud = [&](const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
    return holds(path, Kind::cloud) && !holds(path, Kind::volume);
  };
  EXPECT_TRUE(is_cloud(npy_bytes("2, 3", {1, 2, 3, 4, 5, 6})));
  EXPECT_FALSE(is_cloud(npy_bytes("1, 2, 3", {1, 2, 3, 4, 5, 6})));
  std::filesystem::remove(path);
}

TEST(IoNpyCloud, SaysWhatIsWrong) {
  EXPECT_EQ(error_of(npy_bytes("2, 4", {1, 2, 3, 4, 5, 6, 7, 8}), ".npy"),
            "a.npy: points are an array of N x 3, or N x 6 with normals, this one is 2 x 4");
  EXPECT_EQ(error_of(npy_bytes("0, 3", {}), ".npy"), "a.npy: no points");
  EXPECT_THAT(error_of(npy_bytes("900000000000, 3", {1}), ".npy"), HasSubstr("more numbers than"));
  EXPECT_THAT(error_of(npz_bytes({{"points.npy", npy_bytes("2, 3", {1, 2, 3, 4, 5, 6})},
                                  {"normals.npy", npy_bytes("1, 3", {0, 0, 1})}}),
                       ".npz"),
              HasSubstr("1 normals for 2 points"));
  EXPECT_THAT(error_of(npz_bytes({{"x.npy", npy_bytes("2,", {1, 2})}}), ".npz"),
              HasSubstr("no array is points, N x 3; there are: x"));
}

}  // namespace
}  // namespace littoral::io
