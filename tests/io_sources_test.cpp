// Source readers: both .txt formats, .json, and lines of mesh files.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "io/read.h"
#include "io/sources/source_nodes.h"
#include "littoral/error.h"

namespace littoral::io {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

// Two triangles and a pentagon; edges in the order 01 12 20 | 13 32 | 34 45 56 62.
const char* const mesh_text =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 2 2 0\nv 1 3 0\nv 0 2 0\nv nan 0 0\n"
    "f 1 2 3\nf 2 4 3\nf 3 4 5 6 7\n";

SurfaceMesh mesh() { return SurfaceMesh(read_surface_bytes(mesh_text, ".obj", "m.obj")); }

Sources read_sources_text(const std::string& text, const std::string& extension = ".txt",
                          std::optional<int> base = {}) {
  Report report;
  return read_sources_bytes(text, extension, "a" + extension, mesh(), base, report);
}

std::string error_of_sources(const std::string& text, const std::string& extension = ".txt",
                             std::optional<int> base = {}) {
  try {
    read_sources_text(text, extension, base);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

// A node in short: "v3", "e2 0.25" (its parameter), "f0 a b c".
std::string text_of(const SurfacePoint& p) {
  std::ostringstream out;
  const char* kind = p.on == SurfacePoint::On::vertex ? "v"
                     : p.on == SurfacePoint::On::edge ? "e"
                                                      : "f";
  out << kind << p.element;
  if (p.on == SurfacePoint::On::edge) out << ' ' << p.b[1];
  if (p.on == SurfacePoint::On::face) out << ' ' << p.b[0] << ' ' << p.b[1] << ' ' << p.b[2];
  return out.str();
}

std::vector<std::string> text_of(const std::vector<SurfacePoint>& nodes) {
  std::vector<std::string> all;
  for (const SurfacePoint& p : nodes) all.push_back(text_of(p));
  return all;
}

TEST(IoSources, ReadsSignedHeatText) {
  const Sources s = read_sources_text(
      "# c\nsigned_curve\r\nv 0 # c\ne 1 0.25\ne 2 1 .25\nf 0 .5 .25 .25\nf 1 0.5 0.5\n"
      "signed_curve 1\nv 3\nl 1 2\nunsigned_curve 0\n\nl 1 2 4\nunsigned_point\n#v 99\nv 4\nv 5\n");
  ASSERT_EQ(s.curves.size(), 3u);
  EXPECT_THAT(text_of(s.curves[0].nodes),
              ElementsAre("v0", "e1 0.25", "e1 0.75", "f0 0.5 0.25 0.25", "f1 0.5 0.5 0"));
  EXPECT_TRUE(s.curves[0].is_signed);
  EXPECT_EQ(s.curves[0].origin, "a.txt:3");
  EXPECT_THAT(text_of(s.curves[1].nodes), ElementsAre("v1", "v0", "v3"));
  EXPECT_THAT(text_of(s.curves[2].nodes), ElementsAre("v0", "v1", "v3"));
  EXPECT_FALSE(s.curves[2].is_signed);
  EXPECT_THAT(text_of(s.points), ElementsAre("v4", "v5"));
}

TEST(IoSources, TheIndexBaseOverridesTheFormats) {
  EXPECT_THAT(text_of(read_sources_text("signed_curve\nv 1\nl 2\n", ".txt", 1).curves[0].nodes),
              ElementsAre("v0", "v1"));
  EXPECT_THAT(text_of(read_sources_text("signed_curve\nv 1\nl 2\n", ".txt", 0).curves[0].nodes),
              ElementsAre("v1", "v2"));
  EXPECT_THAT(text_of(read_sources_text("#offset 0\nv 1\nv 2\nl 1 2\n", ".txt", 1).curves[0].nodes),
              ElementsAre("v0", "v1"));
  EXPECT_THAT(text_of(read_sources_text(R"({"points":[{"v":1}]})", ".json", 1).points),
              ElementsAre("v0"));
  EXPECT_EQ(error_of_sources("signed_curve\nv 1\nl 2\n", ".txt", 2),
            "the index base must be 0 or 1, not 2");
}

TEST(IoSources, JoinsTheSegmentsOfWindingText) {
  const Sources s =
      read_sources_text("v 1\nv 2\ne 2 .5\nn 1\nv 4\n#l 1 4\nv 2\nl 2 3\nl 1 2 # c\nl 4 5\n");
  ASSERT_EQ(s.curves.size(), 3u);  // the second point and the fifth are one place, where three meet
  EXPECT_THAT(text_of(s.curves[0].nodes), ElementsAre("v1", "e1 0.5"));
  EXPECT_THAT(text_of(s.curves[1].nodes), ElementsAre("v0", "v1"));
  EXPECT_THAT(text_of(s.curves[2].nodes), ElementsAre("v3", "v1"));
  EXPECT_EQ(s.curves[2].origin, "a.txt:5");
  const Sources joined = read_sources_text("v 1\nv 2\ne 2 .5\nl 2 3\nl 1 2\n");
  ASSERT_EQ(joined.curves.size(), 1u);
  EXPECT_THAT(text_of(joined.curves[0].nodes), ElementsAre("v0", "v1", "e1 0.5"));
}

TEST(IoSources, ChainsSegmentsWhereOneEndsAndOneBegins) {
  const auto chained = [](std::vector<Segment> segments) { return chain(segments, 6); };
  EXPECT_THAT(chained({{1, 2}, {0, 1}, {2, 3}}), ElementsAre(ElementsAre(0, 1, 2, 3)));
  EXPECT_THAT(chained({{1, 2}, {2, 0}, {0, 1}}), ElementsAre(ElementsAre(1, 2, 0, 1)));
  EXPECT_THAT(chained({{0, 1}, {2, 1}}), ElementsAre(ElementsAre(0, 1), ElementsAre(2, 1)));
  EXPECT_THAT(chained({{0, 1}, {1, 2}, {1, 3}}),
              ElementsAre(ElementsAre(0, 1), ElementsAre(1, 2), ElementsAre(1, 3)));
  EXPECT_THAT(chained({{0, 1}, {1, 0}, {0, 2}, {2, 0}}),
              ElementsAre(ElementsAre(0, 1, 0), ElementsAre(0, 2, 0)));
  EXPECT_THAT(chained({{3, 3}, {4, 5}}), ElementsAre(ElementsAre(4, 5), ElementsAre(3, 3)));
}

TEST(IoSources, SaysWhatIsWrongInText) {
  EXPECT_EQ(error_of_sources(""), "a.txt: no sources");
  EXPECT_EQ(error_of_sources("# nothing\n"), "a.txt: no sources");
  EXPECT_EQ(error_of_sources("v 3\nv 4\n"),
            "a.txt:1: nodes with neither a keyword line (signed_curve, unsigned_curve or "
            "unsigned_point) nor segments (l)");
  EXPECT_EQ(error_of_sources("v 3\nsigned_curve\nv 4\n"),
            "a.txt:1: node before any keyword (signed_curve, unsigned_curve or unsigned_point)");
  EXPECT_EQ(error_of_sources("signed_curv\nv 3\nv 4\n"),
            "a.txt:1: unknown record 'signed_curv', expected v, e, l or c, or a keyword "
            "(signed_curve, unsigned_curve or unsigned_point)");
  EXPECT_EQ(error_of_sources("signed_curve\nv 3\nv 4\nsigned_curv\n"),
            "a.txt:4: unknown keyword 'signed_curv', expected signed_curve, unsigned_curve or "
            "unsigned_point");
  const auto error = [](const std::string& node) {
    return error_of_sources("signed_curve\nv 1\n" + node);
  };
  EXPECT_EQ(error(""), "a.txt:1: signed_curve has 1 node, at least 2 are needed");
  EXPECT_EQ(error_of_sources("unsigned_point\n"),
            "a.txt:1: unsigned_point has 0 nodes, at least 1 is needed");
  EXPECT_EQ(error_of_sources("signed_curve 2\nv 1\nv 2\n"),
            "a.txt:1: after signed_curve only 0 or 1 (reversed) and 'value NUMBER' may follow, "
            "found '2'");
  EXPECT_EQ(error("v 99999"),
            "a.txt:3: node refers to vertex 99999, the mesh has 8 (counted from 0)");
  EXPECT_EQ(error("v -1"), "a.txt:3: node refers to vertex -1, the mesh has 8 (counted from 0)");
  EXPECT_EQ(error("l 0"), "a.txt:3: node refers to vertex 0, the mesh has 8 (counted from 1)");
  EXPECT_EQ(error("l"), "a.txt:3: expected 'l INDEX ...'");
  EXPECT_EQ(error("v 7"), "a.txt:3: node at vertex 7 (counted from 0), which is not finite");
  EXPECT_EQ(error("v 1.5"), "a.txt:3: expected an index, found '1.5'");
  EXPECT_EQ(error("v 1 2"), "a.txt:3: expected 'v INDEX'");
  EXPECT_EQ(error("e 9 .5"), "a.txt:3: node refers to edge 9, the mesh has 9 (counted from 0)");
  EXPECT_EQ(error("e 0 3 .5"), "a.txt:3: the mesh has no edge between vertices 0 and 3");
  EXPECT_EQ(error("e 1 1.5"), "a.txt:3: the parameter along an edge must be in [0, 1]");
  EXPECT_EQ(error("e 1 nan"), "a.txt:3: the parameter along an edge must be in [0, 1]");
  EXPECT_EQ(error("e 1 x"), "a.txt:3: expected a number, found 'x'");
  EXPECT_EQ(error("e 1"), "a.txt:3: expected 'e EDGE T' or 'e VERTEX VERTEX T'");
  EXPECT_EQ(error("f 3 .5 .5"), "a.txt:3: node refers to face 3, the mesh has 3 (counted from 0)");
  const std::string on_face = "a.txt:3: a point on face 0 has the barycentric coordinate ";
  EXPECT_EQ(error("f 0 .9 .9"), on_face + "-0.800000, outside [0, 1]");
  EXPECT_EQ(error("f 0 .5 .5 .1"),
            "a.txt:3: the barycentric coordinates of a point on face 0 sum to 1.100000, not 1");
  EXPECT_EQ(error("f 0 nan .5 .5"), on_face + "nan, outside [0, 1]");
  EXPECT_EQ(error("f 0 1.1 -.1 0"), on_face + "1.100000, outside [0, 1]");
  EXPECT_EQ(error("f 0 1"), "a.txt:3: expected 'f FACE A B' or 'f FACE A B C'");
  EXPECT_EQ(error("f 2 .5 .5"),
            "a.txt:3: face 2 has 5 corners; nodes inside faces need a triangle");
  EXPECT_EQ(error_of_sources("v 1\nv 2\nl 1 3\n"),
            "a.txt:3: segment refers to point 3, the file has 2 (counted from 1)");
  EXPECT_EQ(error_of_sources("v 1\nl 1\n"), "a.txt:2: expected 'l POINT POINT'");
  EXPECT_EQ(error_of_sources("#offset 2\nv 1\n"), "a.txt:1: expected 0 or 1 after #offset");
  EXPECT_EQ(error_of_sources("v 1\n", ".abc"),
            "a.abc: cannot be read as sources: the extension is '.abc'; possible: .obj .ply "
            ".glb .gltf .vtk .vtp .txt .json");
}

TEST(IoSources, PutsRoundingInBarycentricsRight) {
  const Sources s = read_sources_text("unsigned_point\nf 0 1.0000005 -1e-10 0\n");
  EXPECT_EQ(s.points[0].b, (std::array<double, 3>{1, 0, 0}));
}

TEST(IoSources, ReadsJson) {
  const Sources s = read_sources_text(
      R"({"curves":[{"signed":false,"closed":true,"points":[[0,0,0],[1,0,0],[1,1.5,0]]},
          {"nodes":[{"v":0},{"e":[2,1],"t":0.25},{"f":0,"b":[0.5,0.25,0.25]}],"closed":true}],
          "points":[{"v":4}]})",
      ".json");
  ASSERT_EQ(s.space_curves.size(), 1u);
  EXPECT_FALSE(s.space_curves[0].is_signed);
  ASSERT_EQ(s.space_curves[0].points.rows(), 4);
  EXPECT_EQ(s.space_curves[0].points.row(2), Eigen::RowVector3d(1, 1.5, 0));
  EXPECT_EQ(s.space_curves[0].points.row(3), s.space_curves[0].points.row(0));
  ASSERT_EQ(s.curves.size(), 1u);
  EXPECT_TRUE(s.curves[0].is_signed);
  EXPECT_EQ(s.curves[0].origin, "a.json:curves[1]");
  EXPECT_THAT(text_of(s.curves[0].nodes), ElementsAre("v0", "e1 0.75", "f0 0.5 0.25 0.25", "v0"));
  EXPECT_THAT(text_of(s.points), ElementsAre("v4"));
}

