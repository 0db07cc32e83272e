// PLY, whose bodies may be binary.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "io/read.h"
#include "littoral/error.h"
#include "surface_bytes.h"

namespace littoral::io {
namespace {

using test::error_of;
using test::put;
using test::read;
using test::replaced;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::string triangle_header =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
    "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
const std::string triangle_body = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

// Every scalar type as a vertex property before x, and every integer type in the face list.
template <class Count, class Index>
void check_types(const char* count, const char* index, bool big) {
  std::string bytes = std::string("ply\nformat binary_") + (big ? "big" : "little") +
                      "_endian 1.0\nelement face 1\nproperty int8 flag\nproperty list " + count +
                      " " + index +
                      " vertex_index\nelement odd 2\nproperty list ushort double l\n"
                      "element vertex 3\nproperty char a\nproperty uint8 b\nproperty short c\n"
                      "property uint16 d\nproperty int32 e\nproperty uint f\n"
                      "property float32 quality\nproperty list uchar float m\n"
                      "property float64 z\nproperty double y\nproperty float x\nend_header\n";
  put<std::int8_t>(bytes, 7, big);
  put<Count>(bytes, 3, big);
  for (int v : {2, 0, 1}) put<Index>(bytes, static_cast<Index>(v), big);
  put<std::uint16_t>(bytes, 2, big);
  put<double>(bytes, 1, big);
  put<double>(bytes, 2, big);
  put<std::uint16_t>(bytes, 0, big);
  for (int v = 0; v < 3; ++v) {
    put<std::int8_t>(bytes, -1, big);
    put<std::uint8_t>(bytes, 255, big);
    put<std::int16_t>(bytes, -2, big);
    put<std::uint16_t>(bytes, 65535, big);
    put<std::int32_t>(bytes, -3, big);
    put<std::uint32_t>(bytes, 4294967295u, big);
    put<float>(bytes, .5f * static_cast<float>(v), big);
    put<std::uint8_t>(bytes, 1, big);
    put<float>(bytes, 1, big);
    put<double>(bytes, v + .3, big);
    put<double>(bytes, v + .2, big);
    put<float>(bytes, static_cast<float>(v) + .125f, big);
  }
  const PolygonSoup soup = read(bytes, ".ply");
  ASSERT_EQ(soup.n_vertices(), 3);
  EXPECT_EQ(soup.points.row(2), Eigen::RowVector3d(2.125, 2.2, 2.3));
  ASSERT_EQ(soup.n_faces(), 1);
  EXPECT_THAT(soup.corners, ElementsAre(2, 0, 1));
  ASSERT_EQ(soup.scalars.size(), 1u) << "integer properties are not kept";
  EXPECT_THAT(soup.scalars.at("quality"), ElementsAre(0, .5, 1));
}

TEST(IoPly, ReadsEveryTypeInBothByteOrders) {
  for (bool big : {false, true}) {
    check_types<std::uint8_t, std::int32_t>("uchar", "int", big);
    check_types<std::int8_t, std::uint8_t>("int8", "uint8", big);
    check_types<std::uint16_t, std::int16_t>("ushort", "short", big);
    check_types<std::int16_t, std::uint16_t>("int16", "uint16", big);
    check_types<std::int32_t, std::uint32_t>("int", "uint32", big);
    check_types<std::uint32_t, std::int8_t>("uint", "char", big);
  }
}

// Rows of one size are read side by side, in pieces of 16,384.
TEST(IoPly, ReadsManyTrianglesWithOthersAmongThem) {
  constexpr int n = 40'000, faces = 50'000, last = n - 1;
  struct Case {
    int quad, wrong;  // numbers of faces
    std::size_t cut;  // bytes that the end lacks
    const char* error;
  };
  for (const Case& c :
       {Case{-1, -1, 0, ""}, Case{20'000, -1, 0, ""}, Case{faces - 1, -1, 0, ""},
        Case{-1, 40'001, 0, "face 40001 refers to vertex 40000, the file has 40000"},
        Case{100, 17'000, 0, "face 17000 refers to vertex 40000"},
        Case{-1, -1, 1, "the file ends after 49999 of 50000 of element 'face'"}})
    for (const bool big : {false, true}) {
      std::string bytes = std::string("ply\nformat binary_") + (big ? "big" : "little") +
                          "_endian 1.0\nelement vertex 40000\nproperty float x\nproperty float y\n"
                          "property float z\nproperty double height\nelement face 50000\n"
                          "property list uchar int vertex_indices\nend_header\n";
      std::vector<int> corners, offsets{0};
      for (int v = 0; v < n; ++v) {
        for (int k = 0; k < 3; ++k) put<float>(bytes, static_cast<float>(3 * v + k), big);
        put<double>(bytes, .5 * v, big);
      }
      for (int f = 0; f < faces; ++f) {
        const int size = f == c.quad ? 4 : 3;
        put<std::uint8_t>(bytes, static_cast<std::uint8_t>(size), big);
        for (int k = 0; k < size; ++k) {
          corners.push_back((7 * f + k) % n);
          put<std::int32_t>(bytes, f == c.wrong ? n : corners.back(), big);
        }
        offsets.push_back(static_cast<int>(corners.size()));
      }
      bytes.resize(bytes.size() - c.cut);
      if (*c.error != 0) {
        EXPECT_THAT(error_of(bytes, ".ply"), HasSubstr(c.error));
        continue;
      }
      const PolygonSoup soup = read(bytes, ".ply");
      EXPECT_EQ(soup.corners, corners);
      EXPECT_EQ(soup.face_offsets, offsets);
      EXPECT_EQ(soup.points.row(last), Eigen::RowVector3d(3 * last, 3 * last + 1, 3 * last + 2));
      EXPECT_EQ(soup.scalars.at("height")[20'001], .5 * 20'001);
    }
}

TEST(IoPly, ReadsTextWithNormalsScalarsAndEdges) {
  const PolygonSoup soup = read(
      "ply\nformat ascii 1.0\ncomment end_header\nobj_info x\nelement vertex 4\n"
      "property float x\nproperty float y\nproperty float z\nproperty float nx\n"
      "property float ny\nproperty float nz\nproperty uchar red\nproperty double distance\n"
      "element edge 4\nproperty int vertex1\nproperty int vertex2\nend_header\n"
      "0 0 0 0 0 1 255 inf\n1 0 0 0 0 2 255 .5\n1 1 0 0 0 3 255 1\n0 1 0 0 0 4 255 2\n"
      "0 1\n1 2\n3 2\n2 0",
      ".ply");
  ASSERT_EQ(soup.normals.rows(), 4);
  EXPECT_EQ(soup.normals(3, 2), 4);
  ASSERT_EQ(soup.scalars.size(), 1u);
  EXPECT_EQ(soup.scalars.at("distance")(0), std::numeric_limits<double>::infinity());
  EXPECT_THAT(soup.lines, ElementsAre(ElementsAre(0, 1, 2), ElementsAre(3, 2, 0)));
}

// A strip of four triangles, the second of which is none; one of two vertices; one triangle.
TEST(IoPly, TriangleStripsBecomeTheirTriangles) {
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 5\nproperty uchar x\nproperty uchar y\n"
      "property uchar z\nelement tristrips 2\nproperty list int int vertex_indices\nend_header\n";
  const std::vector<std::vector<int>> lists{{0, 1, 2, 1, 3, 4, -1, 0, 1}, {4, 3, 2, -1}};
  const auto triangles = ElementsAre(0, 1, 2, 2, 1, 3, 1, 4, 3, 4, 3, 2);
  std::string text = header;
  for (int i = 0; i < 5; ++i) text += "0 1 " + std::to_string(i) + "\n";
  for (const auto& list : lists) {
    text += std::to_string(list.size());
    for (int v : list) text += " " + std::to_string(v);
    text += "\n";
  }
  EXPECT_THAT(read(text, ".ply").corners, triangles);
  for (const bool big : {false, true}) {
    std::string bytes =
        replaced(header, "ascii", big ? "binary_big_endian" : "binary_little_endian");
    for (int i = 0; i < 5; ++i) bytes += {0, 1, static_cast<char>(i)};
    for (const auto& list : lists) {
      put(bytes, static_cast<std::int32_t>(list.size()), big);
      for (const std::int32_t v : list) put(bytes, v, big);
    }
    const PolygonSoup soup = read(bytes, ".ply");
    EXPECT_THAT(soup.corners, triangles);
    EXPECT_THAT(soup.face_offsets, ElementsAre(0, 3, 6, 9, 12));
  }
}

TEST(IoPly, HeaderMayEndItsLinesInAnyWay) {
  const std::string plain = triangle_header + triangle_body;
  for (const char* end : {"\r\n", "\r"}) {
    std::string text;
    for (char c : plain) text += c == '\n' ? std::string(end) : std::string(1, c);
    EXPECT_EQ(read(text, ".ply").n_faces(), 1);
  }
  // With CR alone the first byte of the data may be a LF.
  std::string mac =
      "ply\rformat binary_little_endian 1.0\relement vertex 1\rproperty uchar x\r"
      "property uchar y\rproperty uchar z\rend_header\r\n\x01\x02";
  EXPECT_EQ(read(mac, ".ply").points.row(0), Eigen::RowVector3d(10, 1, 2));
}

TEST(IoPly, SaysWhatIsWrong) {
  const auto error = [](const std::string& text) { return error_of(text, ".ply"); };
  const std::string all = triangle_header + triangle_body;
  EXPECT_EQ(error(""), "a.ply: the file is empty");
  EXPECT_EQ(error("plx\n"), "a.ply:1: expected the word 'ply'");
  EXPECT_EQ(error("ply\nformat ascii 1.0\nelement vertex 42\nproper"),
            "a.ply:4: the file ends inside the header");
  EXPECT_EQ(error(replaced(all, "format ascii", "format utf8")), "a.ply:2: unknown format 'utf8'");
  EXPECT_EQ(error(replaced(all, "format ascii 1.0", "comment")),
            "a.ply:9: the header has no format line");
  EXPECT_EQ(error(replaced(all, "float x", "half x")), "a.ply:4: unknown type 'half'");
  EXPECT_EQ(error(replaced(all, "vertex 3", "vertex -1")), "a.ply:3: expected a count, found '-1'");
  EXPECT_EQ(error(replaced(all, "vertex 3", "vertex 4294967295")),
            "a.ply: the header promises 4294967295 of element 'vertex', 26 bytes follow it");
  EXPECT_EQ(error(replaced(all, "vertex 3", "vertex 0")), "a.ply: no vertices");
  EXPECT_EQ(error(replaced(all, "element vertex", "element vertex 0\nelement vertex")),
            "a.ply:4: element 'vertex' appears twice");
  EXPECT_EQ(error(replaced(all, "element vertex", "format ascii 1.0\nelement vertex")),
            "a.ply:3: the format is given twice");
  EXPECT_EQ(error("ply\nformat ascii 1.0\nend_header\n"), "a.ply: no vertices");
  EXPECT_EQ(error(replaced(all, "float y", "float why")),
            "a.ply:10: element 'vertex' has no property 'y'");
  EXPECT_EQ(error("ply\nformat ascii 1.0\nelement vertex 9\nend_header\n"),
            "a.ply:5: element 'vertex' has no property 'x'");
  EXPECT_EQ(error(replaced(all, "vertex_indices", "corners")),
            "a.ply:12: element 'face' has no list 'vertex_indices'");
  EXPECT_EQ(error(replaced(all, "list uchar", "list float")),
            "a.ply:8: the length of a list must be an integer");
  EXPECT_EQ(error(replaced(all, "element vertex 3", "what 3")),
            "a.ply:3: unknown header line 'what'");
  EXPECT_EQ(error(replaced(all, "1 2\n", "1 9\n")),
            "a.ply:13: face 0 refers to vertex 9, the file has 3 (counted from 0)");
  EXPECT_EQ(error(replaced(all, "1 2\n", "1 0.5\n")),
            "a.ply:13: face 0 refers to vertex 0.500000, the file has 3 (counted from 0)");
  EXPECT_EQ(error(replaced(all, "3 0 1 2\n", "2 0 1\n")),
            "a.ply:13: face 0 has 2 corners, at least 3 are needed");
  EXPECT_EQ(error(replaced(all, "3 0 1 2\n", "900 0 1 2\n")),
            "a.ply:13: a list of 900 items, the file is shorter");
  EXPECT_EQ(error(replaced(all, "3 0 1 2\n", "-1\n")),
            "a.ply:13: a list with a length that is not a whole number");
  EXPECT_EQ(error(replaced(all, "3 0 1 2\n", "")),
            "a.ply:12: the file ends after 0 of 1 of element 'face'");
  EXPECT_EQ(error(replaced(all, "3 0 1 2\n", "3 0 1\n")),
            "a.ply:13: expected a number, found the end of the line");
  EXPECT_EQ(error(replaced(all, "0 1 0\n", "0 1 0 7\n")),
            "a.ply:12: unexpected '7' at the end of the line");
  const std::string strips = replaced(all, "element face 1", "element tristrips 1");
  EXPECT_EQ(error(replaced(strips, "vertex_indices", "corners")),
            "a.ply:12: element 'tristrips' has no list 'vertex_indices'");
  EXPECT_EQ(error(replaced(strips, "3 0 1 2\n", "8 0 1 2 -1 0 1 3 -1\n")),
            "a.ply:13: strip 1 refers to vertex 3, the file has 3 (counted from 0)");
  EXPECT_EQ(error(replaced(strips, "3 0 1 2\n", "3 0 1 -2\n")),
            "a.ply:13: strip 0 refers to vertex -2, the file has 3 (counted from 0)");

  std::string binary = replaced(triangle_header, "ascii", "binary_little_endian");
  for (int i = 0; i < 9; ++i) put<float>(binary, static_cast<float>(i), false);
  const std::string at = std::to_string(binary.size());
  EXPECT_EQ(error(binary), "a.ply: byte " + at + ": the file ends after 0 of 1 of element 'face'");
  put<std::uint8_t>(binary, 3, false);
  EXPECT_THAT(error(binary), HasSubstr(": a list of 3 items, the file is shorter"));
  for (int v : {0, 1, 7}) put<std::int32_t>(binary, v, false);
  EXPECT_EQ(error(binary), "a.ply: byte " + std::to_string(binary.size()) +
                               ": face 0 refers to vertex 7, the file has 3 (counted from 0)");
}

}  // namespace
}  // namespace littoral::io
