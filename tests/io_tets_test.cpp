// Tet meshes in files: what is read, what is written, what is refused and how.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <limits>

#include "io/read.h"
#include "io/tet/tets.h"
#include "littoral/error.h"
#include "shared_data.h"
#include "space_helpers.h"
#include "surface_bytes.h"
#include "tet_helpers.h"

namespace littoral {
namespace {

using test::replaced;

const std::string medit =
    "MeshVersionFormatted 2\n# a comment\nDimension\n3\nVertices\n4\n0 0 0 1\n1 0 0 1\n0 1 0 2\n"
    "0 0 1 0\nEdges 1 1 2 0\nTriangles\n1\n1 2 3 7\nTetrahedra\n1\n1 2 3 4 5\nEnd\n";
const std::string tet = "4 vertices\n1 tets\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n4 0 1 2 3\n";
const std::string vtk =
    "# vtk DataFile Version 2.0\nany title\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n"
    "0 0 0 1 0 0\n0 1 0 0 0 1\nCELLS 2 9\n4 0 1 2 3\n3 0 1 2\nCELL_TYPES 2\n10\n5\n"
    "POINT_DATA 4\nSCALARS depth float\nLOOKUP_TABLE default\n1 2 3 4\nVECTORS v float\n"
    "0 0 0 0 0 0 0 0 0 0 0 0\nCELL_DATA 2\nSCALARS part int 1\nLOOKUP_TABLE default\n1 2\n";
const std::string modern =
    "# vtk DataFile Version 5.1\nany title\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 double\n"
    "0 0 0 1 0 0 0 1 0 0 0 1\nMETADATA\nINFORMATION 1\nNAME x\n\nCELLS 3 7\nOFFSETS "
    "vtktypeint64\n0 4 7\nCONNECTIVITY vtktypeint64\n0 1 2 3 0 1 2\nCELL_TYPES 2\n10 5\n"
    "POINT_DATA 4\nFIELD FieldData 1\ndepth 1 4 double\n1 2 3 4\n";

io::TetFile read_tets(const std::string& bytes, const std::string& extension) {
  return io::read_tets_bytes(bytes, extension, "file" + extension);
}

void expect_one_tet(const io::TetFile& file, bool triangles) {
  ASSERT_EQ(file.mesh.n_vertices(), 4);
  ASSERT_EQ(file.mesh.n_tets(), 1);
  for (int k = 0; k < 4; ++k) EXPECT_EQ(file.mesh.tets(0, k), k);
  EXPECT_EQ(file.mesh.points.row(2), Eigen::RowVector3d(0, 1, 0));
  ASSERT_EQ(file.triangles.rows(), triangles ? 1 : 0);
  if (triangles) {
    EXPECT_EQ(file.triangles.row(0), Eigen::RowVector3i(0, 1, 2));
  }
}

TEST(TetFiles, EveryFormatHoldsTheSameTet) {
  expect_one_tet(read_tets(medit, ".mesh"), true);
  expect_one_tet(read_tets(tet, ".tet"), false);
  expect_one_tet(read_tets("4 1\n0 0 0 1 0 0 0 1 0 0 0 1\n4 0 1 2 3", ".TET"), false);
  for (const std::string& text : {vtk, modern}) {
    const io::TetFile file = read_tets(text, ".vtk");
    expect_one_tet(file, true);
    ASSERT_EQ(file.scalars.size(), 1u);
    EXPECT_EQ(file.scalars.at("depth"), Eigen::Vector4d(1, 2, 3, 4));
  }
}

TEST(TetFiles, WrittenFilesReadBackExactly) {
  TetMesh mesh = test::tet_box(3);
  mesh.points.array() += 1.0 / 3;
  VecX values = mesh.points.rowwise().norm();
  values[5] = std::numeric_limits<double>::infinity();
  const auto folder = std::filesystem::path(testing::TempDir());
  const auto path = folder / "littoral_tets.vtk";
  io::write_tets(path, mesh, values, "my field");
  const io::TetFile file = io::read_tets(path);
  EXPECT_EQ(file.mesh.points, mesh.points);
  EXPECT_EQ(file.mesh.tets, mesh.tets);
  EXPECT_EQ(file.scalars.at("my_field"), values);
  // Cut anywhere, the file is an error or has lost nothing but the field.
  const std::string bytes = io::read_bytes(path);
  for (std::size_t cut = 0; cut < bytes.size(); cut += 97) {
    try {
      EXPECT_EQ(read_tets(bytes.substr(0, cut), ".vtk").mesh.n_tets(), mesh.n_tets());
    } catch (const InputError&) {
    }
  }
  std::filesystem::remove(path);
}

TEST(TetFiles, XmlHoldsEveryBlock) {
  const TetMesh mesh = test::tet_box(2);
  const auto path = std::filesystem::path(testing::TempDir()) / "littoral_tets.vtu";
  io::write_tets(path, mesh, VecX::Ones(mesh.n_vertices()));
  const std::string bytes = io::read_bytes(path);
  const std::size_t n = 27, tets = 48;
  const std::size_t data = bytes.find("\n_") + 2;
  const std::size_t all = 5 * 8 + 8 * n + 24 * n + 16 * tets + 8 * tets + tets;
  EXPECT_EQ(bytes.substr(data + all, 15), "\n</AppendedData");
  EXPECT_THAT(bytes, testing::HasSubstr("NumberOfPoints=\"27\" NumberOfCells=\"48\""));
  EXPECT_THAT(bytes, testing::HasSubstr("offset=\"" + std::to_string(8 + 8 * n) + "\""));
  EXPECT_THROW(io::write_tets("x.obj", mesh, VecX::Ones(27)), UnsupportedError);
  EXPECT_THROW(io::write_tets("x.vtk", mesh, VecX::Ones(26)), InputError);
  EXPECT_THROW(io::write_tets("/nonexistent/x.vtk", mesh, VecX::Ones(27)), IoError);
  std::filesystem::remove(path);
}

TEST(TetFiles, ErrorsNameFileLineAndElement) {
  const auto message = [](const std::string& bytes, const std::string& extension) {
    return test::message_of([&] { read_tets(bytes, extension); });
  };
  const auto expect = [&](const std::string& bytes, const std::string& extension,
                          const std::string& text) {
    EXPECT_THAT(message(bytes, extension), testing::HasSubstr(text)) << bytes;
  };
  expect(replaced(medit, "1 2 3 4 5", "1 2 3 5 5"), ".mesh",
         "file.mesh:17: tet 1 refers to vertex 5, the file has 4 (counted from 1)");
  expect(replaced(medit, "1 2 3 7", "0 2 3 7"), ".mesh", "file.mesh:14: triangle 1 refers to");
  expect(replaced(medit, "0 1 0 2", "0 y 0 2"), ".mesh",
         "file.mesh:9: expected a coordinate of vertex 3, found 'y'");
  expect(replaced(medit, "Vertices\n4", "Vertices\n4000000"), ".mesh", "promises 4000000");
  expect(replaced(medit, "Vertices\n4", "Vertices\n-4"), ".mesh", "negative number");
  expect(replaced(medit, "Dimension\n3", "Dimension 2"), ".mesh", "the dimension must be 3");
  expect(replaced(medit, "Edges", "Wedges"), ".mesh", "unknown section 'Wedges'");
  expect(replaced(medit, "Edges 1 1 2 0", "Hexahedra 1 1 2 3 4 1 2 3 9 0"), ".mesh",
         "hexahedron 1 refers to vertex 9");
  expect(medit.substr(0, medit.find("End") - 4), ".mesh", "found the end of the file");
  expect("", ".mesh", "expected MeshVersionFormatted");
  expect(replaced(medit, "Tetrahedra\n1\n1 2 3 4 5", ""), ".mesh", "the file has no tets");
  expect(replaced(tet, "4 0 1 2 3", "4 0 1 2 4"), ".tet",
         "file.tet:7: tet 0 refers to vertex 4, the file has 4 (counted from 0)");
  expect(replaced(tet, "4 0 1 2 3", "8 0 1 2 3"), ".tet", "cell 0 has 8 corners");
  expect(replaced(tet, "1 tets", "99999 tets"), ".tet", "promises 99999");
  expect(replaced(vtk, "4 0 1 2 3", "4 0 1 2 9"), ".vtk",
         "cell 0 refers to vertex 9, the file has 4 (counted from 0)");
  expect(replaced(vtk, "4 0 1 2 3", "7 0 1 2 3"), ".vtk", "CELLS ends within cell 1");
  expect(replaced(vtk, "0 1 0 0 0 1", "0 1 0 0 zero 1"), ".vtk",
         "file.vtk:7: expected number 10 of POINTS, found 'zero'");
  expect(replaced(vtk, "POINTS 4", "POINTS 4444444"), ".vtk", "file.vtk:5: the file promises");
  expect(replaced(vtk, "10\n5", "12\n5"), ".vtk",
         "cell 0 of type 12 must have 8 corners, it has 4");
  expect(replaced(vtk, "10\n5", "24\n5"), ".vtk", "cell 0 is of type 24");
  expect(replaced(vtk, "CELL_TYPES 2\n10\n5", "CELL_TYPES 1\n10"), ".vtk", "2 cells and 1 cell");
  expect(replaced(vtk, "UNSTRUCTURED_GRID", "STRUCTURED_GRID"), ".vtk",
         "POLYDATA and STRUCTURED_POINTS");
  expect(replaced(vtk, "SCALARS depth float", "SCALARS depth bit"), ".vtk", "of type 'bit'");
  expect(replaced(modern, "0 4 7", "0 9 7"), ".vtk", "offset of cell 1 is out of order");
  expect(medit, ".meshb", "possible: .mesh .tet .vtk .msh .vtu");
  expect(medit, ".obj", "as tets: the extension is '.obj'");
}

TEST(TetFiles, RealOnesAreRead) {
  LITTORAL_NEEDS_SHARED("data/tets/bunny.mesh");
  const auto data = test::shared() / "data";
  const io::TetFile bunny = io::read_tets(data / "tets/bunny.mesh");
  EXPECT_EQ(bunny.mesh.n_vertices(), 5433);
  EXPECT_EQ(bunny.mesh.n_tets(), 34055);
  EXPECT_EQ(bunny.triangles.rows(), 6966);
  EXPECT_EQ(io::read_tets(data / "generated/tets/cube.mesh").mesh.n_tets(), 384);
  EXPECT_THROW(io::read_tets(data / "generated/tets/truncated.mesh"), InputError);
}

}  // namespace
}  // namespace littoral