TEST(IoSources, SaysWhatIsWrongInJson) {
  const auto error = [](const std::string& text) { return error_of_sources(text, ".json"); };
  const auto node = [&](const std::string& text) { return error("{\"points\":[" + text + "]}"); };
  const auto curve = [&](const std::string& text) { return error("{\"curves\":[" + text + "]}"); };
  EXPECT_EQ(error("{\"curves\":[}"), "a.json: byte 12: not valid JSON");
  EXPECT_EQ(error("{\"a\":1e999}"), "a.json: a number in it is out of range");
  EXPECT_EQ(error(std::string(1000000, '[')), "a.json: the JSON is nested too deeply");
  EXPECT_EQ(error("[]"), "a.json: the document: expected an object");
  EXPECT_EQ(error("{}"), "a.json: no sources");
  EXPECT_EQ(error("{\"curve\":[]}"), "a.json: the document: unknown key 'curve'");
  EXPECT_EQ(error("{\"points\":3}"), "a.json: the document: 'points' must be an array");
  EXPECT_EQ(node("{\"v\":8}"),
            "a.json: points[0]: node refers to vertex 8, the mesh has 8 (counted from 0)");
  EXPECT_EQ(node("{\"v\":18446744073709551615}"), "a.json: points[0]: expected an index");
  EXPECT_EQ(node("{\"v\":1.5}"), "a.json: points[0]: expected an index");
  EXPECT_EQ(node("{\"e\":[0,1]}"),
            "a.json: points[0]: a node is {\"v\":i}, {\"e\":[i,j],\"t\":t} or "
            "{\"f\":i,\"b\":[a,b,c]}");
  EXPECT_EQ(node("{\"e\":[0],\"t\":0}"), "a.json: points[0]: expected an array of 2 numbers");
  EXPECT_EQ(node("{\"e\":[0,1],\"t\":\"x\"}"), "a.json: points[0]: expected a number");
  EXPECT_EQ(curve("{\"nodes\":[{\"v\":1}]}"),
            "a.json: curves[0]: the curve has 1 node, at least 2 are needed");
  EXPECT_EQ(curve("{\"nodes\":[{\"v\":1},{\"v\":9}]}"),
            "a.json: curves[0].nodes[1]: node refers to vertex 9, the mesh has 8 (counted from 0)");
  EXPECT_EQ(curve("{}"),
            "a.json: curves[0]: a curve has either 'points' (in space) or 'nodes' (on the mesh)");
  EXPECT_EQ(curve("{\"signed\":1,\"points\":[]}"),
            "a.json: curves[0]: 'signed' must be true or false");
}

