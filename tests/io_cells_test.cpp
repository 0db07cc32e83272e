// Files of cells: how solids are cut into tets, Gmsh's files, VTK's XML.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <filesystem>
#include <map>
#include <numeric>
#include <random>

#include "io/formats.h"
#include "io/read.h"
#include "io/tet/cell_mesh.h"
#include "io/tet/tet_formats.h"
#include "littoral/error.h"
#include "space_helpers.h"
#include "surface_bytes.h"
#include "tet_helpers.h"

namespace littoral {
namespace {

using io::CellMesh;
using ::testing::HasSubstr;

double tet_volume(const TetMesh& mesh, int t) {
  const auto at = [&](int k) { return Vec3(mesh.points.row(mesh.tets(t, k))); };
  return (at(1) - at(0)).cross(at(2) - at(0)).dot(at(3) - at(0)) / 6;
}

/// How many tets have each triangle.
std::map<std::array<int, 3>, int> faces_of_tets(const TetMesh& mesh) {
  std::map<std::array<int, 3>, int> faces;
  for (int t = 0; t < mesh.n_tets(); ++t)
    for (int k = 0; k < 4; ++k) {
      std::array<int, 3> face{};
      for (int j = 0; j < 3; ++j) face[j] = mesh.tets(t, (k + j) % 4);
      std::ranges::sort(face);
      ++faces[face];
    }
  return faces;
}

// A unit cube of n^3 cells over points with numbers in any order: in some columns prisms, of the
// other cells some six pyramids.
CellMesh mixed_cube(int n, unsigned seed) {
  std::mt19937 random(seed);
  const int nodes = (n + 1) * (n + 1) * (n + 1), all = nodes + n * n * n;
  std::vector<int> numbers(static_cast<std::size_t>(all));
  std::iota(numbers.begin(), numbers.end(), 0);
  std::ranges::shuffle(numbers, random);
  CellMesh cells;
  cells.name = "cube";
  cells.points = MatX3::Zero(all, 3);
  const auto node = [&](int i, int j, int k) {
    const int v = numbers[(i * (n + 1) + j) * (n + 1) + k];
    cells.points.row(v) = Eigen::RowVector3d(i, j, k) / n;
    return v;
  };
  int centre = nodes;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const bool column_of_prisms = random() % 3 == 0;
      for (int k = 0; k < n; ++k) {
        const std::array<int, 8> v{node(i, j, k),
                                   node(i + 1, j, k),
                                   node(i + 1, j + 1, k),
                                   node(i, j + 1, k),
                                   node(i, j, k + 1),
                                   node(i + 1, j, k + 1),
                                   node(i + 1, j + 1, k + 1),
                                   node(i, j + 1, k + 1)};
        const int tip = numbers[centre++];
        cells.points.row(tip) = Eigen::RowVector3d(i + 0.5, j + 0.5, k + 0.5) / n;
        if (column_of_prisms) {
          cells.add(0, CellMesh::prism, std::array{v[0], v[1], v[2], v[4], v[5], v[6]});
          cells.add(0, CellMesh::prism, std::array{v[0], v[2], v[3], v[4], v[6], v[7]});
        } else if (random() % 2 == 0) {
          // Bases seen from within, tips there.
          for (const auto& base : {std::array{0, 1, 2, 3},
                                   {4, 7, 6, 5},
                                   {0, 4, 5, 1},
                                   {1, 5, 6, 2},
                                   {2, 6, 7, 3},
                                   {3, 7, 4, 0}})
            cells.add(0, CellMesh::pyramid,
                      std::array{v[base[0]], v[base[1]], v[base[2]], v[base[3]], tip});
        } else {
          cells.add(0, CellMesh::hexahedron, v);
        }
      }
    }
  return cells;
}

TEST(Cells, TetsOfMixedCellsFillThemAndFitTogether) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const TetMesh mesh = mixed_cube(3, seed).as_tets().mesh;
    double volume = 0;
    for (int t = 0; t < mesh.n_tets(); ++t) {
      EXPECT_GT(tet_volume(mesh, t), 1e-6);
      volume += tet_volume(mesh, t);
    }
    EXPECT_NEAR(volume, 1, 1e-12);
    double area = 0;
    for (const auto& [face, count] : faces_of_tets(mesh)) {
      ASSERT_LE(count, 2);
      if (count == 2) continue;
      const Vec3 a = mesh.points.row(face[0]), b = mesh.points.row(face[1]),
                 c = mesh.points.row(face[2]);
      area += 0.5 * (b - a).cross(c - a).norm();
      // It lies in a side of the cube.
      bool outside = false;
      for (int k = 0; k < 3; ++k)
        outside = outside || (a[k] == b[k] && b[k] == c[k] && (a[k] == 0 || a[k] == 1));
      EXPECT_TRUE(outside);
    }
    EXPECT_NEAR(area, 6, 1e-12);
  }
}

