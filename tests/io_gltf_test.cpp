// glTF: scenes placed by their nodes, accessors of every kind, what is written, what is refused.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "io/binary.h"
#include "io/read.h"
#include "io/surface/surface_writers.h"
#include "io/write.h"
#include "littoral/error.h"
#include "space_helpers.h"
#include "surface_bytes.h"

namespace littoral::io {
namespace {

using GltfJson = nlohmann::json;
using ::testing::HasSubstr;

/// A document with one buffer: a triangle as floats (36 bytes), indices 0 1 2 as bytes (at 36).
struct GltfSample {
  std::string data;
  GltfJson json;

  template <class T>
  void put(std::initializer_list<T> numbers) {
    for (const T x : numbers) data.append(reinterpret_cast<const char*>(&x), sizeof x);
  }

  GltfSample() {
    put<float>({0, 0, 0, 1, 0, 0, 0, 1, 0});
    put<std::uint8_t>({0, 1, 2, 0});
    json = GltfJson::parse(R"({"asset": {"version": "2.0"}, "scene": 0,
      "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
      "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
      "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
                    {"bufferView": 1, "componentType": 5121, "count": 3, "type": "SCALAR"}],
      "bufferViews": [{"buffer": 0, "byteLength": 36},
                      {"buffer": 0, "byteOffset": 36, "byteLength": 3}],
      "buffers": [{"byteLength": 40}]})");
  }

  GltfJson& primitive() { return json["meshes"][0]["primitives"][0]; }

  std::string glb() const {
    std::ostringstream out;
    std::string text = json.dump();
    text.append((4 - text.size() % 4) % 4, ' ');
    out << "glTF";
    for (const std::size_t x : {std::size_t{2}, 28 + text.size() + data.size(), text.size()})
      store_little(out, static_cast<std::uint32_t>(x));
    out << "JSON" << text;
    store_little(out, static_cast<std::uint32_t>(data.size()));
    out.write("BIN", 4) << data;
    return out.str();
  }
  PolygonSoup read() const { return test::read(glb(), ".glb"); }
  std::string error() const {
    return test::message_of([&] { read(); });
  }
};

TEST(Gltf, ATriangleIsRead) {
  const PolygonSoup soup = GltfSample().read();
  ASSERT_EQ(soup.n_faces(), 1);
  EXPECT_EQ(soup.corners, (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(soup.points.row(1), Eigen::RowVector3d(1, 0, 0));
}

// A half turn about z, scaled by 2 3 4, moved by 10 20 30; then the same as a matrix of the parent.
TEST(Gltf, NodesPlaceMeshes) {
  GltfSample sample;
  sample.json["nodes"][0]["rotation"] = {0, 0, 1, 0};
  sample.json["nodes"][0]["scale"] = {2, 3, 4};
  sample.json["nodes"][0]["translation"] = {10, 20, 30};
  const MatX3 expected = (MatX3(3, 3) << 10, 20, 30, 8, 20, 30, 10, 17, 30).finished();
  EXPECT_LT((sample.read().points - expected).norm(), 1e-12);

  sample.json["nodes"] = GltfJson::parse(R"([{"children": [1],
    "matrix": [-2, 0, 0, 0,  0, -3, 0, 0,  0, 0, 4, 0,  10, 20, 30, 1]}, {"mesh": 0}])");
  EXPECT_LT((sample.read().points - expected).norm(), 1e-12);

  // A mirror image has its faces turned, so that they still face outwards; two nodes are two
  // surfaces although they touch.
  sample.json["nodes"] = GltfJson::parse(R"([{"mesh": 0}, {"mesh": 0, "scale": [1, 1, -1]}])");
  sample.json["scenes"][0]["nodes"] = {0, 1};
  const PolygonSoup both = sample.read();
  EXPECT_EQ(both.n_vertices(), 6);
  EXPECT_EQ(both.points.row(both.face(1)[1]), Eigen::RowVector3d(0, 1, 0));
}