TEST(IoSources, LinesOfTheMeshItselfAreCurvesOnIt) {
  const Sources own = read_sources_text(std::string(mesh_text) + "l 1 2 4\nl 4 5\n", ".obj");
  ASSERT_EQ(own.curves.size(), 2u);
  EXPECT_THAT(text_of(own.curves[0].nodes), ElementsAre("v0", "v1", "v3"));
  EXPECT_TRUE(own.curves[0].is_signed);

  const Sources edges = read_sources_text(std::string(mesh_text) + "l 2 4\nl 1 2\n", ".obj");
  ASSERT_EQ(edges.curves.size(), 1u) << "single segments are joined";
  EXPECT_THAT(text_of(edges.curves[0].nodes), ElementsAre("v0", "v1", "v3"));

  const Sources free = read_sources_text("v 5 0 0\nv 6 0 0\nl 1 2\n", ".obj");
  ASSERT_EQ(free.space_curves.size(), 1u);
  EXPECT_EQ(free.space_curves[0].points.row(1), Eigen::RowVector3d(6, 0, 0));

  EXPECT_EQ(error_of_sources(mesh_text, ".obj"),
            "a.obj: no lines; sources need 'l' records (.obj) or edges (.ply)");
  EXPECT_EQ(error_of_sources(std::string(mesh_text) + "l 1 8\n", ".obj"),
            "a.obj: a line uses vertex 7 (counted from 0), which is not finite");
}

}  // namespace
}  // namespace littoral::io
