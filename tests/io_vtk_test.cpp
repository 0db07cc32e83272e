// VTK's files of surfaces, clouds and grids, legacy and as XML; Medit's of surfaces.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "io/formats.h"
#include "io/read.h"
#include "io/surface/surface_writers.h"
#include "littoral/error.h"
#include "space_helpers.h"
#include "surface_bytes.h"

namespace littoral {
namespace {

using ::testing::HasSubstr;

const std::string points_of_five = "0 0 0 1 0 0 1 1 0 0 1 0 0.5 0.5 1\n";
const std::string polydata_begin =
    "# vtk DataFile Version 3.0\na roof\nASCII\nDATASET POLYDATA\nPOINTS 5 float\n" +
    points_of_five;
const std::string polydata =
    polydata_begin +
    "VERTICES 1 2\n1 4\nLINES 2 7\n3 0 1 2\n2 2 3\nPOLYGONS 2 9\n4 0 3 2 1\n3 0 1 4\n"
    "TRIANGLE_STRIPS 1 5\n4 1 2 4 3\nPOINT_DATA 5\nNORMALS n float\n"
    "0 0 1 0 0 1 0 0 1 0 0 1 0 0 2\nSCALARS depth double 1\nLOOKUP_TABLE default\n0 1 2 3 4\n"
    "CELL_DATA 6\nSCALARS part int\nLOOKUP_TABLE default\n1 1 1 2 2 2\n";
const std::string modern_polydata =
    "# vtk DataFile Version 5.1\na roof\nASCII\nDATASET POLYDATA\nPOINTS 5 double\n" +
    points_of_five +
    "METADATA\nINFORMATION 0\n\nVERTICES 2 1\nOFFSETS vtktypeint64\n0 1\nCONNECTIVITY "
    "vtktypeint64\n4\nLINES 3 5\nOFFSETS vtktypeint64\n0 3 5\nCONNECTIVITY vtktypeint64\n"
    "0 1 2 2 3\nPOLYGONS 3 7\nOFFSETS vtktypeint64\n0 4 7\nCONNECTIVITY vtktypeint64\n"
    "0 3 2 1 0 1 4\nTRIANGLE_STRIPS 2 4\nOFFSETS vtktypeint64\n0 4\nCONNECTIVITY vtktypeint64\n"
    "1 2 4 3\nPOINT_DATA 5\nFIELD FieldData 2\nNormals 3 5 float\n0 0 1 0 0 1 0 0 1 0 0 1 0 0 2\n"
    "depth 1 5 double\n0 1 2 3 4\n";
const std::string vtp =
    "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"0.1\">\n<PolyData>"
    "<Piece NumberOfPoints=\"5\" NumberOfVerts=\"1\" NumberOfLines=\"2\" NumberOfStrips=\"1\" "
    "NumberOfPolys=\"2\">\n<PointData Normals=\"Normals\">"
    "<DataArray type=\"Float32\" Name=\"Normals\" NumberOfComponents=\"3\" format=\"ascii\">"
    "0 0 1 0 0 1 0 0 1 0 0 1 0 0 2</DataArray>"
    "<DataArray type=\"Float32\" Name=\"depth\" format=\"ascii\">0 1 2 3 4</DataArray></PointData>"
    "\n<Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">\n" +
    points_of_five +
    "</DataArray></Points>\n<Verts>"
    "<DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">4</DataArray>"
    "<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">1</DataArray></Verts>\n<Lines>"
    "<DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">0 1 2 2 3</DataArray>"
    "<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">3 5</DataArray></Lines>\n<Strips>"
    "<DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">1 2 4 3</DataArray>"
    "<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">4</DataArray></Strips>\n<Polys>"
    "<DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">0 3 2 1 0 1 4</DataArray>"
    "<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">4 7</DataArray></Polys>\n"
    "</Piece></PolyData></VTKFile>\n";

void expect_roof(const PolygonSoup& soup) {
  ASSERT_EQ(soup.n_vertices(), 5);
  EXPECT_EQ(Vec3(soup.points.row(4)), Vec3(0.5, 0.5, 1));
  ASSERT_EQ(soup.n_faces(), 4);
  // Every second triangle of a strip is turned, so that all have the sense of the first.
  EXPECT_EQ(soup.corners, (std::vector<int>{0, 3, 2, 1, 0, 1, 4, 1, 2, 4, 2, 3, 4}));
  EXPECT_EQ(soup.lines, (std::vector<std::vector<int>>{{0, 1, 2}, {2, 3}}));
  ASSERT_EQ(soup.normals.rows(), 5);
  EXPECT_EQ(Vec3(soup.normals.row(4)), Vec3(0, 0, 2));
  ASSERT_EQ(soup.scalars.size(), 1u);
  EXPECT_EQ(soup.scalars.at("depth"), VecX::LinSpaced(5, 0, 4));
}

TEST(VtkSurfaces, EveryFormatHoldsTheSameRoof) {
  expect_roof(test::read(polydata, ".vtk"));
  expect_roof(test::read(modern_polydata, ".vtk"));
  expect_roof(test::read(vtp, ".vtp"));
}

TEST(VtkSurfaces, EmptyArraysMayBeEmptyElements) {
  std::string text = vtp;
  const auto replace = [&](const std::string& part, const std::string& by) {
    const std::size_t at = text.find(part);
    ASSERT_NE(at, std::string::npos) << part;
    text.replace(at, part.size(), by);
  };
  replace("NumberOfVerts=\"1\"", "NumberOfVerts=\"0\"");
  replace("NumberOfLines=\"2\"", "NumberOfLines=\"0\"");
  replace("format=\"ascii\">0 1 2 2 3</DataArray>", "format=\"ascii\"/>");
  replace("format=\"ascii\">3 5</DataArray>", "format=\"binary\" />");
  const PolygonSoup soup = test::read(text, ".vtp");
  EXPECT_EQ(soup.n_faces(), 4);
  EXPECT_TRUE(soup.lines.empty());
  replace("NumberOfLines=\"0\"", "NumberOfLines=\"2\"");
  EXPECT_EQ(test::error_of(text, ".vtp"), "a.vtp: the array 'offsets' is empty");
}

TEST(VtkSurfaces, PolygonsOfAnUnstructuredGrid) {
  const PolygonSoup soup = test::read(
      "# vtk DataFile Version 2.0\nflat\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 float\n" +
          points_of_five + "CELLS 2 9\n4 0 1 2 3\n3 0 1 4\nCELL_TYPES 2\n9\n5\n",
      ".vtk");
  EXPECT_EQ(soup.corners, (std::vector<int>{0, 1, 2, 3, 0, 1, 4}));
}

TEST(VtkSurfaces, WithoutFacesACloudWithNormals) {
  const PolygonSoup cloud = test::read(
      polydata_begin + "POINT_DATA 5\nNORMALS n float\n0 0 1 0 0 1 0 0 1 0 0 1 0 0 2\n", ".vtk");
  EXPECT_EQ(cloud.n_faces(), 0);
  EXPECT_EQ(cloud.normals.rows(), 5);
}

TEST(VtkSurfaces, WhatIsWrittenIsRead) {
  PolygonSoup soup = test::read(polydata, ".vtk");
  std::ostringstream out;
  io::write_vtp(out, soup, "depth");
  const PolygonSoup again = test::read(out.str(), ".vtp");
  EXPECT_EQ(again.points, soup.points);
  EXPECT_EQ(again.corners, soup.corners);
  EXPECT_EQ(again.face_offsets, soup.face_offsets);
  EXPECT_EQ(again.lines, soup.lines);
  EXPECT_EQ(again.normals, soup.normals);
  EXPECT_EQ(again.scalars, soup.scalars);
}

TEST(VtkSurfaces, WhatHasNoValuesIsWrittenAsItIs) {
  const PolygonSoup roof = test::read(polydata, ".vtk");
  PolygonSoup bare;
  bare.points = roof.points;
  bare.face_offsets = roof.face_offsets;
  bare.corners = roof.corners;
  std::ostringstream out;
  io::write_vtp(out, bare, "distance");
  EXPECT_THAT(out.str(), ::testing::Not(HasSubstr("Scalars=")));
  const PolygonSoup again = test::read(out.str(), ".vtp");
  EXPECT_EQ(again.points, bare.points);
  EXPECT_EQ(again.corners, bare.corners);
  EXPECT_TRUE(again.scalars.empty());
}

// Programs of VTK draw points that are vertices, and no others.
TEST(VtkSurfaces, PointsAloneAreVertices) {
  PolygonSoup cloud;
  cloud.points = test::read(polydata, ".vtk").points;
  std::ostringstream out;
  io::write_vtp(out, cloud, "distance");
  EXPECT_THAT(out.str(), HasSubstr("NumberOfVerts=\"5\""));
  const PolygonSoup again = test::read(out.str(), ".vtp");
  EXPECT_EQ(again.points, cloud.points);
  EXPECT_EQ(again.n_faces(), 0);
}

const std::string grid_begin =
    "# vtk DataFile Version 3.0\na grid\nASCII\nDATASET STRUCTURED_POINTS\n";
const std::string grid = grid_begin +
                         "DIMENSIONS 3 2 2\nORIGIN -1 0 2\nSPACING 0.5 1 2\nPOINT_DATA 12\n"
                         "SCALARS phi float\nLOOKUP_TABLE default\n0 1 2 3 4 5 6 7 8 9 10 11\n";

TEST(VtkGrids, StructuredPointsAreAVolume) {
  const Volume volume = io::read_volume_bytes(grid, ".vtk", "a.vtk", "");
  EXPECT_EQ(volume.grid.n, (std::array<int, 3>{3, 2, 2}));
  EXPECT_EQ(volume.grid.origin, Vec3(-1, 0, 2));
  EXPECT_EQ(volume.grid.spacing, Vec3(0.5, 1, 2));
  EXPECT_EQ(volume.values, VecX::LinSpaced(12, 0, 11));  // x runs fastest
  EXPECT_EQ(volume.name, "phi");
  const std::string two =
      grid + "SCALARS distance float\nLOOKUP_TABLE default\n" + "5 5 5 5 5 5 5 5 5 5 5 5\n";
  EXPECT_EQ(io::read_volume_bytes(two, ".vtk", "a.vtk", "").name, "distance");
  EXPECT_EQ(io::read_volume_bytes(two, ".vtk", "a.vtk", "phi").values[11], 11);
}

TEST(VtkGrids, NamesHoldBlanksAndTextsArePassedOver) {
  const auto file = [](const std::string& kind, const std::string& texts,
                       const std::string& values) {
    return "# vtk DataFile Version 4.2\nt\n" + kind + "\nDATASET STRUCTURED_POINTS\n" +
           "FIELD FieldData 1\nabout 1 2 string\n" + texts +
           "\nDIMENSIONS 2 1 1\nORIGIN 0 0 0\nSPACING 1 1 1\nPOINT_DATA 2\n"
           "SCALARS my%20depth%C3%A9 unsigned_char 1\nLOOKUP_TABLE default\n" +
           values + "\n";
  };
  const std::string in_two_bytes = "\x81\x04" + std::string(260, '7');  // 260 = 1 << 8 | 4
  for (const std::string& bytes :
       {file("ASCII", "a%20text\nof two lines, 1 2 string\n", "3 4"), file("BINARY",
                                                                           "\xC3"
                                                                           "a\n1" +
                                                                               in_two_bytes,
                                                                           "\3\4")}) {
    const Volume volume = io::read_volume_bytes(bytes, ".vtk", "a.vtk");
    EXPECT_EQ(volume.name, "my depth\xC3\xA9");
    EXPECT_EQ(volume.values, (VecX(2) << 3, 4).finished());
  }
  const std::string whole = file("BINARY",
                                 "\xC3"
                                 "a\n1" +
                                     in_two_bytes,
                                 "\3\4");
  for (std::size_t cut = whole.find("\xC3"
                                    "a");
       cut < whole.find("DIMENSIONS"); ++cut)
    EXPECT_THROW(io::read_volume_bytes(whole.substr(0, cut), ".vtk", "a.vtk"), InputError) << cut;
}

TEST(VtkGrids, AspectRatioIsAnOlderWordForSpacing) {
  const Volume volume =
      io::read_volume_bytes(grid_begin +
                                "DIMENSIONS 2 1 1\nASPECT_RATIO 3 1 1\nORIGIN 0 0 0\nPOINT_DATA 2\n"
                                "SCALARS phi float\nLOOKUP_TABLE default\n7 8\n",
                            ".vtk", "a.vtk", "");
  EXPECT_EQ(volume.grid.spacing, Vec3(3, 1, 1));
}

TEST(VtkFiles, EachIsReadAsWhatItIs) {
  const auto folder = std::filesystem::temp_directory_path();
  const auto is = [&](const std::string& text, io::Kind kind) {
    const auto path = folder / "littoral_any.vtk";
    std::ofstream(path) << text;
    const bool held = io::holds(path, kind);
    std::filesystem::remove(path);
    return held;
  };
  EXPECT_TRUE(is(polydata, io::Kind::surface));
  EXPECT_FALSE(is(polydata, io::Kind::tets));
  EXPECT_FALSE(is(polydata, io::Kind::volume));
  EXPECT_TRUE(is(grid, io::Kind::volume));
  EXPECT_FALSE(is(grid, io::Kind::surface));
}

TEST(VtkFiles, ErrorsSayWhatIsWrong) {
  const auto surface = [](std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return test::message_of([&] { test::read(text.replace(at, from.size(), to), ".vtk"); });
  };
  EXPECT_THAT(surface(polydata, "POLYDATA", "RECTILINEAR_GRID"),
              HasSubstr("'RECTILINEAR_GRID'; UNSTRUCTURED_GRID, POLYDATA and STRUCTURED_POINTS"));
  EXPECT_THAT(surface(polydata, "3 0 1 4", "3 0 1 5"), HasSubstr("refers to vertex 5"));
  EXPECT_THAT(surface(polydata, "3 0 1 4\n", "2 0 1\n"), HasSubstr("TRIANGLE_STRIPS"));
  EXPECT_THAT(surface(polydata, "POLYGONS 2 9", "POLYGONS 2 6"), HasSubstr("POLYGONS ends"));
  EXPECT_THAT(surface(polydata, "LINES 2 7\n3 0 1 2", "LINES 2 7\n3 0 1 x"), HasSubstr("'x'"));
  EXPECT_THAT(surface(modern_polydata, "0 4 7", "0 8 7"), HasSubstr("out of order"));
  EXPECT_THAT(surface(grid, "0 1 2", "0 1 2"), HasSubstr("it holds a volume and no surface"));

  const auto volume = [](std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
    return test::message_of([&] { io::read_volume_bytes(text, ".vtk", "a.vtk", ""); });
  };
  EXPECT_THAT(volume(grid, "3 2 2", "3 2"), HasSubstr("number 2 of dimensions"));
  EXPECT_THAT(volume(grid, "3 2 2", "3 2 0.5"), HasSubstr("whole numbers"));
  EXPECT_THAT(volume(grid, "3 2 2", "90000 90000 90000"), HasSubstr("nodes"));
  EXPECT_THAT(volume(grid, "0.5 1 2", "0 1 2"), HasSubstr("spacing"));
  EXPECT_THAT(volume(grid, "DIMENSIONS 3 2 2\n", ""), HasSubstr("no DIMENSIONS"));
  EXPECT_THAT(volume(grid, "POINT_DATA", "DIMENSIONS 3 1 2\nPOINT_DATA"),
              HasSubstr("keyword 'dimensions' appears twice"));
  EXPECT_THAT(volume(polydata, "a roof", "a roof"), HasSubstr("it holds no volume"));
  EXPECT_THAT(volume(grid, "POINT_DATA 12", "CELL_DATA 12"),
              HasSubstr("no field with one value per node"));
  EXPECT_THAT(test::message_of([] { io::read_tets_bytes(polydata, ".vtk", "a.vtk"); }),
              HasSubstr("the file has no tets"));
  EXPECT_THAT(test::message_of([] { io::read_tets_bytes(grid, ".vtk", "a.vtk"); }),
              HasSubstr("it holds a volume and no tets"));

  std::string text = vtp;
  text.replace(text.find("NumberOfPolys=\"2\""), 17, "NumberOfPolys=\"3\"");
  EXPECT_THAT(test::error_of(text, ".vtp"), HasSubstr("fewer numbers than the 3"));
  EXPECT_THAT(test::message_of([&] { test::read(vtp, ".vtu"); }), HasSubstr("'PolyData'"));
}

TEST(MeditSurfaces, TrianglesAndQuadsWithoutSolids) {
  const std::string flat =
      "MeshVersionFormatted 1\nDimension 3\nVertices 5\n0 0 0 1\n1 0 0 1\n1 1 0 1\n0 1 0 1\n"
      "0.5 0.5 1 1\nTriangles 1\n1 2 5 3\nQuadrilaterals 1\n1 4 3 2 0\nEnd\n";
  const PolygonSoup soup = test::read(flat, ".mesh");
  EXPECT_EQ(soup.corners, (std::vector<int>{0, 1, 4, 0, 3, 2, 1}));
  const std::string solid =
      flat.substr(0, flat.find("Triangles")) + "Tetrahedra 1\n1 2 3 5 0\nEnd\n";
  EXPECT_THAT(test::error_of(solid, ".mesh"), HasSubstr("it holds 1 tets and no faces"));
}

}  // namespace
}  // namespace littoral