TEST(Gltf, EveryModeAndIndexType) {
  GltfSample sample;
  sample.data.clear();
  sample.put<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0});
  sample.json["buffers"][0]["byteLength"] = 48;
  sample.json["bufferViews"][0]["byteLength"] = 48;
  sample.json["accessors"][0]["count"] = 4;
  sample.primitive().erase("indices");
  const auto faces = [&](int mode) {
    sample.primitive()["mode"] = mode;
    return sample.read();
  };
  EXPECT_EQ(faces(5).corners, (std::vector<int>{0, 1, 2, 1, 3, 2}));
  EXPECT_THAT(sample.read().points.rows(), 4);
  EXPECT_EQ(faces(6).n_faces(), 2);
  EXPECT_EQ(faces(0).n_vertices(), 4);
  EXPECT_EQ(faces(0).n_faces(), 0);
  EXPECT_EQ(faces(1).lines.size(), 2u);
  EXPECT_EQ(faces(2).lines, (std::vector<std::vector<int>>{{0, 1, 2, 3, 0}}));
  EXPECT_EQ(faces(3).lines, (std::vector<std::vector<int>>{{0, 1, 2, 3}}));
  sample.primitive()["mode"] = 4;
  EXPECT_THAT(sample.error(), HasSubstr("no whole number of triangles"));

  for (const int type : {5121, 5123, 5125}) {
    GltfSample indexed;
    indexed.data.resize(36);
    if (type == 5121) indexed.put<std::uint8_t>({2, 0, 1, 0});
    if (type == 5123) indexed.put<std::uint16_t>({2, 0, 1, 0});
    if (type == 5125) indexed.put<std::uint32_t>({2, 0, 1});
    indexed.json["buffers"][0]["byteLength"] = indexed.data.size();
    indexed.json["bufferViews"][1]["byteLength"] = indexed.data.size() - 36;
    indexed.json["accessors"][1]["componentType"] = type;
    const PolygonSoup soup = indexed.read();
    EXPECT_EQ(soup.points.row(soup.corners[0]), Eigen::RowVector3d(0, 1, 0)) << type;
  }
}

TEST(Gltf, SparseNormalisedAndStridedNumbers) {
  GltfSample sample;
  // Vertex 2 is at 5 6 7 instead.
  sample.put<std::uint16_t>({2, 0});
  sample.put<float>({5, 6, 7});
  sample.json["buffers"][0]["byteLength"] = sample.data.size();
  sample.json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", 40}, {"byteLength", 4}});
  sample.json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", 44}, {"byteLength", 12}});
  sample.json["accessors"][0]["sparse"] = {
      {"count", 1},
      {"indices", {{"bufferView", 2}, {"componentType", 5123}}},
      {"values", {{"bufferView", 3}}}};
  EXPECT_EQ(sample.read().points.row(2), Eigen::RowVector3d(5, 6, 7));
  sample.json["accessors"][0].erase("bufferView");  // the others are zero, and so at one place
  EXPECT_EQ(sample.read().n_vertices(), 2);
  sample.json["accessors"][0]["sparse"]["count"] = 2;
  EXPECT_THAT(sample.error(), HasSubstr("accessor 0, sparse values promises 2 elements"));

  GltfSample fractions;
  fractions.data.clear();
  fractions.put<std::int8_t>({127, 0, 0, 99, 0, 127, 0, 99, 0, 0, -128, 99});
  fractions.put<std::uint8_t>({0, 1, 2, 0});
  fractions.json["buffers"][0]["byteLength"] = 16;
  fractions.json["bufferViews"][0] = {{"buffer", 0}, {"byteLength", 12}, {"byteStride", 4}};
  fractions.json["bufferViews"][1]["byteOffset"] = 12;
  fractions.json["accessors"][0]["componentType"] = 5120;
  fractions.json["accessors"][0]["normalized"] = true;
  EXPECT_EQ(fractions.read().points, (MatX3(3, 3) << 1, 0, 0, 0, 1, 0, 0, 0, -1).finished());
}

