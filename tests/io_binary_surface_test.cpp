// STL and OFF, whose bodies may be binary.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

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

std::string binary_stl(const std::string& header, std::uint32_t count, int triangles) {
  std::string bytes = header;
  bytes.resize(80, ' ');
  put<std::uint32_t>(bytes, count, false);
  for (int f = 0; f < triangles; ++f) {
    for (int k = 0; k < 3; ++k) put<float>(bytes, std::numeric_limits<float>::quiet_NaN(), false);
    for (int k = 0; k < 3; ++k) {
      for (int c = 0; c < 3; ++c) put<float>(bytes, static_cast<float>(f + (c == k)), false);
    }
    put<std::uint16_t>(bytes, 0, false);
  }
  return bytes;
}

const std::string facet =
    "facet normal -nan(ind) 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
    "vertex -0 1 0\nendloop\nendfacet\n";

TEST(IoStl, ReadsTextInAnyCaseAndSeveralSolids) {
  const PolygonSoup soup = read("solid facet a\n" + facet + "endsolid facet a\nSOLID\n" +
                                    replaced(facet, "facet", "FACET") + "EndSolid\n",
                                ".STL");
  EXPECT_EQ(soup.n_faces(), 2);
  EXPECT_EQ(soup.n_vertices(), 3) << "corners at one position are merged, also -0 and 0";
}

TEST(IoStl, TheSizeTellsBinaryFromText) {
  for (const char* header : {"", "solid x", "binary"}) {
    const PolygonSoup soup = read(binary_stl(header, 2, 2), ".stl");
    EXPECT_EQ(soup.n_faces(), 2);
    EXPECT_EQ(soup.n_vertices(), 6);
    EXPECT_EQ(soup.points.row(5), Eigen::RowVector3d(1, 1, 2));
  }
  EXPECT_EQ(read(binary_stl("x", 1, 1) + "trailing", ".stl").n_faces(), 1);
}

TEST(IoStl, SaysWhatIsWrong) {
  const auto error = [](const std::string& text) { return error_of(text, ".stl"); };
  EXPECT_EQ(error(""),
            "a.stl: byte 0: the file ends inside the header of a binary STL; the file is empty");
  EXPECT_EQ(error(binary_stl("x", 4294967295u, 80)),
            "a.stl: byte 80: the header says 4294967295 triangles, the data hold 80");
  EXPECT_EQ(error(binary_stl("solid x", 40, 80)),
            "a.stl: byte 80: the header says 40 triangles, the data hold 80");
  EXPECT_EQ(error(binary_stl("x", 2, 2).substr(0, 130)),
            "a.stl: byte 80: the header says 2 triangles, the data hold 0");
  EXPECT_EQ(error(binary_stl("x", 0, 0)), "a.stl: no vertices");
  EXPECT_EQ(error("solid\nendsolid\n"), "a.stl: no vertices");
  EXPECT_EQ(error("solid\n" + replaced(facet, "1 0 0", "1 0 x")),
            "a.stl:5: expected a coordinate, found 'x'");
  EXPECT_EQ(error("solid\n" + replaced(facet, "endloop", "vertex 2 2 2\nendloop")),
            "a.stl:7: expected 'endloop', found 'vertex'");
  EXPECT_EQ(error("solid\n" + facet.substr(0, facet.find("endfacet"))),
            "a.stl:7: the file ends where 'endfacet' is expected");
  EXPECT_EQ(error("solid\n" + facet.substr(0, facet.find(" 0 0\nvertex -0"))),
            "a.stl:5: the file ends inside a vertex");
  EXPECT_EQ(error("solid\nfoo\n"), "a.stl:2: expected 'facet', 'solid' or 'endsolid', found 'foo'");
}

TEST(IoRead, NamesFilesThatCannotBeRead) {
  try {
    read_surface("no/such/file.obj");
    FAIL() << "expected an IoError";
  } catch (const IoError& error) {
    EXPECT_STREQ(error.what(), "cannot read no/such/file.obj: No such file or directory");
  }
  EXPECT_THROW(read_bytes("."), IoError);
}

