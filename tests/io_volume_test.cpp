#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <random>

#include "io/binary.h"
#include "io/read.h"
#include "io/volume/volume.h"
#include "littoral/error.h"
#include "space_helpers.h"
#include "volume_helpers.h"

namespace littoral {
namespace {

namespace fs = std::filesystem;

Volume example() {
  const Grid grid{{3, 4, 5}, Vec3(-1.5, 0.1, 1e6), Vec3(0.1, 0.25, 1.0 / 3)};
  Volume field =
      test::sampled(grid, [](const Vec3& p) { return std::sin(7 * p[0] + p[1]) * p[2]; });
  field.values[7] = std::numeric_limits<double>::infinity();
  field.values[8] = -0.0;
  field.values[9] = 5e-324;
  field.name = "a < \"b\" & c";
  return field;
}

struct VolumeFile : testing::TestWithParam<const char*> {
  fs::path path = fs::path(testing::TempDir()) / (std::string("littoral_volume") + GetParam());
  void TearDown() override { fs::remove(path); }
};

TEST_P(VolumeFile, ReadsBackWhatWasWritten) {
  const Volume out = example();
  io::write_volume(path, out);
  const Volume in = io::read_volume(path);
  EXPECT_EQ(in.grid.n, out.grid.n);
  for (Eigen::Index i = 0; i < out.values.size(); ++i) EXPECT_EQ(in.values[i], out.values[i]);
  if (path.extension() == ".npy") {
    EXPECT_EQ(in.grid.spacing, Vec3::Ones());
    return;
  }
  EXPECT_EQ(in.grid.origin, out.grid.origin);
  EXPECT_EQ(in.grid.spacing, out.grid.spacing);
  EXPECT_EQ(in.name, out.name);
  EXPECT_THROW(io::read_volume(path, "other"), InputError);
  EXPECT_NO_THROW(io::read_volume(path, out.name));
}

// Cut short anywhere, or with any byte changed: a volume or an error that says so.
TEST_P(VolumeFile, DamagedFilesAreRefusedOrRead) {
  io::write_volume(path, example());
  const std::string bytes = io::read_bytes(path);
  const auto attempt = [&](const std::string& damaged, bool must_fail) {
    try {
      const Volume field = io::read_volume_bytes(damaged, GetParam(), "damaged");
      EXPECT_EQ(static_cast<std::size_t>(field.values.size()), field.grid.n_nodes());
      EXPECT_FALSE(must_fail);
    } catch (const InputError& e) {
      EXPECT_NE(std::string(e.what()).find("damaged"), std::string::npos);
    } catch (const UnsupportedError&) {
    }
  };
  const std::size_t tail = path.extension() == ".vti" ? 40 : 1;  // closing tags may be missing
  for (std::size_t n = 0; n < bytes.size(); ++n)
    attempt(bytes.substr(0, n), n + tail < bytes.size());
  std::mt19937 random(3);
  for (int trial = 0; trial < 4000; ++trial) {
    std::string damaged = bytes;
    for (unsigned k = 0; k < 1 + random() % 3; ++k)
      damaged[random() % damaged.size()] = static_cast<char>(random());
    attempt(damaged, false);
  }
}

TEST(WriteNpz, ValuesDoNotTakeTheNamesOfTheBox) {
  const fs::path path = fs::path(testing::TempDir()) / "littoral_volume_names.npz";
  for (const char* name : {"origin", "spacing", "depth"}) {
    Volume out = example();
    out.name = name;
    io::write_volume(path, out);
    const Volume in = io::read_volume(path);
    EXPECT_EQ(in.values, out.values) << name;
    EXPECT_EQ(in.grid.origin, out.grid.origin) << name;
    EXPECT_EQ(in.grid.spacing, out.grid.spacing) << name;
  }
  fs::remove(path);
}

INSTANTIATE_TEST_SUITE_P(Formats, VolumeFile, testing::Values(".vti", ".nrrd", ".npy"));

std::string vti(const std::string& array, const std::string& attributes = "",
                const std::string& rest = "") {
  return "<?xml version='1.0'?>\n<!-- a comment with <Piece> -->\n"
         "<VTKFile type='ImageData' byte_order='LittleEndian' " +
         attributes +
         ">\n"
         "<ImageData WholeExtent='2 3 0 1 0 1' Origin='1 2 3' Spacing='0.5 1 2'>\n"
         "<Piece Extent='2 3 0 1 0 1'><CellData/><PointData>\n" +
         array + "</PointData></Piece></ImageData>\n" + rest + "</VTKFile>\n";
}

void expect_counting(const Volume& field) {
  ASSERT_EQ(field.values.size(), 8);
  for (int i = 0; i < 8; ++i) EXPECT_EQ(field.values[i], i);
  EXPECT_EQ(field.grid.origin, Vec3(2, 2, 3));
  EXPECT_EQ(field.grid.spacing, Vec3(0.5, 1, 2));
}

TEST(ReadVti, AsciiBinaryAndFieldsToChooseFrom) {
  const std::string text =
      "<DataArray type='Int32' Name='n' format='ascii'>\n0 1 2\n3 4 5 6 7\n</DataArray>\n";
  expect_counting(io::read_volume_bytes(vti(text), ".VTI", "a"));
  // UInt32 length 8 and the bytes 0..7, as base64
  const std::string binary =
      "<DataArray type='UInt8' Name='distance' format='binary'>CAAAAAABAgMEBQYH</DataArray>";
  expect_counting(io::read_volume_bytes(vti(text + binary), ".vti", "a"));
  EXPECT_EQ(io::read_volume_bytes(vti(text + binary), ".vti", "a", "n").name, "n");
  // The length in a text of its own, as some programs write it
  const std::string apart =
      "<DataArray type='UInt8' Name='n' format='binary'>CAAAAA==AAECAwQFBgc=</DataArray>";
  expect_counting(io::read_volume_bytes(vti(apart), ".vti", "a"));
  try {
    io::read_volume_bytes(vti(text + text), ".vti", "a", "m");
    ADD_FAILURE();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("it has: n, n"), std::string::npos) << e.what();
  }
}

TEST(ReadVti, CompressedAppendedData) {
  std::string raw, head;
  for (int i = 0; i < 8; ++i) {
    const float value = static_cast<float>(i);
    raw.append(reinterpret_cast<const char*>(&value), 4);
  }
  // Two blocks of 16 bytes.
  std::string body;
  const auto number = [&](std::uint64_t x) { head.append(reinterpret_cast<const char*>(&x), 8); };
  number(2), number(16), number(0);
  for (int b = 0; b < 2; ++b) {
    std::string packed(64, '\0');
    uLongf size = 64;
    ASSERT_EQ(compress(reinterpret_cast<Bytef*>(packed.data()), &size,
                       reinterpret_cast<const Bytef*>(raw.data()) + 16 * b, 16),
              Z_OK);
    number(size);
    body += packed.substr(0, size);
  }
  const std::string array = "<DataArray type='Float32' Name='n' format='appended' offset='0'/>\n";
  const std::string attributes = "header_type='UInt64' compressor='vtkZLibDataCompressor'";
  const auto file = [&](const std::string& data) {
    return vti(array, attributes, "<AppendedData encoding='raw'>\n_" + data + "\n</AppendedData>");
  };
  expect_counting(io::read_volume_bytes(file(head + body), ".vti", "a"));
  body[5] = static_cast<char>(body[5] ^ 0x55);
  EXPECT_THROW(io::read_volume_bytes(file(head + body), ".vti", "a"), InputError);
}

TEST(ReadVti, WhatIsNotRead) {
  const std::string text =
      "<DataArray type='Int32' Name='n' format='ascii'>0 1 2 3 4 5 6 7</DataArray>";
  const auto replaced = [&](const std::string& from, const std::string& to) {
    std::string file = vti(text);
    file.replace(file.find(from), from.size(), to);
    return file;
  };
  const auto read = [](const std::string& bytes) { io::read_volume_bytes(bytes, ".vti", "a"); };
  EXPECT_NO_THROW(read(replaced("'ImageData'", "'ImageData'")));
  EXPECT_THROW(read(replaced("'ImageData'", "'PolyData'")), UnsupportedError);
  EXPECT_THROW(read(replaced("Spacing='0.5 1 2'", "Spacing='0.5 -1 2'")), InputError);
  EXPECT_THROW(read(replaced("Spacing='0.5 1 2'", "Spacing='1 1 1' Direction='0 1 0 1 0 0 0 0 1'")),
               UnsupportedError);
  EXPECT_THROW(read(replaced("2 3 0 1 0 1' Origin", "2 900000000 0 900000000 0 1' Origin")),
               InputError);
  EXPECT_THROW(read(replaced("0 1 2 3 4 5", "0 1 2 3 x 5")), InputError);
  EXPECT_THROW(read(replaced("0 1 2 3 4 5", "0 1 2 3 4")), InputError);
}

TEST(ReadNrrd, TypesAndEncodings) {
  const std::string head =
      "NRRD0005\r\n# comment\r\nkey:=value\r\ndimension: 3\r\nsizes: 2 2 2\r\n"
      "spacings: 0.5 1 2\r\nspace origin: (2,2,3)\r\n";
  const auto read = [&](const std::string& rest) {
    return io::read_volume_bytes(head + rest, ".nrrd", "a");
  };
  expect_counting(read("type: unsigned char\nencoding: ascii\n\n0 1 2 3\n4 5 6 7\n"));
  expect_counting(
      read(std::string("type: uint8\nencoding: raw\n\n") + std::string("\0\1\2\3\4\5\6\7", 8)));
  expect_counting(read("type: short\nendian: big\nencoding: raw\n\n" +
                       std::string("\0\0\0\1\0\2\0\3\0\4\0\5\0\6\0\7", 16)));
  EXPECT_THROW(read("type: short\nencoding: raw\n\n0123456789012345"), InputError);
  EXPECT_THROW(read("type: uint8\nencoding: raw\ndata file: x.raw\n\n"), UnsupportedError);
  EXPECT_THROW(read("type: uint8\nencoding: bzip2\n\n"), UnsupportedError);
  EXPECT_THROW(read("type: uint8\nencoding: gzip\n\nabc"), InputError);
  EXPECT_THROW(read("type: uint8\nencoding: ascii\n\n0 1 2"), InputError);
  EXPECT_THAT(
      test::message_of([&] { read("sizes: 2 2 1\ntype: uint8\nencoding: ascii\n\n0 1 2 3\n"); }),
      testing::HasSubstr("'sizes' appears twice"));
}

TEST(ReadNrrd, EndsOfAxesPlaceTheGrid) {
  const auto read = [](const std::string& rest) {
    return io::read_volume_bytes(
        "NRRD0001\ntype: uint8\nencoding: ascii\ndimension: 3\n"
        "sizes: 2 2 2\n" +
            rest + "\n0 1 2 3 4 5 6 7\n",
        ".nrrd", "a");
  };
  // The first sample of these is at 2, 2, 3, and they are 0.5, 1 and 2 apart.
  expect_counting(read("axis mins: 2 2 3\naxis maxs: 2.5 3 5\ncenters: node node node\n"));
  expect_counting(read("axismins: 1.75 1.5 2\naxismaxs: 2.75 3.5 6\ncenterings: cell cell cell\n"));
  expect_counting(read("axis mins: 1.75 2 3\ncenters: cell node node\nspacings: 0.5 1 2\n"));
  expect_counting(
      read("axis mins: nan 2 nan\naxis maxs: 2.5 nan 6\ncenters: node node cell\n"
           "spacings: 0.5 1 2\n"));
  const Grid nowhere = read("axis mins: nan nan nan\n").grid;
  EXPECT_EQ(nowhere.origin, Vec3::Zero());
  EXPECT_EQ(nowhere.spacing, Vec3::Ones());
  EXPECT_THROW(read("axis mins: 2 2 3\n"), UnsupportedError);  // of nodes or of cells?
  EXPECT_THROW(read("axis mins: 2 2 3\ncenters: node node ???\n"), UnsupportedError);
  EXPECT_THROW(read("axis mins: 2 2\ncenters: node node node\n"), InputError);
  EXPECT_THROW(read("axis mins: 2 2 3\naxis maxs: 2 3 4\ncenters: node node node\n"), InputError);
}

TEST(ReadNpy, RowMajorArraysAndOtherTypes) {
  const auto npy = [](std::string header, const std::string& data) {
    header.resize(118, ' ');
    return std::string("\x93NUMPY\x01\0", 8) + static_cast<char>(118) + '\0' + header + data;
  };
  const std::string bytes("\0\1\2\3\4\5\6\7", 8);
  const Volume field = io::read_volume_bytes(
      npy("{'descr': '|u1', 'fortran_order': False, 'shape': (1, 2, 4), }", bytes), ".npy", "a");
  EXPECT_EQ(field.grid.n, (std::array<int, 3>{1, 2, 4}));
  EXPECT_EQ(field.values[static_cast<Eigen::Index>(field.grid.node(0, 1, 2))], 6);
  for (const char* header :
       {"{'descr': '<f8', 'fortran_order': True, 'shape': (8,), }",
        "{'descr': '<f8', 'fortran_order': True, 'shape': (2, 2, 2), }",
        "{'descr': '<i4', 'fortran_order': False, 'shape': (), }",
        "{'descr': '|u1', 'fortran_order': True, 'shape': (9999999999, 1, 1), }"})
    EXPECT_THROW(io::read_volume_bytes(npy(header, bytes), ".npy", "a"), InputError);
  EXPECT_THROW(  // not a byte for its one number
      io::read_volume_bytes(npy("{'descr': '<f8', 'fortran_order': False, 'shape': (), }", ""),
                            ".npy", "a"),
      InputError);
  EXPECT_THROW(
      io::read_volume_bytes(
          npy("{'descr': '<c8', 'fortran_order': True, 'shape': (1, 1, 1), }", bytes), ".npy", "a"),
      UnsupportedError);
}

TEST(WriteVolume, Refuses) {
  Volume field = example();
  EXPECT_THROW(io::write_volume("x.obj", field), UnsupportedError);
  EXPECT_THROW(io::write_volume("/nonexistent/x.vti", field), IoError);
  field.values.conservativeResize(5);
  EXPECT_THROW(io::write_volume("x.vti", field), InputError);
}

TEST(WriteVolume, VdbIsALevelSet) {
  const fs::path path = fs::path(testing::TempDir()) / "littoral_volume.vdb";
  const Grid grid{{20, 20, 20}, Vec3::Constant(-1), Vec3::Constant(2.0 / 19)};
  const Volume sphere = test::sampled(grid, [](const Vec3& p) { return p.norm() - 0.7; });
  if (!io::has_openvdb()) {
    EXPECT_THROW(io::write_volume(path, sphere), UnsupportedError);
    GTEST_SKIP() << "built without OpenVDB";
  }
  io::write_volume(path, sphere);
  const auto whole = fs::file_size(path);
  io::write_volume(path, sphere, {.band = 2});
  EXPECT_LT(fs::file_size(path), whole);
  const std::string bytes = io::read_bytes(path);
  EXPECT_NE(bytes.find("level set"), std::string::npos);
  EXPECT_NE(bytes.find("distance"), std::string::npos);
  fs::remove(path);
}

TEST(ReadVdb, TheBoxOfActiveVoxels) {
  const fs::path path = fs::path(testing::TempDir()) / "littoral_read.vdb";
  const Grid grid{{20, 21, 22}, Vec3(-1, -2, -3), Vec3(0.125, 0.25, 0.5)};
  const Volume plane = test::sampled(grid, [](const Vec3& p) { return p[0]; });
  if (!io::has_openvdb()) {
    EXPECT_THROW(io::read_volume_bytes("", ".vdb", "a.vdb"), UnsupportedError);
    GTEST_SKIP() << "built without OpenVDB";
  }
  io::write_volume(path, plane);
  const Volume back = io::read_volume(path);
  EXPECT_EQ(back.name, "distance");
  EXPECT_EQ(back.grid.n, grid.n);
  EXPECT_LT((back.grid.origin - grid.origin).norm() + (back.grid.spacing - grid.spacing).norm(),
            1e-12);
  EXPECT_EQ(back.values, plane.values.cast<float>().cast<double>());
  // A band of one spacing of 0.5 about x = 0: nodes at -0.375 to 0.375.
  io::write_volume(path, plane, {.band = 1});
  const Volume band = io::read_volume(path);
  EXPECT_EQ(band.grid.n, (std::array<int, 3>{7, 21, 22}));
  EXPECT_NEAR(band.grid.origin[0], -0.375, 1e-12);
  EXPECT_THROW(io::read_volume(path, "density"), InputError);
  const std::string bytes = io::read_bytes(path);
  for (const std::size_t cut : {std::size_t{0}, std::size_t{10}, bytes.size() / 2})
    EXPECT_THROW(io::read_volume_bytes(bytes.substr(0, cut), ".vdb", "a.vdb"), InputError) << cut;
  fs::remove(path);
}

}  // namespace
}  // namespace littoral
