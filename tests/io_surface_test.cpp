// Surface readers: what each format may look like, and what is said about files that are wrong.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "io/read.h"
#include "littoral/error.h"
#include "surface_bytes.h"

namespace littoral::io {
namespace {

using test::error_of;
using test::read;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::vector<int> corners(const PolygonSoup& soup, int f) {
  return {soup.face(f).begin(), soup.face(f).end()};
}

const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

TEST(IoObj, ReadsEverySpellingOfAFace) {
  for (const char* face : {"f 1 2 3 4", "f 1/1 2/1 3/1 4/1", "f 1//1 2//1 3//1 4//1",
                           "f 1/1/1 2/1/1 3/1/1 4/1/1", "f -4 -3 -2 -1", "f -4/-1/-1 2 -2// 4/",
                           "f \t1  2\\\n 3 4 # end", "f 1 2 3 4\r\ng x\r\n", "f +1 2 3 4\ro a"}) {
    const PolygonSoup soup = read("vt 0 0\nvn 0 0 1\n" + square + face, ".obj");
    ASSERT_EQ(soup.n_faces(), 1) << face;
    EXPECT_THAT(corners(soup, 0), ElementsAre(0, 1, 2, 3)) << face;
  }
}

TEST(IoObj, ReadsEverySpellingOfANumber) {
  const PolygonSoup soup =
      read("\xEF\xBB\xBFv +1 -.5 0.\nv 1.E+0 1e-0 1E2 .3\nv nan -inf 1e-400\n", ".obj");
  ASSERT_EQ(soup.n_vertices(), 3);
  EXPECT_EQ(soup.points.row(0), Eigen::RowVector3d(1, -.5, 0));
  EXPECT_EQ(soup.points.row(1), Eigen::RowVector3d(1, 1, 100));
  EXPECT_TRUE(std::isnan(soup.points(2, 0)));
  EXPECT_EQ(soup.points(2, 1), -std::numeric_limits<double>::infinity());
  EXPECT_EQ(soup.points(2, 2), 0);
  const PolygonSoup windows = read("v 1.#IND -1.#INF 1.#QNAN00 # c\n", ".obj");
  EXPECT_TRUE(std::isnan(windows.points(0, 0)) && std::isnan(windows.points(0, 2)));
  EXPECT_EQ(windows.points(0, 1), -std::numeric_limits<double>::infinity());
  const std::string tiny = "0." + std::string(400, '0') + "1";
  EXPECT_EQ(read("v -" + tiny + " 0 0", ".obj").points(0, 0), 0);
}

TEST(IoObj, KeepsLinesAsWrittenAndIgnoresUnknownRecords) {
  const PolygonSoup soup =
      read("foo 1\n" + square + "l 1 2/3 -1\np 1\nl 3 4\nusemtl m#1\n", ".obj");
  EXPECT_THAT(soup.lines, ElementsAre(ElementsAre(0, 1, 3), ElementsAre(2, 3)));
  EXPECT_EQ(soup.n_faces(), 0);
}

TEST(IoObj, FacesMayComeBeforeTheirVertices) {
  EXPECT_THAT(corners(read("f 1 2 3\n" + square, ".obj"), 0), ElementsAre(0, 1, 2));
}

TEST(IoObj, ABackslashInACommentContinuesNothing) {
  EXPECT_EQ(read("# C:\\\n" + square, ".obj").n_vertices(), 4);
}

TEST(IoObj, KeepsNormalsAndTextureWhereEachVertexHasOne) {
  const std::string attributes = "vn 0 0 1\nvn 0 1 0\nvt .25 9\nvt .5 9\nvt .25 8\n";
  const PolygonSoup one =
      read(square + attributes + "f 1/1/1 2/2/2 3/2/1\nf 1/3/1 3/2/1 4/1/1\n", ".obj");
  ASSERT_EQ(one.normals.rows(), 4);
  EXPECT_EQ(one.normals.row(1), Eigen::RowVector3d(0, 1, 0));
  ASSERT_EQ(one.scalars.count("u"), 1u);  // vertex 1 has two texture points with the same u
  EXPECT_THAT(one.scalars.at("u"), ElementsAre(.25, .5, .5, .25));

  const PolygonSoup seam =
      read(square + attributes + "f 1/1/1 2/2/2 3/2/1\nf 1/2/2 3/2/1 4/1/1\n", ".obj");
  EXPECT_EQ(seam.normals.rows(), 0);
  EXPECT_TRUE(seam.scalars.empty());

  const PolygonSoup partial = read(square + attributes + "f 1/1/1 2/2/2 3/2/1\n", ".obj");
  EXPECT_EQ(partial.normals.rows(), 0) << "vertex 4 has no normal";

  const PolygonSoup cloud = read("vn 0 0 1\nv 0 0 0\nvn 0 1 0\nv 1 0 0\n", ".obj");
  ASSERT_EQ(cloud.normals.rows(), 2);
  EXPECT_EQ(cloud.normals.row(1), Eigen::RowVector3d(0, 1, 0));

  EXPECT_EQ(read(square + "f 1/7/7 2/7/7 3/7/7\n", ".obj").n_faces(), 1) << "stripped textures";
}

TEST(IoObj, SaysWhatIsWrong) {
  const auto error = [](const std::string& text) { return error_of(square + text, ".obj"); };
  EXPECT_EQ(error("f 1 2 99999\n"), "a.obj:5: face refers to vertex 99999, the file has 4");
  EXPECT_EQ(error("l 1 5\n"), "a.obj:5: line refers to vertex 5, the file has 4");
  EXPECT_EQ(error("\nf 0 1 2\n"), "a.obj:6: face refers to vertex 0, but OBJ counts from 1");
  EXPECT_EQ(error("f 1 2 -5\n"), "a.obj:5: face refers to vertex -5, only 4 come before it");
  EXPECT_EQ(error("f 1 2 3.5\n"), "a.obj:5: expected a vertex index, found '3.5'");
  EXPECT_EQ(error("f 1 2 99999999999999999999\n"),
            "a.obj:5: expected a vertex index, found '99999999999999999999'");
  EXPECT_EQ(error("f 1 2 4294967297\n"),
            "a.obj:5: face refers to vertex 4294967297, which is out of range");
  EXPECT_EQ(error("f 1 2/x 3\n"), "a.obj:5: expected a texture index, found 'x'");
  EXPECT_EQ(error("f 1 2\n"), "a.obj:5: face has 2 corners, at least 3 are needed");
  EXPECT_EQ(error("f\n"), "a.obj:5: face has 0 corners, at least 3 are needed");
  EXPECT_EQ(error("l 1\n"), "a.obj:5: line has 1 vertex, at least 2 are needed");
  EXPECT_EQ(error("v 1 x 2\n"), "a.obj:5: expected a coordinate, found 'x'");
  EXPECT_EQ(error("v 1 2\n"), "a.obj:5: expected a coordinate, found the end of the line");
  EXPECT_EQ(error("v 1,5 2,5 3\n"),
            "a.obj:5: expected a coordinate, found '1,5'; write a point, not a comma, before the "
            "decimals");
  EXPECT_EQ(error("v 1e400 0 0\n"), "a.obj:5: expected a coordinate, found '1e400'");
  EXPECT_EQ(error("v 0x1p1 0 0\n"), "a.obj:5: expected a coordinate, found '0x1p1'");
  EXPECT_EQ(error(std::string("v 1 2\0 3\n", 9)), "a.obj:5: NUL byte in a text file");
  EXPECT_EQ(error(std::string("# \0\nv 1 x 2\n", 12)), "a.obj:6: expected a coordinate, found 'x'");
  EXPECT_EQ(error_of("", ".obj"), "a.obj: no vertices; the file is empty");
  EXPECT_EQ(error_of("f 1 2 3\n", ".obj"), "a.obj: no vertices");
  EXPECT_EQ(error_of("\xFF\xFEv", ".obj"),
            "a.obj:1: the text is UTF-16; save it as UTF-8 or ASCII");
  EXPECT_EQ(
      error_of(square, ".xyz9"),
      "a.xyz9: cannot be read as a surface or cloud: the extension is '.xyz9'; possible: .obj .ply "
      ".off .stl .glb .gltf .3mf .pc .xyz .asc .pcd .npy .npz .mesh .vtk .msh .vtu .vtp");
}

const std::string off_body = "0 0 0\n1 0 0\n0 1 0\n";

TEST(IoOff, ReadsEveryHeader) {
  for (const char* header : {"OFF\n3 1 0\n", "OFF 3 1 0\n", "3 1\n", "OFF3 1 3 # c\n",
                             "off\r3 1 0\r", "# c\n\nOFF # d\n\n3 1 0\n", "STCOFF\r\n3 1 0\r\n"}) {
    const PolygonSoup soup = read(header + off_body + "3 0 1 2 255 0 0\n", ".off");
    EXPECT_EQ(soup.n_vertices(), 3) << header;
    ASSERT_EQ(soup.n_faces(), 1) << header;
    EXPECT_THAT(corners(soup, 0), ElementsAre(0, 1, 2)) << header;
  }
  const PolygonSoup normals = read("CNOFF\n1 0 0\n1 2 3 4 5 6 .1 .2 .3 1\n", ".off");
  ASSERT_EQ(normals.normals.rows(), 1);
  EXPECT_EQ(normals.normals.row(0), Eigen::RowVector3d(4, 5, 6));
}

TEST(IoOff, NumbersOfAVertexOrFaceMayStandOnSeveralLines) {
  const std::string points = "0 0\n0 # x y, z\n\n1\n0\n0\n0 1 0 255 0 0\n0 0 1\n";
  const PolygonSoup soup =
      read("OFF\n4\n3\n6\n" + points + "4 0\n1\n2 \n# c\n3\n3 2 1 0 255 0 0\n3\n0 1 3", ".off");
  ASSERT_EQ(soup.n_vertices(), 4);
  EXPECT_EQ(soup.points, (MatX3(4, 3) << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1).finished());
  ASSERT_EQ(soup.n_faces(), 3);
  EXPECT_THAT(corners(soup, 0), ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(corners(soup, 1), ElementsAre(2, 1, 0)) << "a colour behind a whole face";
  EXPECT_THAT(corners(soup, 2), ElementsAre(0, 1, 3));
  const PolygonSoup normals = read("NOFF\n1 0 0\n1 2 3\n4 5\n6\n", ".off");
  EXPECT_EQ(normals.normals.row(0), Eigen::RowVector3d(4, 5, 6));
}

TEST(IoOff, ALineThatLacksANumberTakesNoneFromAWholeOne) {
  const auto error = [](const std::string& text) { return error_of(text, ".off"); };
  EXPECT_EQ(error("OFF\n3 2 0\n" + off_body + "3 0 1\n3 0 1 2\n"),
            "a.off:6: expected a vertex index, found the end of the line");
  EXPECT_EQ(error("OFF\n3 1 0\n0 0\n1 0 0\n0 1 0\n3 0 1 2\n"),
            "a.off:3: expected a coordinate, found the end of the line");
  EXPECT_EQ(error("OFF\n3\n" + off_body + "3 0 1 2\n"),
            "a.off:2: expected the number of faces, found the end of the line");
  EXPECT_EQ(error("OFF\n3 1 0\n" + off_body + "3 0\n1\n"),
            "a.off:6: expected a vertex index, found the end of the line");
  EXPECT_EQ(error("OFF\n3 1 0\n" + off_body + "3 0\n1\n\n3\n"),
            "a.off:9: face refers to vertex 3, the file has 3 (counted from 0)");
  EXPECT_EQ(error("OFF\n3 1 0\n" + off_body + "3 0\nx\n2\n"),
            "a.off:7: expected a vertex index, found 'x'");
}

TEST(IoOff, SaysWhatIsWrong) {
  const auto error = [](const std::string& text) { return error_of(text, ".off"); };
  EXPECT_EQ(error(""), "a.off:1: the file is empty");
  EXPECT_EQ(error("OFF\n"), "a.off:1: the file ends before the counts of vertices and faces");
  EXPECT_EQ(error("FOO\n3 1 0\n"), "a.off:1: expected OFF or the number of vertices, found 'FOO'");
  EXPECT_EQ(error("OFF\n42000000000 1 0\n" + off_body),
            "a.off:2: the header promises 42000000000 vertices, the file has 38 bytes");
  EXPECT_EQ(error("OFF\n-1 1 0\n"), "a.off:2: negative number of vertices");
  EXPECT_EQ(error("OFF\n0 0 0\n"), "a.off: no vertices");
  EXPECT_EQ(error("OFF\n4 1 0\n" + off_body), "a.off:5: the file ends after 3 of 4 vertices");
  EXPECT_EQ(error("OFF\n3 2 0\n" + off_body + "3 0 1 2\n"),
            "a.off:6: the file ends after 1 of 2 faces");
  EXPECT_EQ(error("OFF\n3 1 0\n" + off_body + "3 0 1 3\n"),
            "a.off:6: face refers to vertex 3, the file has 3 (counted from 0)");
  EXPECT_EQ(error("OFF\n3 1 0\n" + off_body + "2 0 1\n"),
            "a.off:6: face has 2 corners, at least 3 are needed");
  EXPECT_EQ(error("OFF\n3 1 0\n" + off_body + "3 0 1\n"),
            "a.off:6: expected a vertex index, found the end of the line");
  EXPECT_EQ(error("4OFF\n3 1 0\n"), "a.off:1: 4OFF (four coordinates) is not supported");
  EXPECT_EQ(error("nOFF\n3\n3 1 0\n"), "a.off:1: nOFF (any dimension) is not supported");
  EXPECT_EQ(error("OFF BINARY\n"), "a.off: byte 11: the file ends within the header");
}

}  // namespace
}  // namespace littoral::io