TEST(Cells, VoxelsPixelsStripsAndCollapsedCells) {
  CellMesh cells;
  cells.name = "a";
  cells.points = MatX3::Zero(8, 3);
  for (int v = 0; v < 8; ++v) cells.points.row(v) << v % 2, v / 2 % 2, v / 4;
  cells.add(0, CellMesh::voxel, std::array{0, 1, 2, 3, 4, 5, 6, 7});
  cells.add(1, CellMesh::pixel, std::array{0, 1, 2, 3});
  cells.add(2, 3, std::array{0, 1});
  const io::TetFile file = cells.as_tets();
  ASSERT_EQ(file.mesh.n_tets(), 6);
  for (int t = 0; t < 6; ++t) EXPECT_NEAR(tet_volume(file.mesh, t), 1.0 / 6, 1e-15);
  // The square is cut as the voxel's side is.
  const auto faces = faces_of_tets(file.mesh);
  ASSERT_EQ(file.triangles.rows(), 2);
  for (const auto& t : file.triangles.rowwise()) {
    std::array<int, 3> face{t[0], t[1], t[2]};
    std::ranges::sort(face);
    EXPECT_EQ(faces.at(face), 1);
  }

  CellMesh flat;
  flat.points = MatX3::Zero(6, 3);
  flat.add(0, CellMesh::triangle_strip, std::array{0, 1, 2, 3});
  EXPECT_EQ(flat.faces.corners, (std::vector<int>{0, 1, 2, 1, 3, 2}));
  // A hexahedron with two sides pulled together is a prism.
  flat.add(1, CellMesh::hexahedron, std::array{0, 1, 2, 2, 3, 4, 5, 5});
  EXPECT_EQ(flat.tets.size(), 12u);
}

// Every type of element over points with numbers that have gaps, as each version writes them.
struct MshSample {
  int version = 41;
  bool binary = false, big = false;
  std::string out;

  template <class T>
  void raw(T value) {
    auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(value);
    if (big) std::ranges::reverse(bytes);
    out.append(bytes.data(), bytes.size());
  }
  template <class T>
  void number(T value) {
    if (binary) return raw(value);
    std::ostringstream text;
    text << value << ' ';
    out += text.str();
  }
  void small(int value) { number<std::int32_t>(value); }
  void large(int value) { number<std::int64_t>(value); }
  void tag(int value) { version == 41 ? large(value) : small(value); }

  std::string bytes(const std::vector<Vec3>& points,
                    const std::vector<std::pair<int, std::vector<int>>>& elements) {
    out = "$MeshFormat\n" +
          std::string(version == 22   ? "2.2"
                      : version == 40 ? "4"
                                      : "4.1") +
          (binary ? " 1 8\n" : " 0 8\n");
    if (binary) raw<std::int32_t>(1), out += "\n";
    out += "$EndMeshFormat\n$PhysicalNames\n1\n3 1 \"all\"\n$EndPhysicalNames\n$Nodes\n";
    const int n = static_cast<int>(points.size());
    const auto node = [](int v) { return 10 + 3 * v; };
    const auto place = [&](int v) {
      for (const double x : points[v]) number(x);
    };
    if (version == 22) {
      out += std::to_string(n) + "\n";
      for (int v = 0; v < n; ++v) small(node(v)), place(v);
    } else {
      large(1), large(n);
      if (version == 41) large(node(0)), large(node(n - 1));
      small(3), small(1), small(0), large(n);
      if (version == 41)
        for (int v = 0; v < n; ++v) large(node(v));
      for (int v = 0; v < n; ++v) {
        if (version == 40) small(node(v));
        place(v);
      }
    }
    out += "\n$EndNodes\n$Elements\n";
    const int count = static_cast<int>(elements.size());
    if (version == 22) {
      out += std::to_string(count) + "\n";
    } else {
      large(count), large(count);
      if (version == 41) large(1), large(count);
    }
    for (int e = 0; e < count; ++e) {
      const auto& [type, corners] = elements[e];
      if (version == 22) {
        if (!binary) small(e + 1);
        small(type);
        if (binary) small(1);
        small(2);
        if (binary) small(e + 1);
        small(7), small(8);
      } else {
        small(3), small(1), small(type), large(1), tag(e + 1);
      }
      for (const int v : corners) tag(node(v));
    }
    out += "\n$EndElements\n$NodeData\n1\n\"depth\"\n1\n0.0\n3\n0\n1\n" + std::to_string(n) + "\n";
    for (int v = 0; v < n; ++v) small(node(v)), number(0.5 * v);
    out += "\n$EndNodeData\n";
    return out;
  }
};

