// 3MF: items and components placed by their transforms, units, parts; what is written and refused.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <limits>
#include <sstream>

#include "io/read.h"
#include "io/write.h"
#include "io/zip_archive.h"
#include "littoral/error.h"
#include "space_helpers.h"
#include "surface_bytes.h"

namespace littoral::io {
namespace {

using ::testing::HasSubstr;

const std::string printed_mesh =
    "<mesh><vertices><vertex x=\"0\" y=\"0\" z=\"0\"/><vertex x=\"1\" y=\"0\" z=\"0\"/>"
    "<vertex x=\"0\" y=\"1\" z=\"0\"/></vertices><triangles>"
    "<triangle v1=\"0\" v2=\"1\" v3=\"2\"/></triangles></mesh>";

std::string model_text(const std::string& objects, const std::string& items,
                       const std::string& head = "unit=\"centimeter\"") {
  return "<?xml version=\"1.0\"?><!-- a comment --><model " + head +
         " xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\" "
         "xmlns:p=\"http://schemas.microsoft.com/3dmanufacturing/production/2015/06\" "
         "xmlns:b=\"http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/"
         "02\"><resources>" +
         objects + "</resources><build>" + items + "</build></model>";
}

std::string archive_of(const std::vector<std::pair<std::string, std::string>>& members) {
  std::ostringstream out;
  write_zip(out, members);
  return out.str();
}

std::string printed(const std::string& objects, const std::string& items,
                    const std::string& head = "unit=\"centimeter\"") {
  return archive_of({{"3D/3dmodel.model", model_text(objects, items, head)}});
}

const std::string object_1 = "<object id=\"1\">" + printed_mesh + "</object>";

// A component turned by 90 degrees about z and moved by 1; the item then doubles and moves by 10.
TEST(ThreeMf, ItemsComponentsAndUnits) {
  const PolygonSoup soup = test::read(
      printed(object_1 + "<object id=\"2\"><components><component objectid=\"1\" "
                         "transform=\"0 1 0 -1 0 0 0 0 1 1 0 0\"/></components></object>",
              "<item objectid=\"2\" transform=\"2 0 0 0 2 0 0 0 2 10 0 0\"/>"
              "<item objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 -1 0 0 0\"/>"),
      ".3mf");
  ASSERT_EQ(soup.n_faces(), 2);
  // (1,0,0) -> (0,1,0) + (1,0,0) -> (12,2,0), in millimetres.
  EXPECT_EQ(soup.points.row(1), Eigen::RowVector3d(120, 20, 0));
  EXPECT_EQ(soup.points.row(2), Eigen::RowVector3d(100, 0, 0));
  EXPECT_EQ(soup.points.row(4), Eigen::RowVector3d(10, 0, 0));
  // A mirror image is turned.
  EXPECT_EQ(soup.face(1)[1], 5);
}

TEST(ThreeMf, PartsByTheirRelationships) {
  const std::string model = model_text(
      "<object id=\"1\"><components><component objectid=\"1\" p:path=\"/3D/Objects/a.model\"/>"
      "</components></object>",
      "<item objectid=\"1\"/>", "requiredextensions=\"p\"");
  const std::string relations =
      "<Relationships><Relationship Target=\"/other/name.model\" Id=\"r\" "
      "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>";
  const std::string bytes = archive_of({{"_rels/.rels", relations},
                                        {"other/name.model", model},
                                        {"3D/Objects/a.model", model_text(object_1, "", "")}});
  EXPECT_EQ(test::read(bytes, ".3mf").points.row(1), Eigen::RowVector3d(1, 0, 0));
}

TEST(ThreeMf, ErrorsNameTheElement) {
  const auto error = [](const std::string& bytes) {
    return test::message_of([&] { test::read(bytes, ".3mf"); });
  };
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string object = object_1;
    const std::size_t at = object.find(from);
    EXPECT_NE(at, std::string::npos);
    return error(printed(object.replace(at, from.size(), to), "<item objectid=\"1\"/>"));
  };
  EXPECT_THAT(with("v3=\"2\"", "v3=\"3\""),
              HasSubstr("object 1, triangle 0 refers to vertex 3, it has 3"));
  EXPECT_THAT(with("v3=\"2\"", "v3=\"-1\""), HasSubstr("refers to vertex -1"));
  EXPECT_THAT(with("v3=\"2\"", ""), HasSubstr("object 1, triangle 0 has no whole number 'v3'"));
  EXPECT_THAT(with("y=\"1\"", "y=\"one\""), HasSubstr("object 1, vertex 2: 'y' is 'one'"));
  EXPECT_THAT(with("id=\"1\"", "id=\"x\""), HasSubstr("an object has no whole number 'id'"));
  EXPECT_THAT(error(printed(object_1 + object_1, "")), HasSubstr("object 1 appears twice"));
  EXPECT_THAT(error(printed(object_1, "")), HasSubstr("there is no item to build"));
  EXPECT_THAT(error(printed(object_1, "<item objectid=\"9\"/>")),
              HasSubstr("there is no object 9"));
  EXPECT_THAT(error(printed(object_1, "<item objectid=\"1\" transform=\"1 2 3\"/>")),
              HasSubstr("an item: 'transform' must be 12 numbers"));
  EXPECT_THAT(error(printed(object_1, "<item objectid=\"1\"/>", "unit=\"ell\"")),
              HasSubstr("there is no unit 'ell'"));
  EXPECT_THAT(error(printed(object_1, "<item objectid=\"1\"/>", "requiredextensions=\"b\"")),
              HasSubstr("requires the extension 'http://schemas.microsoft.com/3dmanufa"));
  EXPECT_THAT(error(printed("<object id=\"1\"><components><component objectid=\"1\"/></components>"
                            "</object>",
                            "<item objectid=\"1\"/>")),
              HasSubstr("within each other without end"));
  // Each object two copies of the one before: too many to make.
  std::string doubled = object_1;
  for (int i = 2; i < 60; ++i) {
    const std::string inner = "<component objectid=\"" + std::to_string(i - 1) + "\"/>";
    doubled += "<object id=\"" + std::to_string(i) + "\"><components>" + inner + inner +
               "</components></object>";
  }
  EXPECT_THAT(error(printed(doubled, "<item objectid=\"59\"/>")), HasSubstr("copies"));
  EXPECT_THAT(error(archive_of({{"x", "y"}})), HasSubstr("no part '/3D/3dmodel.model'"));
  EXPECT_THAT(error("solid"), HasSubstr("no zip archive, or a damaged one"));
  EXPECT_THAT(error(archive_of({{"3D/3dmodel.model", "<a/>"}})), HasSubstr("element model"));
  const std::string whole = printed(object_1, "<item objectid=\"1\"/>");
  for (std::size_t cut = 0; cut < whole.size(); cut += 7)
    EXPECT_NE(error(whole.substr(0, cut)), "no error") << cut;
}

TEST(ThreeMf, WrittenFilesReadBack) {
  PolygonSoup soup;
  soup.points = MatX3::Random(4, 3) / 3;
  for (const auto& face : {std::array{0, 1, 2}, {0, 3, 1}}) soup.add_face(face);
  const auto path = std::filesystem::path(testing::TempDir()) / "littoral_written.3mf";
  write_surface(path, soup);
  const PolygonSoup back = read_surface(path);
  EXPECT_EQ(back.points, soup.points);
  EXPECT_EQ(back.corners, soup.corners);
  std::filesystem::remove(path);
  const auto refusal = [&](const PolygonSoup& changed) {
    return test::message_of([&] { write_surface(path, changed); });
  };
  PolygonSoup quad = soup;
  quad.add_face(std::array{0, 1, 2, 3});
  EXPECT_THAT(refusal(quad), HasSubstr("face 2 has 4 corners, 3MF holds triangles only"));
  PolygonSoup needle = soup;
  needle.add_face(std::array{0, 1, 1});
  EXPECT_THAT(refusal(needle), HasSubstr("face 2 has the same vertex twice"));
  PolygonSoup far = soup;
  far.points(3, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(refusal(far), HasSubstr("vertex 3 is not finite"));
  PolygonSoup cloud;
  cloud.points = soup.points;
  EXPECT_THAT(refusal(cloud), HasSubstr("there are no faces"));
}

}  // namespace
}  // namespace littoral::io
