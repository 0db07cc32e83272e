// The readers against whole collections of files: well-formed, odd and broken ones.

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "io/read.h"
#include "littoral/error.h"
#include "shared_data.h"
#include "sources/surface/surface_points.h"

namespace littoral::io {
namespace {

namespace fs = std::filesystem;

std::string lower(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

bool is_surface(const fs::path& path) {
  const std::string format = lower(path.extension().string());
  return format == ".obj" || format == ".off" || format == ".ply" || format == ".stl";
}

// The mesh that a curve file was made for: the longest file name stem that begins its own.
fs::path mesh_of(const fs::path& curve) {
  const std::map<std::string, std::string> others{{"facecurve", "sphere_cap"},
                                                  {"figure8", "torus_disc"},
                                                  {"mobius_arc", "mobius_core"},
                                                  {"torus_band", "torus_disc"},
                                                  {"torus_longitude", "torus_disc"},
                                                  {"torus_meridian", "torus_disc"},
                                                  {"torus-phi", "torus"},
                                                  {"hemisphere-point", "shd-hemisphere"},
                                                  {"block-points", "block"},
                                                  {"bunny-heart", "bunny"}};
  const std::string stem = curve.filename().string();
  for (const auto& [prefix, mesh] : others) {
    if (stem.starts_with(prefix)) return curve.parent_path() / (mesh + ".obj");
  }
  const fs::path own = curve.parent_path() / (stem.substr(0, stem.find('.')) + ".obj");
  return fs::exists(own) ? own : curve.parent_path() / "sphere_cap.obj";
}

Sources read_curves(const fs::path& path, const SurfaceMesh& mesh) {
  Report report;
  return read_sources(path, mesh, {}, report);
}

// Reads one file of the generated collection as what it is; "load", "reject" or what went wrong.
std::string outcome(const fs::path& path, const nlohmann::json& expected) {
  try {
    if (path.extension() == ".txt") {
      const SurfaceMesh mesh(read_surface(mesh_of(path)));
      return read_curves(path, mesh).empty() ? "no sources" : "load";
    }
    const PolygonSoup soup = read_surface(path);
    if (expected.contains("V") && soup.n_vertices() != expected["V"]) return "another V";
    if (expected.contains("F") && soup.n_faces() != expected["F"]) return "another F";
    return "load";
  } catch (const InputError& error) {
    const std::string text = error.what();
    return text.starts_with(path.string() + ":") ? "reject" : "message without the name: " + text;
  }
}

TEST(IoData, GeneratedFilesDoWhatTheirTableSays) {
  LITTORAL_NEEDS_SHARED("data/generated/expected.json");
  const fs::path folder = test::shared() / "data/generated";
  const auto table = nlohmann::json::parse(std::ifstream(folder / "expected.json"));
  int checked = 0;
  for (const auto& [file, expected] : table.items()) {
    const std::string group = file.substr(0, file.find('/'));
    if (group == "clouds" || group == "tets" || file.ends_with(".labels.txt")) continue;
    std::string wanted = expected["expect"];
    // Nodes that share no face are traced across the mesh by a later stage, so this is sound input.
    if (file == "curves/bad_nonadjacent.txt") wanted = "load";
    const std::string found = outcome(folder / file, expected);
    if (wanted == "either") {
      EXPECT_TRUE(found == "load" || found == "reject") << file << ": " << found;
    } else {
      EXPECT_EQ(found, wanted) << file;
    }
    ++checked;
  }
  EXPECT_GT(checked, 200);
}

// Where the table allows either, these are the readers' choices.
TEST(IoData, ChoicesWhereEitherIsAllowed) {
  LITTORAL_NEEDS_SHARED("data/generated/expected.json");
  const fs::path folder = test::shared() / "data/generated";
  const auto table = nlohmann::json::parse(std::ifstream(folder / "expected.json"));
  std::set<std::string> rejected;
  for (const auto& [file, expected] : table.items()) {
    if (expected["expect"] != "either" || !is_surface(file) || file.starts_with("clouds")) continue;
    if (outcome(folder / file, expected) == "reject") rejected.insert(file);
  }
  EXPECT_EQ(rejected,
            (std::set<std::string>{"files/count_small.stl", "files/face1.obj", "files/face2.obj",
                                   "files/nul_bytes.obj", "files/number_forms.obj",
                                   "files/truncated_ascii.stl", "files/truncated_mid.obj",
                                   "files/vertex2.obj", "files/zero_faces_vertices.ply"}));
  for (const char* file : {"geometry/nan_vertex.obj", "geometry/inf_vertex.obj"}) {
    EXPECT_THROW(SurfaceMesh{read_surface(folder / file)}, InputError) << file;
  }
  EXPECT_EQ(SurfaceMesh(read_surface(folder / "geometry/nan_isolated.obj")).n_vertices(), 830);
}

// V and F of each file as INDEX.md lists them, by folder and name; files listed without are left
// out.
std::map<std::string, std::pair<int, int>> index_table(const fs::path& index) {
  std::map<std::string, std::pair<int, int>> table;
  std::ifstream in(index);
  std::string line, folder;
  while (std::getline(in, line)) {
    if (line.starts_with("## ")) folder = line.substr(3, line.find(' ', 3) - 3);
    if (!line.starts_with("| ")) continue;
    std::vector<std::string> cells;
    std::istringstream row(line);
    for (std::string cell; std::getline(row, cell, '|');) {
      const auto begin = cell.find_first_not_of(' '), end = cell.find_last_not_of(' ');
      cells.push_back(begin == std::string::npos ? "" : cell.substr(begin, end - begin + 1));
    }
    const auto is_number = [](const std::string& s) {
      return !s.empty() && std::ranges::all_of(s, [](char c) { return c >= '0' && c <= '9'; });
    };
    if (cells.size() < 6 || !is_number(cells[4]) || !is_number(cells[5])) continue;
    table[folder + "/" + cells[1]] = {std::stoi(cells[4]), std::stoi(cells[5])};
  }
  return table;
}

TEST(IoData, CollectedFilesHaveTheListedSizes) {
  LITTORAL_NEEDS_SHARED("data/INDEX.md");
  // Files that are not read although they are listed, and why.
  const std::map<std::string, std::string> rejected{
      {"formats/OutOfMemory.off", "the header promises 353535235358 vertices"},
      {"formats/box_UTF16BE.obj", "the text is UTF-16"},
      {"formats/crash-30d6d0f7c529b3b66b4131700b7a4580cd7082df.ply", "inside the header"},
      {"formats/invalid-face-definition.obj", "face has 1 corner"},
      {"formats/invalid-relative-vertex-index.obj", "only 0 come before it"},
      {"formats/invalid.off", "face has 0 corners"},
      {"formats/issue-140-zero-face-idx.obj", "but OBJ counts from 1"},
      {"formats/issue623.ply", ""},
      {"formats/malformed.obj", "face refers to vertex"},
      {"formats/malformed2.obj", "face has 0 corners"},
      {"formats/notenoughindices.obj", "face has 2 corners"},
      {"formats/number_formats.obj", "found '3.1+e2'"},
      {"formats/ply_empty_bin.ply", "no vertices"},
      {"formats/ply_empty_header.ply", "no vertices"},
      {"formats/stl_empty_ascii.stl", "no vertices"},
      {"formats/stl_empty_bin.stl", "no vertices"}};
  const auto table = index_table(test::shared() / "data/INDEX.md");
  int read_files = 0;
  for (const char* folder : {"formats", "surfaces", "soups", "polygon", "curves", "clouds"}) {
    for (const auto& entry : fs::directory_iterator(test::shared() / "data" / folder)) {
      if (!is_surface(entry.path())) continue;
      const std::string name = std::string(folder) + "/" + entry.path().filename().string();
      try {
        const PolygonSoup soup = read_surface(entry.path());
        EXPECT_EQ(rejected.count(name), 0u) << name;
        ASSERT_EQ(table.count(name), 1u) << name;
        EXPECT_EQ(std::pair(soup.n_vertices(), soup.n_faces()), table.at(name)) << name;
        ++read_files;
      } catch (const InputError& error) {
        ASSERT_EQ(rejected.count(name), 1u) << error.what();
        EXPECT_NE(std::string(error.what()).find(rejected.at(name)), std::string::npos)
            << error.what();
      }
    }
  }
  EXPECT_GT(read_files, 150);
}

// Fraction of consecutive nodes that lie in one face; an edge numbering other than the files' would
// scatter the nodes over the mesh.
double adjacent_fraction(const SurfaceMesh& mesh, const Sources& sources) {
  int together = 0, all = 0;
  for (const Curve& curve : sources.curves) {
    for (std::size_t k = 1; k < curve.nodes.size(); ++k, ++all) {
      const auto a = faces_at(mesh, curve.nodes[k - 1]), b = faces_at(mesh, curve.nodes[k]);
      std::vector<int> common;
      std::ranges::set_intersection(a, b, std::back_inserter(common));
      together += !common.empty();
    }
  }
  return all == 0 ? 1 : static_cast<double>(together) / all;
}

TEST(IoData, ConsecutiveNodesShareFaces) {
  LITTORAL_NEEDS_SHARED("data/curves/S.txt");
  const std::map<std::string, int> segments{{"S.txt", 232},
                                            {"annulus.txt", 193},
                                            {"bunny-heart.txt", 97},
                                            {"double-torus.txt", 90},
                                            {"torus-phi.txt", 88}};
  int files = 0;
  for (const auto& entry : fs::directory_iterator(test::shared() / "data/curves")) {
    const fs::path& path = entry.path();
    if (path.extension() != ".txt" || path.filename() == "ducky-star.txt") continue;  // on a cloud
    const SurfaceMesh mesh(read_surface(mesh_of(path)));
    const Sources sources = read_curves(path, mesh);
    EXPECT_GE(adjacent_fraction(mesh, sources), .98) << path;
    const auto expected = segments.find(path.filename().string());
    if (expected != segments.end()) {
      std::size_t found = 0;
      for (const Curve& curve : sources.curves) found += curve.nodes.size() - 1;
      EXPECT_EQ(found, expected->second) << path << ": every segment once";
    }
    ++files;
  }
  EXPECT_GE(files, 12);
}

TEST(IoData, FlagAndFormatsSayTheSameCurve) {
  LITTORAL_NEEDS_SHARED("data/generated/curves/sphere_cap.txt");
  const fs::path folder = test::shared() / "data/generated/curves";
  const SurfaceMesh mesh(read_surface(folder / "sphere_cap.obj"));
  const auto nodes = [&](const char* file) {
    const Sources sources = read_curves(folder / file, mesh);
    EXPECT_EQ(sources.curves.size(), 1u) << file;
    std::vector<int> vertices;
    for (const SurfacePoint& p : sources.curves.at(0).nodes) {
      EXPECT_EQ(p.on, SurfacePoint::On::vertex);
      vertices.push_back(p.element);
    }
    return vertices;
  };
  const std::vector<int> reference = nodes("sphere_cap.txt");
  EXPECT_EQ(reference.size(), 47u);
  for (const char* file :
       {"flag1.txt", "l_records.txt", "crlf.txt", "sphere_cap_l.obj", "unsigned.txt"}) {
    EXPECT_EQ(nodes(file), reference) << file;
  }
  // This one's points are 47, the last beside the first: joined they are the same loop.
  EXPECT_EQ(nodes("sphere_cap.swn.txt"), reference);
}

// One curve or point list of a reference source.txt: keyword, count, then its nodes by vertices.
struct ReferenceSource {
  std::string keyword;
  std::vector<int> vertices;
};

std::vector<ReferenceSource> reference_sources(const fs::path& path) {
  std::vector<ReferenceSource> all;
  std::ifstream in(path);
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string first;
    int number = 0;
    if (!(words >> first >> number)) continue;
    if (first == "v") {
      all.back().vertices.push_back(number);
    } else {
      all.push_back({first, {}});
    }
  }
  return all;
}

TEST(IoData, NodesAreThoseOfTheReferenceProgram) {
  LITTORAL_NEEDS_SHARED("reference/shm_surface");
  int cases = 0;
  for (const auto& entry : fs::directory_iterator(test::shared() / "reference/shm_surface")) {
    if (!fs::exists(entry.path() / "mesh.obj")) continue;  // a point cloud
    const SurfaceMesh mesh(read_surface(entry.path() / "mesh.obj"));
    const Sources sources = read_curves(entry.path() / "input_source.txt", mesh);
    std::size_t next_curve = 0, next_point = 0;
    for (const ReferenceSource& expected : reference_sources(entry.path() / "source.txt")) {
      std::vector<SurfacePoint> nodes;
      if (expected.keyword == "unsigned_point") {
        for (std::size_t k = 0; k < expected.vertices.size(); ++k) {
          nodes.push_back(sources.points.at(next_point++));
        }
      } else {
        nodes = sources.curves.at(next_curve).nodes;
        EXPECT_EQ(sources.curves.at(next_curve++).is_signed, expected.keyword == "signed_curve");
      }
      std::vector<int> vertices;
      for (const SurfacePoint& p : nodes) vertices.push_back(p.element);
      EXPECT_EQ(vertices, expected.vertices) << entry.path();
    }
    EXPECT_EQ(next_curve, sources.curves.size()) << entry.path();
    EXPECT_EQ(next_point, sources.points.size()) << entry.path();
    ++cases;
  }
  EXPECT_GE(cases, 9);
}

}  // namespace
}  // namespace littoral::io