const std::vector<Vec3> msh_points{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},     {0, 0, 1},
                                   {1, 0, 1}, {1, 1, 1}, {0, 1, 1}, {2, 0.5, 0.5}, {0.5, 0.5, 2}};
const std::vector<std::pair<int, std::vector<int>>> msh_elements{{15, {0}},
                                                                 {1, {0, 1}},
                                                                 {2, {0, 2, 1}},
                                                                 {3, {0, 1, 5, 4}},
                                                                 {5, {0, 1, 2, 3, 4, 5, 6, 7}},
                                                                 {7, {1, 2, 6, 5, 8}},
                                                                 {4, {4, 5, 6, 9}}};

TEST(Msh, EveryVersionHoldsTheSame) {
  io::TetFile first;
  for (const int version : {22, 40, 41})
    for (const auto& [binary, big] : {std::pair(false, false), {true, false}, {true, true}}) {
      const std::string bytes = MshSample{version, binary, big, ""}.bytes(msh_points, msh_elements);
      SCOPED_TRACE(std::to_string(version) + (binary ? " binary" : ""));
      const io::TetFile file = io::CellsAs<io::read_msh>::tets(bytes, "a.msh");
      ASSERT_EQ(file.mesh.n_vertices(), 10);
      EXPECT_EQ(Vec3(file.mesh.points.row(8)), msh_points[8]);
      EXPECT_EQ(file.mesh.n_tets(), 6 + 2 + 1);
      EXPECT_EQ(file.triangles.rows(), 3);
      EXPECT_EQ(file.scalars.at("depth"), VecX::LinSpaced(10, 0, 4.5));
      if (first.mesh.n_tets() == 0) first = file;
      EXPECT_EQ(file.mesh.tets, first.mesh.tets);
      // Cut anywhere it is an error, or what follows the elements is missing.
      for (std::size_t cut = 0; cut < bytes.size(); cut += 3) {
        try {
          const io::TetFile part = io::CellsAs<io::read_msh>::tets(bytes.substr(0, cut), "a.msh");
          EXPECT_TRUE(part.mesh.n_tets() == 9 || part.mesh.n_tets() == 0) << cut;
        } catch (const InputError&) {
        }
      }
    }
}

TEST(Msh, FlatElementsAreASurface) {
  const std::vector<std::pair<int, std::vector<int>>> flat{{2, {0, 2, 1}}, {3, {0, 1, 5, 4}}};
  const std::string bytes = MshSample{}.bytes(msh_points, flat);
  const PolygonSoup soup = test::read(bytes, ".msh");
  EXPECT_EQ(soup.corners, (std::vector<int>{0, 2, 1, 0, 1, 5, 4}));
  EXPECT_TRUE(soup.scalars.contains("depth"));
  const std::string solid = MshSample{}.bytes(msh_points, {{4, {4, 5, 6, 9}}});
  EXPECT_THAT(test::error_of(solid, ".msh"), HasSubstr("it holds 1 tets and no faces"));
  EXPECT_THAT(test::message_of([&] { io::read_tets_bytes(bytes, ".msh", "a.msh"); }),
              HasSubstr("the file has no tets"));
}