TEST(Gltf, VerticesAtOnePlaceAreOne) {
  GltfSample sample;
  sample.data.clear();
  // Two triangles of a square with corners of their own.
  sample.put<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});
  sample.put<float>({1, 2, 3, 2, 4, 3});
  sample.json["buffers"][0]["byteLength"] = sample.data.size();
  sample.json["bufferViews"] = {{{"buffer", 0}, {"byteLength", 72}},
                                {{"buffer", 0}, {"byteOffset", 72}, {"byteLength", 24}}};
  sample.json["accessors"][0]["count"] = 6;
  sample.json["accessors"][1] = {
      {"bufferView", 1}, {"componentType", 5126}, {"count", 6}, {"type", "SCALAR"}};
  sample.primitive().erase("indices");
  EXPECT_EQ(sample.read().n_vertices(), 4);
  // Where a field jumps, they stay apart.
  sample.primitive()["attributes"]["_DISTANCE"] = 1;
  const PolygonSoup soup = sample.read();
  EXPECT_EQ(soup.scalars.at("distance"), (VecX(4) << 1, 2, 3, 4).finished());
}

TEST(Gltf, BuffersBesideTheFile) {
  const auto folder = std::filesystem::path(testing::TempDir()) / "littoral gltf";
  std::filesystem::create_directories(folder);
  GltfSample sample;
  sample.json["buffers"][0]["uri"] = "the%20data.bin";
  std::ofstream(folder / "the data.bin", std::ios::binary) << sample.data;
  std::ofstream(folder / "a.gltf") << sample.json.dump();
  EXPECT_EQ(read_surface(folder / "a.gltf").n_faces(), 1);
  EXPECT_THAT(test::message_of([&] { test::read(sample.json.dump(), ".gltf"); }),
              HasSubstr("is in the file 'the%20data.bin'"));
  std::filesystem::remove_all(folder);
  EXPECT_THROW(read_surface(folder / "a.gltf"), IoError);
  // The same inside.
  sample.json["buffers"][0]["uri"] =
      "data:application/"
      "octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAECAA==";
  EXPECT_EQ(test::read(sample.json.dump(), ".gltf").points, GltfSample().read().points);
}

TEST(Gltf, ErrorsNameTheElement) {
  const auto expect = [](const char* path, const GltfJson& value, const char* text) {
    GltfSample sample;
    sample.json[GltfJson::json_pointer(path)] = value;
    EXPECT_THAT(sample.error(), HasSubstr(text)) << path;
  };
  expect("/accessors/0/count", 4, "accessor 0 promises 4 elements, bufferView 0 is shorter");
  expect("/accessors/0/count", 4000000000u, "accessor 0 promises 4000000000 elements");
  expect("/accessors/0/count", -1, "accessor 0: 'count' must be a whole number");
  expect("/accessors/0/type", "VEC2", "accessor 0 is of type 'VEC2' instead of VEC3");
  expect("/accessors/0/componentType", 5127, "accessor 0: there is no component type 5127");
  expect("/accessors/0/byteOffset", 18446744073709551600u, "bufferView 0 is shorter");
  expect("/accessors/1/bufferView", 7, "bufferViews: there is no number 7, the file has 2");
  expect("/bufferViews/0/byteLength", 1000, "bufferView 0 runs beyond its buffer");
  expect("/bufferViews/0/byteStride", 4, "bufferView 0: the stride is less than an element");
  expect("/buffers/0/byteLength", 1000, "buffer 0 promises 1000 bytes, there are 40");
  expect("/buffers/0/uri", "https://x/y", "only files beside this one");
  expect("/buffers/0/uri", "data:,abc", "buffer 0: the data are not base64");
  expect("/nodes/0/mesh", 1, "meshes: there is no number 1, the file has 1");
  expect("/nodes/0/children", {0}, "node 0 stands in two places");
  expect("/nodes/0/scale", {1, 2}, "node 0: 'scale' must be 3 numbers");
  expect("/nodes/0/rotation", {0, 0, 0, 0}, "node 0: 'rotation' is no rotation");
  expect("/nodes/0/skin", 0, "node 0 has a skin");
  expect("/nodes/0/weights", {0.5}, "node 0 is morphed");
  expect("/scenes/0/nodes", {5}, "scene 0: entry 0 is no node, the file has 1");
  expect("/asset/version", "1.0", "glTF of version '1.0'");
  expect("/extensionsRequired", {"KHR_draco_mesh_compression"},
         "requires the extension 'KHR_draco_mesh_compression'");
  expect("/meshes/0/primitives/0/mode", 9, "mesh 0, primitive 0: there is no mode 9");
  expect("/meshes/0/primitives/0/attributes/NORMAL", 1, "accessor 1 is of type 'SCALAR'");
  GltfSample sample;
  sample.data[38] = 3;
  EXPECT_THAT(sample.error(),
              HasSubstr("a.glb: mesh 0, primitive 0: index 2 refers to vertex 3, it has 3"));
  EXPECT_THAT(test::error_of("{]", ".gltf"), HasSubstr("the JSON: "));
  EXPECT_THAT(test::error_of("{}", ".gltf"), HasSubstr("no object 'asset'"));
  const std::string whole = GltfSample().glb();
  for (std::size_t cut = 0; cut < whole.size(); ++cut)
    EXPECT_NE(test::error_of(whole.substr(0, cut), ".glb"), "no error") << cut;
}

