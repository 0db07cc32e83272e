// Directions on faces, as files have them.

#include "io/surface/read_directions.h"

#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "base/platform/temporary_folder.h"
#include "comma_locale.h"
#include "littoral/error.h"
#include "space_helpers.h"

namespace littoral {
namespace {

class ReadDirections : public ::testing::Test {
 protected:
  io::FaceDirections read(const std::string& bytes, int n_faces) const {
    std::ofstream(path_, std::ios::binary) << bytes;
    return io::read_directions(path_, n_faces);
  }
  std::string error(const std::string& bytes) const {
    return test::message_of([&] { read(bytes, 2); }).substr(path_.string().size());
  }
  TemporaryFolder folder_{"littoral-directions"};
  std::filesystem::path path_ = folder_.path() / "a.txt";
};

TEST_F(ReadDirections, OneForEveryFaceOrSomeAtChosenOnes) {
  EXPECT_EQ(read("1 0 -2\n# a comment\n\n.5 1e1 +3 # another\n", 2).all,
            (MatX3(2, 3) << 1, 0, -2, 0.5, 10, 3).finished());
  const io::FaceDirections some = read("f 1 0 0 -4\nf 0 1 2 0\n", 2);
  EXPECT_EQ(some.all.rows(), 0);
  ASSERT_EQ(some.sparse.size(), 2u);
  EXPECT_EQ(some.sparse[0].first, 1);
  EXPECT_EQ(some.sparse[0].second, Vec3(0, 0, -1));
  EXPECT_EQ(some.sparse[1].second, Vec3(0.5, 1, 0));
}

TEST_F(ReadDirections, TextOfAnyProgram) {
  for (const char* text : {"\xEF\xBB\xBF"
                           "f 1 0 0.5 1\n",
                           "f 1 0 0.5 1\r\n", "f\t1 0 0.5 1\r"}) {
    const io::FaceDirections some = read(text, 2);
    ASSERT_EQ(some.sparse.size(), 1u) << text;
    EXPECT_EQ(some.sparse[0].second, Vec3(0, 0.5, 1)) << text;
  }
}

TEST_F(ReadDirections, NumbersHaveAPointInAnyLocale) {
  const test::CommaLocale comma;
  if (!test::CommaLocale::there()) GTEST_SKIP() << test::no_comma_locale;
  EXPECT_EQ(read("0.5 1.25 -0.75\n", 1).all, MatX3(Vec3(0.5, 1.25, -0.75).transpose()));
}

TEST_F(ReadDirections, WhatIsWrongIsNamed) {
  EXPECT_EQ(error("1 0 0\n1 0\n"), ":2: expected 'x y z' or 'f I x y z'");
  EXPECT_EQ(error("1 0 0x1\n"), ":1: '0x1' is not a finite number");
  EXPECT_EQ(error("1 0 0,5\n"),
            ":1: '0,5' is not a finite number; write a point, not a comma, before the decimals");
  EXPECT_EQ(error("1 0 inf\n"), ":1: 'inf' is not a finite number");
  EXPECT_EQ(error("f 2 1 0 0\n"), ":1: there is no face '2'; the mesh has 2, counted from 0");
  EXPECT_EQ(error("f 99999999999999999999 1 0 0\n"),
            ":1: there is no face '99999999999999999999'; the mesh has 2, counted from 0");
  EXPECT_EQ(error("f 1 0 0 0\n"), ":1: a direction of length 0");
  EXPECT_EQ(error("1 0 0\n"), ": 1 directions for 2 faces");
  EXPECT_EQ(error("1 0 0\n1 0 0\n1 0 0\n"), ":3: more directions than the mesh has faces, 2");
  EXPECT_EQ(error("1 0 0\nf 1 1 0 0\n"),
            ": lines 'x y z' and 'f I x y z' are mixed; write one kind");
  EXPECT_EQ(error("# nothing\n"), ": holds no direction");
  EXPECT_THROW(io::read_directions(folder_.path(), 2), IoError);
  EXPECT_THROW(io::read_directions(folder_.path() / "b.txt", 2), IoError);
}

}  // namespace
}  // namespace littoral