/// The text with the first `from` replaced.
std::string replaced_in(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

/// What a reader says of a file in which `from` stands as `to`.
template <class Read>
std::string said_with(const Read& read, const std::string& text, const std::string& name,
                      const std::string& from, const std::string& to) {
  return test::message_of([&] { read(replaced_in(text, from, to), name); });
}

TEST(Msh, ErrorsNameTheElement) {
  const std::string text = MshSample{22, false, false, ""}.bytes(msh_points, msh_elements);
  const auto expect = [&](const std::string& from, const std::string& to, const char* said) {
    EXPECT_THAT(said_with(io::CellsAs<io::read_msh>::tets, text, "a.msh", from, to),
                HasSubstr(said))
        << from;
  };
  expect("2.2 0 8", "1.0 0 8", "version 1; 2 and 4 are read");
  expect("2.2 0 8", "2.2 1 4", "numbers of 4 bytes");
  expect("$Nodes\n10", "$Nodes\n2000000000", "promises 2000000000 nodes");
  expect("$Nodes\n10", "$Nodes\n-1", "negative number of nodes");
  expect("$Nodes\n10", "$Nodes\n9", "expected $EndNodes");
  expect("$Nodes\n10\n10 ", "$Nodes\n10\n13 ", "node 13 appears twice");
  expect("$Elements\n7", "$Elements\n70000000", "promises 70000000 elements");
  expect("7 4 2 7 8 22", "7 4 2 7 8 23", "element 7 refers to node 23, which is not there");
  expect("7 4 2 7 8", "7 11 2 7 8", "elements of type 11; triangles");
  expect("0.5 0.5 2 ", "0.5 y 2 ", "expected a coordinate of a node, found 'y'");
  expect("$EndNodes", "$EndNode", "expected $EndNodes");
  expect("$PhysicalNames", "PhysicalNames", "expected the begin of a section");
}

const std::string vtu =
    "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"0.1\">\n"
    "<UnstructuredGrid><Piece NumberOfPoints=\"5\" NumberOfCells=\"2\">\n<PointData>"
    "<DataArray type=\"Float32\" Name=\"depth\" format=\"ascii\">0 1 2 3 "
    "4</DataArray></PointData>\n"
    "<Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">\n"
    "0 0 0 1 0 0 1 1 0 0 1 0 0.5 0.5 1</DataArray></Points>\n<Cells>"
    "<DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">0 1 2 3 4 0 1 4</DataArray>\n"
    "<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">5 8</DataArray>\n"
    "<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">14 5</DataArray>\n"
    "</Cells></Piece></UnstructuredGrid></VTKFile>\n";

TEST(Vtu, TextAndWhatIsWritten) {
  const io::TetFile file = io::CellsAs<io::read_vtu>::tets(vtu, "a.vtu");
  EXPECT_EQ(file.mesh.n_tets(), 2);
  EXPECT_EQ(file.triangles, (MatX3i(1, 3) << 0, 1, 4).finished());
  EXPECT_EQ(file.scalars.at("depth"), VecX::LinSpaced(5, 0, 4));

  TetMesh mesh = test::tet_box(2);
  mesh.points.array() += 1.0 / 3;
  const VecX values = mesh.points.rowwise().norm();
  const auto path = std::filesystem::path(testing::TempDir()) / "littoral_cells.vtu";
  io::write_tets(path, mesh, values, "a & b");
  const io::TetFile back = io::read_tets(path);
  EXPECT_EQ(back.mesh.points, mesh.points);
  EXPECT_EQ(back.mesh.tets, mesh.tets);
  EXPECT_EQ(back.scalars.at("a & b"), values);
  EXPECT_TRUE(io::holds(path, io::Kind::tets));
  const std::string bytes = io::read_bytes(path);
  for (std::size_t cut = 0; cut < bytes.size() - 40; cut += 31)
    EXPECT_THROW(io::read_tets_bytes(bytes.substr(0, cut), ".vtu", "a"), InputError) << cut;
  std::filesystem::remove(path);

  const PolygonSoup flat = test::read(
      replaced_in(vtu, "\"types\" format=\"ascii\">14 5", "\"types\" format=\"ascii\">7 5"),
      ".vtu");
  EXPECT_EQ(flat.face_offsets, (std::vector<int>{0, 5, 8}));
}

TEST(Vtu, ErrorsNameTheElement) {
  const auto expect = [&](const std::string& from, const std::string& to, const char* said) {
    EXPECT_THAT(said_with(io::CellsAs<io::read_vtu>::tets, vtu, "a.vtu", from, to), HasSubstr(said))
        << from;
  };
  expect("0 1 2 3 4 0 1 4", "0 1 2 3 4 0 1 5", "cell 1 refers to vertex 5, the file has 5");
  expect("0 1 2 3 4 0 1 4", "0 1 2 3 -4 0 1 4", "cell 0 refers to vertex -4");
  expect("5 8", "9 8", "the offset of cell 1 is out of order");
  expect("5 8", "4 8", "cell 0 of type 14 must have 5 corners, it has 4");
  expect("5 8", "5 90000", "fewer numbers than");
  expect("5 8", "5 900000000", "the offset of cell 1 is out of order");
  expect("14 5<", "42 5<", "cell 0 is of type 42");
  expect("14 5<", "14 nan<", "cell 1");
  expect("NumberOfPoints=\"5\"", "NumberOfPoints=\"500000000000\"", "promises 500000000000");
  expect("NumberOfCells=\"2\"", "NumberOfCells=\"-2\"", "no NumberOfCells");
  expect("\"types\"", "\"kinds\"", "there is no array 'types'");
  expect(
      "UnstructuredGrid\" v", "PolyData\" v",
      "VTK data of type 'PolyData', not UnstructuredGrid as its extension says; its contents look "
      "like .vtp: name it so");
  expect("UnstructuredGrid\" v", "RectilinearGrid\" v", "save it as UnstructuredGrid");
  expect("0.5 0.5 1<", "0.5 0.5<", "fewer numbers than the 15 expected");
}

}  // namespace
}  // namespace littoral