TEST(Gltf, DeepDocumentsAreRefused) {
  const std::string deep(200000, '[');
  EXPECT_NE(test::error_of("{\"asset\":{\"version\":" + deep, ".gltf"), "no error");
  EXPECT_NE(test::error_of("{\"asset\":" + deep + std::string(200000, ']') + "}", ".gltf"),
            "no error");
}

TEST(Gltf, WrittenFilesReadBack) {
  PolygonSoup soup;
  soup.points.resize(5, 3);
  soup.points << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0.5, 3, 3, 3;
  soup.normals = MatX3::Ones(5, 3);
  for (const auto& face : {std::array{0, 1, 2}, {0, 3, 1}}) soup.add_face(face);
  soup.lines = {{2, 3, 4}};
  soup.scalars["distance"] =
      (VecX(5) << 0, 1, 0.25, std::numeric_limits<double>::infinity(), 2).finished();
  soup.scalars["level"] = VecX::LinSpaced(5, 0, 4);
  const auto path = std::filesystem::path(testing::TempDir()) / "littoral_written.glb";
  write_surface(path, soup);
  const PolygonSoup back = read_surface(path);
  EXPECT_EQ(back.points, soup.points);
  EXPECT_EQ(back.corners, soup.corners);
  EXPECT_EQ(back.lines, soup.lines);
  EXPECT_EQ(back.scalars, soup.scalars);
  EXPECT_LT((back.normals - soup.normals / std::sqrt(3)).norm(), 1e-6);
  std::filesystem::remove(path);

  // Without faces and lines the points are what there is, doubled ones too.
  PolygonSoup cloud;
  cloud.points = MatX3::Ones(3, 3);
  write_surface(path, cloud);
  EXPECT_EQ(read_surface(path).points, cloud.points);
  std::filesystem::remove(path);

  const auto refusal = [&](PolygonSoup changed) {
    return test::message_of([&] { write_surface(path, changed); });
  };
  PolygonSoup quad = soup;
  quad.add_face(std::array{0, 1, 2, 3});
  EXPECT_THAT(refusal(quad), HasSubstr("face 2 has 4 corners, glTF holds triangles only"));
  PolygonSoup far = soup;
  far.points(4, 1) = 1e300;
  EXPECT_THAT(refusal(far), HasSubstr("vertex 4 is not finite or beyond"));
  PolygonSoup undirected = soup;
  undirected.normals.row(2).setZero();
  EXPECT_THAT(refusal(undirected), HasSubstr("vertex 2 has a normal without a direction"));
  PolygonSoup none = soup;
  none.scalars["distance"][1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(refusal(none), HasSubstr("the scalar 'distance' of vertex 1"));
  EXPECT_FALSE(std::filesystem::exists(path));
}

}  // namespace
}  // namespace littoral::io