// A square of two triangles and a quad over it, with everything that a vertex may have.
std::string binary_off(const std::string& magic, bool normals, int others) {
  std::string bytes = magic + " BINARY\n";
  for (const std::int32_t n : {4, 2, 0}) put(bytes, n, true);
  for (int v = 0; v < 4; ++v) {
    for (const float x : {0.5F * static_cast<float>(v), 2.0F, -1.0F}) put(bytes, x, true);
    for (int k = 0; k < 3 && normals; ++k) put(bytes, static_cast<float>(k), true);
    for (int k = 0; k < others; ++k) put(bytes, 99.0F, true);
  }
  for (const std::int32_t n : {3, 0, 1, 2, 0}) put(bytes, n, true);
  for (const std::int32_t n : {4, 0, 1, 2, 3, 1}) put(bytes, n, true);
  put(bytes, 0.25F, true);
  return bytes;
}

TEST(IoOff, BinaryFiles) {
  for (const auto& [magic, normals, others] :
       {std::tuple("OFF", false, 0), {"NOFF", true, 0}, {"STCNOFF", true, 6}, {"COFF", false, 4}}) {
    const PolygonSoup soup = read(binary_off(magic, normals, others), ".off");
    EXPECT_EQ(soup.corners, (std::vector<int>{0, 1, 2, 0, 1, 2, 3})) << magic;
    EXPECT_EQ(soup.points.row(3), Eigen::RowVector3d(1.5, 2, -1)) << magic;
    EXPECT_EQ(soup.normals.rows(), normals ? 4 : 0);
    if (normals) {
      EXPECT_EQ(soup.normals.row(2), Eigen::RowVector3d(0, 1, 2));
    }
  }
  const std::string whole = binary_off("OFF", false, 0);
  for (std::size_t cut = 0; cut < whole.size(); ++cut)
    EXPECT_NE(error_of(whole.substr(0, cut), ".off"), "no error") << cut;
  const auto changed = [&](std::size_t at, std::int32_t number) {
    std::string bytes = whole.substr(0, at);
    put(bytes, number, true);
    return error_of(bytes + whole.substr(at + 4), ".off");
  };
  const std::size_t counts = 11, faces = counts + 12 + 48;
  EXPECT_THAT(changed(counts, -4), HasSubstr("negative number of vertices"));
  EXPECT_THAT(changed(counts, 0), HasSubstr("no vertices"));
  EXPECT_THAT(changed(counts, 2000000000), HasSubstr("promises 2000000000 vertices"));
  EXPECT_THAT(changed(counts + 4, 2000000000), HasSubstr("promises 2000000000 faces"));
  EXPECT_THAT(changed(faces, 2), HasSubstr("face 0 has 2 corners"));
  EXPECT_THAT(changed(faces + 8, 4), HasSubstr("face 0 refers to vertex 4, the file has 4"));
  EXPECT_THAT(changed(faces + 16, 2000000000), HasSubstr("face 0 has a colour of 2000000000"));
}

// The same square as pmp-library writes it, in the older versions with the lowest byte first.
std::string plain_binary_off(bool big) {
  std::string bytes = "OFF BINARY\n";
  for (const std::int32_t n : {4, 2, 0}) put(bytes, n, big);
  for (int v = 0; v < 4; ++v)
    for (const float x : {0.5F * static_cast<float>(v), 2.0F, -1.0F}) put(bytes, x, big);
  for (const std::int32_t n : {3, 0, 1, 2, 4, 0, 1, 2, 3}) put(bytes, n, big);
  return bytes;
}

TEST(IoOff, BinaryFilesWithoutColoursInBothByteOrders) {
  for (const bool big : {true, false}) {
    const std::string whole = plain_binary_off(big);
    const PolygonSoup soup = read(whole, ".off");
    EXPECT_EQ(soup.corners, (std::vector<int>{0, 1, 2, 0, 1, 2, 3})) << big;
    EXPECT_EQ(soup.face_offsets, (std::vector<int>{0, 3, 7})) << big;
    EXPECT_EQ(soup.points.row(3), Eigen::RowVector3d(1.5, 2, -1)) << big;
    for (std::size_t cut = 0; cut < whole.size(); ++cut)
      EXPECT_NE(error_of(whole.substr(0, cut), ".off"), "no error") << cut;
    std::string bytes = whole.substr(0, whole.size() - 4);
    put(bytes, 4, big);
    EXPECT_THAT(error_of(bytes, ".off"), HasSubstr("face 1 refers to vertex 4, the file has 4"));
  }
  // Counts that fit in neither order are those of the format's.
  std::string bytes = plain_binary_off(false).substr(0, 15);
  put(bytes, 99, false);
  EXPECT_THAT(error_of(bytes + plain_binary_off(false).substr(19), ".off"),
              HasSubstr("promises 67108864 vertices"));
}

}  // namespace
}  // namespace littoral::io
