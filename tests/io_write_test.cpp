// Writers: what is written reads back as it was, and nothing half-written is left behind.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <limits>

#include "base/parallel.h"
#include "comma_locale.h"
#include "constants.h"
#include "io/binary.h"
#include "io/read.h"
#include "io/write.h"
#include "littoral/error.h"
#include "space_helpers.h"
#include "test_meshes.h"

namespace littoral::io {
namespace {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

using test::infinity;

class IoWrite : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() / (std::string("littoral_write_") + test->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  int n_files() const {
    return static_cast<int>(std::distance(fs::directory_iterator(folder_), {}));
  }
  fs::path folder_;
};

// A triangle, a quad and a face of 300 corners with numbers that need all digits.
PolygonSoup polygons() {
  PolygonSoup soup;
  soup.points.resize(300, 3);
  for (int v = 0; v < 300; ++v) soup.points.row(v) << v / 3.0, -1e-310 * v, 1e300 / (v + 1);
  soup.normals = soup.points / 7.0;
  soup.add_face(std::vector<int>{0, 1, 2});
  soup.add_face(std::vector<int>{5, 4, 3, 2});
  std::vector<int> all(300);
  for (int v = 0; v < 300; ++v) all[v] = v;
  soup.add_face(all);
  soup.lines = {{0, 1, 2}, {2, 3}, {7, 7, 9}};
  VecX distance = soup.points.col(0).array().sin();
  distance(3) = infinity;
  soup.scalars = {{"distance", distance}, {"winding", 2 * distance}};
  return soup;
}

void expect_same_faces(const PolygonSoup& a, const PolygonSoup& b) {
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.face_offsets, b.face_offsets);
  EXPECT_EQ(a.corners, b.corners);
}

TEST_F(IoWrite, PlyKeepsEverything) {
  const PolygonSoup soup = polygons();
  write_surface(folder_ / "a.ply", soup);
  const PolygonSoup back = read_surface(folder_ / "a.ply");
  expect_same_faces(soup, back);
  EXPECT_EQ(soup.normals, back.normals);
  EXPECT_EQ(soup.lines, back.lines);
  EXPECT_EQ(soup.scalars, back.scalars);
  EXPECT_EQ(n_files(), 1);
}

// Many records are written at once, and these are more.
TEST_F(IoWrite, PlyAndStlOfManyFacesKeepEverything) {
  PolygonSoup soup = test::grid_soup(260, 130);
  soup.scalars["distance"] = soup.points.col(0).array().sin();
  write_surface(folder_ / "a.stl", soup);
  const PolygonSoup stl = read_surface(folder_ / "a.stl");
  ASSERT_EQ(stl.corners.size(), soup.corners.size());
  for (std::size_t c = 0; c < soup.corners.size(); ++c)
    ASSERT_EQ(stl.points.row(stl.corners[c]),
              soup.points.row(soup.corners[c]).cast<float>().cast<double>());
  for (int f = 0; f < 20000; ++f) soup.add_face(std::vector<int>{f, f + 1, f + 3, f + 2});
  write_surface(folder_ / "a.ply", soup, "distance");
  const PolygonSoup back = read_surface(folder_ / "a.ply");
  expect_same_faces(soup, back);
  EXPECT_EQ(back.scalars.at("distance"), soup.scalars.at("distance"));
}

TEST_F(IoWrite, ObjKeepsTheFieldAsU) {
  const PolygonSoup soup = polygons();
  write_surface(folder_ / "a.OBJ", soup, "winding");
  PolygonSoup back = read_surface(folder_ / "a.OBJ");
  expect_same_faces(soup, back);
  EXPECT_EQ(soup.normals, back.normals);
  EXPECT_EQ(soup.lines, back.lines);
  EXPECT_EQ(soup.scalars.at("winding"), back.scalars.at("u"));

  PolygonSoup bare = soup;
  bare.normals.resize(0, 3);
  write_surface(folder_ / "b.obj", bare, "none");
  back = read_surface(folder_ / "b.obj");
  expect_same_faces(soup, back);
  EXPECT_EQ(back.normals.rows(), 0);
  EXPECT_TRUE(back.scalars.empty());
  bare.normals = soup.normals;
  write_surface(folder_ / "b.obj", bare, "none");
  EXPECT_EQ(read_surface(folder_ / "b.obj").normals, soup.normals);
}

TEST_F(IoWrite, OffKeepsFacesAndNormals) {
  PolygonSoup soup = polygons();
  write_surface(folder_ / "a.off", soup);
  expect_same_faces(soup, read_surface(folder_ / "a.off"));
  EXPECT_EQ(read_surface(folder_ / "a.off").normals, soup.normals);
  soup.normals.resize(0, 3);
  write_surface(folder_ / "a.off", soup);
  expect_same_faces(soup, read_surface(folder_ / "a.off"));
}

TEST_F(IoWrite, StlKeepsTriangles) {
  PolygonSoup soup;
  soup.points.resize(4, 3);
  soup.points << 0, 0, 0, 1e30f, 0, 0, 0, .1f, 0, 1, 1, 1;
  soup.add_face(std::vector<int>{0, 1, 2});
  soup.add_face(std::vector<int>{0, 2, 3});
  soup.add_face(std::vector<int>{3, 3, 3});
  write_surface(folder_ / "a.stl", soup);
  expect_same_faces(soup, read_surface(folder_ / "a.stl"));
  const std::string bytes = read_bytes(folder_ / "a.stl");
  EXPECT_EQ(load_little<float>(bytes.data() + 84 + 8), 1) << "the first normal is (0, 0, 1)";
  EXPECT_EQ(load_little<float>(bytes.data() + 184 + 8), 0) << "no normal where there is no area";
}

TEST_F(IoWrite, RefusesWhatAFormatCannotHold) {
  const auto error = [&](const char* name, const PolygonSoup& soup) -> std::string {
    try {
      write_surface(folder_ / name, soup);
    } catch (const UnsupportedError& e) {
      return e.what();
    }
    return "no error";
  };
  PolygonSoup soup = polygons();
  EXPECT_THAT(error("a.stl", soup), HasSubstr("face 1 has 4 corners, STL holds triangles only"));
  EXPECT_THAT(error("a.xyz", soup), HasSubstr("as a surface: the extension is '.xyz'"));
  soup.face_offsets.resize(2);
  PolygonSoup cloud;
  cloud.points = MatX3::Ones(2, 3);
  EXPECT_THAT(error("a.stl", cloud), HasSubstr("there are points and no faces"));
  EXPECT_THAT(error("a.stl", soup), HasSubstr("vertex 0 is beyond STL's single precision"));
  soup.scalars["nx"] = soup.scalars["distance"];
  EXPECT_THAT(error("a.ply", soup), HasSubstr("the scalar 'nx' cannot be the name"));
  soup.scalars.clear();
  soup.scalars["two words"] = VecX::Zero(300);
  EXPECT_THAT(error("a.ply", soup), HasSubstr("the scalar 'two words' cannot be the name"));
  soup.scalars["distance"] = VecX::Zero(3);
  EXPECT_THROW(write_surface(folder_ / "a.obj", soup), InputError);
  EXPECT_THROW(write_field(folder_ / "a.txt", soup), InputError);
  EXPECT_THROW(write_field(folder_ / "a.txt", soup, "missing"), InputError);
  EXPECT_THROW(write_field(folder_ / "a.off", polygons()), UnsupportedError);
  EXPECT_EQ(n_files(), 0);
}

PolygonSoup small_field() {
  PolygonSoup soup;
  soup.points.resize(3, 3);
  soup.points << 0, 0, 0, 1, 0, 0, 0, 1, 0;
  soup.add_face(std::vector<int>{0, 1, 2});
  soup.lines = {{2, 1}};
  soup.scalars["a,b"] = Vec3(1 / 3.0, infinity, -2);
  return soup;
}

// Two isolines of a square, and the square itself.
PolygonSoup lines_in_a_plane(int flat) {
  PolygonSoup soup;
  soup.points = MatX3::Constant(8, 3, 2);
  const int right = flat == 0 ? 1 : 0, up = flat == 2 ? 1 : 2;
  const double x[] = {0, 1, 1, 0, 0.25, 0.25, 0.75, 0.75}, y[] = {0, 0, 1, 1, 0, 1, 0, 1};
  for (int v = 0; v < 8; ++v) {
    soup.points(v, right) = x[v];
    soup.points(v, up) = y[v];
  }
  soup.lines = {{4, 5}, {6, 7}};
  soup.scalars["level"] = VecX::Constant(8, 0.5);
  soup.scalars["level"].tail(2).setConstant(1.5);
  return soup;
}

TEST_F(IoWrite, ObjGroupsIsolinesByLevel) {
  write_surface(folder_ / "a.obj", lines_in_a_plane(2), "none");
  const std::string text = read_bytes(folder_ / "a.obj");
  EXPECT_THAT(text, HasSubstr("g level_0.5\nl 5 6\ng level_1.5\nl 7 8\n"));
  EXPECT_EQ(read_surface(folder_ / "a.obj").lines, lines_in_a_plane(2).lines);
}

TEST_F(IoWrite, SvgOfLinesAndOutlines) {
  for (int flat = 0; flat < 3; ++flat) {
    PolygonSoup soup = lines_in_a_plane(flat);
    soup.add_face(std::array{0, 1, 2});
    soup.add_face(std::array{0, 2, 3});
    write_surface(folder_ / "a.svg", soup);
    const std::string text = read_bytes(folder_ / "a.svg");
    EXPECT_THAT(text, HasSubstr("viewBox=\"-0.02 -0.02 1.04 1.04\"")) << flat;
    // y counts downwards; the diagonal is no outline.
    EXPECT_THAT(text, HasSubstr("d=\"M0 1 L1 1 L1 0 L0 0 Z\"")) << flat;
    EXPECT_THAT(text, HasSubstr("data-level=\"0.5\" stroke=\"#")) << flat;
    EXPECT_THAT(text, HasSubstr("d=\"M0.25 1 L0.25 0\"")) << flat;
  }
  PolygonSoup solid = lines_in_a_plane(2);
  solid.points(3, 2) = 2.5;
  EXPECT_THAT(test::message_of([&] { write_surface(folder_ / "b.svg", solid); }),
              HasSubstr("the points fill 1 x 1 x 0.5; SVG is for lines and regions in a plane"));
  EXPECT_FALSE(fs::exists(folder_ / "b.svg"));
}

TEST_F(IoWrite, PlyHasTheFieldAsColoursToo) {
  PolygonSoup soup = lines_in_a_plane(2);
  soup.scalars = {{"distance", VecX::LinSpaced(8, 0, 7)}};
  soup.scalars["distance"](3) = infinity;
  write_surface(folder_ / "a.ply", soup);
  const std::string bytes = read_bytes(folder_ / "a.ply");
  EXPECT_THAT(bytes, HasSubstr("property double distance\nproperty uchar red\nproperty uchar "
                               "green\nproperty uchar blue\n"));
  const std::size_t row = 4 * 8 + 3, body = bytes.find("end_header\n") + 11;
  EXPECT_NE(bytes.substr(body + 32, 3), bytes.substr(body + 7 * row + 32, 3));
  EXPECT_EQ(bytes.substr(body + 3 * row + 32, 3), std::string(3, static_cast<char>(150)));
  EXPECT_EQ(read_surface(folder_ / "a.ply").scalars, soup.scalars);
}

TEST_F(IoWrite, FieldsAsText) {
  write_field(folder_ / "a.txt", small_field(), "a,b");
  EXPECT_EQ(read_bytes(folder_ / "a.txt"), "0.3333333333333333\ninf\n-2\n");
  write_field(folder_ / "a.csv", small_field(), "a,b");
  EXPECT_EQ(read_bytes(folder_ / "a.csv"), "vertex,\"a,b\"\n0,0.3333333333333333\n1,inf\n2,-2\n");
}

TEST_F(IoWrite, DecimalsHaveAPointInAnyLocale) {
  const test::CommaLocale comma;
  if (!test::CommaLocale::there()) GTEST_SKIP() << test::no_comma_locale;
  for (const std::string name : {"a.txt", "a.csv"}) {
    write_field(folder_ / name, small_field(), "a,b");
    EXPECT_THAT(read_bytes(folder_ / name), HasSubstr("0.333333"));
  }
  write_surface(folder_ / "a.obj", small_field());
  EXPECT_EQ(read_surface(folder_ / "a.obj").points, small_field().points);
}

TEST_F(IoWrite, FieldsAsNpy) {
  write_field(folder_ / "a.npy", small_field(), "a,b");
  const std::string bytes = read_bytes(folder_ / "a.npy");
  ASSERT_EQ(bytes.size(), 128u + 24u);
  EXPECT_EQ(bytes.substr(0, 8), std::string("\x93NUMPY\x01\x00", 8));
  EXPECT_EQ(load_little<std::uint16_t>(bytes.data() + 8), 118);
  EXPECT_THAT(bytes.substr(10, 118),
              ::testing::MatchesRegex(
                  "\\{'descr': '<f8', 'fortran_order': False, 'shape': \\(3,\\), \\} *\n"));
  EXPECT_EQ(load_little<double>(bytes.data() + 128), 1 / 3.0);
  EXPECT_EQ(load_little<double>(bytes.data() + 136), infinity);
}

TEST_F(IoWrite, FieldsAsVtp) {
  write_field(folder_ / "a.vtp", small_field(), "a,b");
  const std::string bytes = read_bytes(folder_ / "a.vtp");
  EXPECT_THAT(bytes, HasSubstr("NumberOfPoints=\"3\" NumberOfVerts=\"0\" NumberOfLines=\"1\" "
                               "NumberOfStrips=\"0\" NumberOfPolys=\"1\""));
  // The blocks follow the underscore: length in bytes, data.
  std::size_t at = bytes.find("encoding=\"raw\">\n_") + 17;
  for (const auto& [name, length] : std::vector<std::pair<std::string, std::uint64_t>>{
           {"a,b", 24}, {"Points", 72}, {"lines", 16}, {"ends", 8}, {"faces", 24}, {"ends", 8}}) {
    ASSERT_EQ(load_little<std::uint64_t>(bytes.data() + at), length) << name;
    at += 8 + length;
  }
  EXPECT_EQ(bytes.substr(at), "\n</AppendedData>\n</VTKFile>\n");
  EXPECT_EQ(load_little<std::int64_t>(bytes.data() + at - 8), 3) << "end of the only face";
  EXPECT_THAT(bytes, HasSubstr("Name=\"a,b\" NumberOfComponents=\"1\" format=\"appended\" "
                               "offset=\"0\""));
  EXPECT_THAT(bytes, HasSubstr("Name=\"Points\" NumberOfComponents=\"3\" format=\"appended\" "
                               "offset=\"32\""));
}

TEST_F(IoWrite, NothingIsLeftAfterAnError) {
  std::ofstream(folder_ / "a.txt") << "old";
  EXPECT_THROW(write_atomically(folder_ / "a.txt",
                                [](std::ostream& out) {
                                  out << "new";
                                  throw Cancelled();
                                }),
               Cancelled);
  EXPECT_EQ(read_bytes(folder_ / "a.txt"), "old");
  EXPECT_EQ(n_files(), 1);
  write_atomically(folder_ / "a.txt", [](std::ostream& out) { out << "new"; });
  EXPECT_EQ(read_bytes(folder_ / "a.txt"), "new");
  EXPECT_EQ(n_files(), 1);
}

TEST_F(IoWrite, ErrorsNameThePath) {
  const auto error = [](const fs::path& path) -> std::string {
    try {
      write_atomically(path, [](std::ostream& out) { out << std::string(1 << 20, 'x'); });
    } catch (const IoError& e) {
      return e.what();
    }
    return "no error";
  };
  const fs::path missing = folder_ / "no" / "a.obj";
  EXPECT_EQ(error(missing), "cannot write " + missing.string() + ": there is no folder " +
                                missing.parent_path().string());
  EXPECT_EQ(error(folder_), "cannot write " + folder_.string() + ": Is a directory");
  if (fs::exists("/dev/full")) {
    EXPECT_EQ(error("/dev/full"), "cannot write /dev/full: No space left on device");
  }
}

/// Bytes that tell where they are.
std::string numbered(std::size_t n) {
  std::string bytes(n, 0);
  for (std::size_t i = 0; i < n; ++i) bytes[i] = static_cast<char>((i * 2654435761U) >> 13);
  return bytes;
}

TEST_F(IoWrite, MuchIsWrittenBySeveralThreadsInItsPlace) {
  const std::string much = numbered((9 << 20) + 12345), more = numbered(17 << 20);
  const std::string expected = "begin" + much + "between" + more + much + "end";
  for (const int threads : {1, 3}) {
    set_thread_count(threads);
    write_atomically(folder_ / "a.bin", [&](std::ostream& out) {
      out << "begin";
      out.write(much.data(), std::streamsize(much.size()));
      EXPECT_EQ(out.tellp(), std::streamoff(5 + much.size()));
      out << "between";
      out.write(more.data(), std::streamsize(more.size()));
      out.write(much.data(), std::streamsize(much.size()));
      out << "end";
    });
    EXPECT_TRUE(read_bytes(folder_ / "a.bin") == expected) << threads;
  }
  set_thread_count(0);
}

TEST_F(IoWrite, MuchThatDoesNotFitIsAnErrorAndLeavesNothing) {
  const std::string much = numbered(20 << 20);
  const auto before = ::signal(SIGXFSZ, SIG_IGN);
  rlimit unlimited;
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &unlimited), 0);
  const rlimit limit = {12 << 20, unlimited.rlim_max};
  for (const int threads : {1, 3}) {
    set_thread_count(threads);
    std::string found = "no error";
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &limit), 0);
    try {
      write_atomically(folder_ / "a.bin", [&](std::ostream& out) {
        out << "begin";
        out.write(much.data(), std::streamsize(much.size()));
      });
    } catch (const IoError& e) {
      found = e.what();
    }
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &unlimited), 0);
    EXPECT_EQ(found, "cannot write " + (folder_ / "a.bin").string() + ": File too large");
    EXPECT_EQ(n_files(), 0);
  }
  set_thread_count(0);
  ::signal(SIGXFSZ, before);
}

TEST_F(IoWrite, FollowsLinks) {
  std::ofstream(folder_ / "target.txt") << "old";
  fs::create_symlink("target.txt", folder_ / "link.txt");
  write_atomically(folder_ / "link.txt", [](std::ostream& out) { out << "new"; });
  EXPECT_TRUE(fs::is_symlink(folder_ / "link.txt"));
  EXPECT_EQ(read_bytes(folder_ / "target.txt"), "new");
}

TEST_F(IoWrite, AnInterruptRemovesUnfinishedFiles) {
  EXPECT_THROW(write_atomically(folder_ / "a.txt",
                                [&](std::ostream& out) {
                                  out << "new" << std::flush;
                                  EXPECT_EQ(n_files(), 1);
                                  remove_unfinished_files();
                                  EXPECT_EQ(n_files(), 0);
                                  throw Cancelled();
                                }),
               Cancelled);
  write_atomically(folder_ / "b.txt", [](std::ostream& out) { out << "new"; });
  remove_unfinished_files();
  EXPECT_EQ(read_bytes(folder_ / "b.txt"), "new") << "finished files stay";
}

}  // namespace
}  // namespace littoral::io
