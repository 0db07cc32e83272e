#include "io/render/scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "constants.h"
#include "io/render/camera.h"
#include "io/render/discs.h"
#include "io/render/picture.h"
#include "io/render/scene_style.h"
#include "littoral/error.h"
#include "test_meshes.h"

namespace littoral {
namespace {

namespace fs = std::filesystem;
using test::infinity;

// A sphere with its x coordinate as field, one signed, one unsigned curve and a point.
io::Scene sphere_scene() {
  io::Scene scene = io::make_scene(test::octasphere_soup(4));
  scene.values = scene.points.col(0);
  scene.field_name = "x";
  for (const bool is_signed : {true, false}) {
    MatX3 circle(65, 3);
    for (int i = 0; i <= 64; ++i) {
      const double a = std::acos(-1.0) * i / 32;
      circle.row(i) << (is_signed ? 0.0 : 0.6), std::cos(a), std::sin(a);
      if (!is_signed) circle.row(i).tail<2>() *= 0.8;
    }
    scene.curves.push_back({circle, is_signed});
  }
  scene.source_points = MatX3(1, 3);
  scene.source_points << 0, std::sqrt(0.5), std::sqrt(0.5);
  return scene;
}

std::string slurp(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

struct PageTest : testing::Test {
  fs::path path = fs::path(testing::TempDir()) / "littoral_scene_test.html";
  void SetUp() override {
    if (!io::has_viewer()) GTEST_SKIP() << "built without the viewer";
  }
  void TearDown() override { fs::remove(path); }
  nlohmann::json written(const io::Scene& scene) {
    io::write_page(path, scene);
    const std::string page = slurp(path), mark = "type=\"application/json\">";
    const std::size_t from = page.find(mark) + mark.size();
    return nlohmann::json::parse(page.substr(from, page.find("</script>", from) - from));
  }
};

TEST(Scene, FactsAreListedOnce) {
  io::Scene scene = sphere_scene();
  Report report;
  report.method = "tori";
  for (int times = 0; times < 2; ++times) {  // a cloud is read for its tori and for its grid
    report.sizes.emplace_back("points", 66);
    report.sizes.emplace_back("samples", 66);
  }
  io::describe(scene, "sphere", report);
  std::set<std::string> names;
  for (const auto& [name, text] : scene.facts) EXPECT_TRUE(names.insert(name).second) << name;
  EXPECT_TRUE(names.contains("samples"));
}

TEST(Scene, PolygonsBecomeFansThatRememberTheirSides) {
  PolygonSoup soup;
  soup.points = MatX3::Random(5, 3);
  const int pentagon[5] = {0, 1, 2, 3, 4}, triangle[3] = {0, 2, 4};
  soup.add_face(pentagon);
  soup.add_face(triangle);
  soup.scalars["distance"] = VecX::Zero(5);
  const io::Scene scene = io::make_scene(soup);
  ASSERT_EQ(scene.triangles.rows(), 4);
  EXPECT_EQ(scene.inner_sides, (std::vector<unsigned char>{4, 5, 1, 0}));
  EXPECT_EQ(scene.faces, (std::vector<int>{0, 0, 0, 1}));
  EXPECT_EQ(scene.values.size(), 5);
  EXPECT_TRUE(io::make_scene(test::grid_soup(2, 2)).inner_sides.empty());
}

TEST(Scene, SourcesAreAdded) {
  const SurfaceMesh mesh(test::grid_soup(2, 2));
  Sources sources;
  sources.curves.push_back(
      {{SurfacePoint::at_vertex(0), SurfacePoint::on_edge(0, 0.5)}, false, ""});
  sources.points.push_back(SurfacePoint::at_vertex(8));
  sources.space_curves.push_back({MatX3::Ones(3, 3), true, ""});
  io::Scene scene = io::make_scene(mesh.soup());
  io::add_sources(scene, mesh, sources);
  ASSERT_EQ(scene.curves.size(), 2u);
  EXPECT_FALSE(scene.curves[0].is_signed);
  EXPECT_NEAR(scene.curves[0].points(1, 0), 0.25, 1e-15);
  ASSERT_EQ(scene.source_points.rows(), 1);
  EXPECT_EQ(scene.source_points.row(0), mesh.points().row(8));
  EXPECT_EQ(scene.nodes, io::SceneNodes::faces);
  io::Scene refined = io::make_scene(test::grid_soup(3, 3));
  io::add_sources(refined, mesh, sources);
  EXPECT_EQ(refined.nodes, io::SceneNodes::none);  // its vertices are not the mesh's
}

TEST(Scene, OtherScalarsAreFurtherFields) {
  PolygonSoup soup = test::grid_soup(2, 2);
  soup.scalars["distance"] = soup.points.col(0);
  soup.scalars["weight"] = VecX::Ones(9);
  soup.scalars["confidence"] = VecX::Constant(9, 0.5);
  soup.scalars["broken"] = VecX::Constant(9, std::nan(""));
  const io::Scene scene = io::make_scene(soup);
  ASSERT_EQ(scene.more.size(), 1u);
  EXPECT_EQ(scene.more[0].name, "confidence");
  const io::FieldStyle style = io::field_style(scene, scene.more[0]);
  EXPECT_EQ(style.colour_low, 0);
  EXPECT_EQ(style.colour_high, 1);
}

TEST(Scene, CheckNamesWhatIsWrong) {
  const auto refused = [](void (*spoil)(io::Scene&)) {
    io::Scene scene = sphere_scene();
    io::check_scene(scene);
    spoil(scene);
    EXPECT_THROW(io::check_scene(scene), InputError);
  };
  refused([](io::Scene& s) { s.triangles.resize(0, 3); });
  refused([](io::Scene& s) { s.triangles(3, 1) = 1 << 20; });
  refused([](io::Scene& s) { s.triangles(3, 1) = -1; });
  refused([](io::Scene& s) { s.points(s.triangles(0, 0), 2) = infinity; });
  refused([](io::Scene& s) { s.values.conservativeResize(7); });
  refused([](io::Scene& s) { s.values[5] = std::nan(""); });
  refused([](io::Scene& s) { s.curves[0].points(0, 0) = infinity; });
  refused([](io::Scene& s) { s.source_points(0, 0) = std::nan(""); });
  refused([](io::Scene& s) { s.levels = {0, infinity}; });
  refused([](io::Scene& s) { s.isolines = -1; });
  refused([](io::Scene& s) { s.inner_sides = {1}; });
  refused([](io::Scene& s) { s.faces = {1}; });
  refused([](io::Scene& s) { s.more = {{"short", VecX::Zero(3)}}; });
  refused([](io::Scene& s) {
    io::Scene other = s;
    other.isolines = -1;
    s.beside = std::make_shared<const io::Scene>(other);
  });
}

TEST(SceneStyle, SignedFieldsDivergeAboutZero) {
  io::Scene scene = sphere_scene();
  io::FieldStyle style = io::field_style(scene);
  EXPECT_TRUE(style.diverging);
  EXPECT_NEAR(io::colour_position(style, 0), 0.5, 1e-12);
  scene.colour_range = std::array<double, 2>{-0.2, 0.6};
  const io::FieldStyle asked = io::field_style(scene);
  for (const auto& [value, place] : std::vector<std::pair<double, double>>{
           {-1, 0}, {-0.2, 0}, {-0.1, 0.25}, {0, 0.5}, {0.3, 0.75}, {0.6, 1}, {1, 1}})
    EXPECT_NEAR(io::colour_position(asked, value), place, 1e-12) << value;
  scene.colour_range.reset();
  scene.values = scene.values.array() + 1.0;
  scene.values[0] = infinity;
  style = io::field_style(scene);
  EXPECT_FALSE(style.diverging);
  EXPECT_TRUE(style.infinite);
  EXPECT_EQ(io::colour_position(style, style.colour_low), 0);
  EXPECT_EQ(io::colour_position(style, style.high), 1);
  scene.values.setConstant(infinity);
  EXPECT_FALSE(io::field_style(scene).present);
}

TEST(SceneStyle, IntegersNameRegionsUnlessTheyAreADistance) {
  io::Scene scene = sphere_scene();
  scene.values = scene.points.col(0).unaryExpr([](double x) { return std::round(2 * x); });
  io::FieldStyle style = io::field_style(scene);
  EXPECT_TRUE(style.discrete);
  EXPECT_EQ(style.spacing, 0);
  EXPECT_EQ(io::value_colour(style, 1), io::region_colour(1));
  scene.colour_map = io::ColourMap::viridis;  // asked for: values like others
  EXPECT_FALSE(io::field_style(scene).discrete);
  scene.colour_map = io::ColourMap::automatic;
  scene.field_name = "distance";
  EXPECT_FALSE(io::field_style(scene).discrete);
  scene.field_name = "region";
  scene.values.setZero();
  EXPECT_TRUE(io::field_style(scene).discrete);
  scene.values[0] = 0.5;
  EXPECT_FALSE(io::field_style(scene).discrete);
  std::set<io::Rgb> colours;
  for (long k = -4; k <= 4; ++k) colours.insert(io::region_colour(k));
  EXPECT_EQ(colours.size(), 9u);
  EXPECT_EQ(io::region_colour(1), io::region_colour(9));
}

// Maps that are told apart by lightness alone serve those who see few colours.
TEST(SceneStyle, FlatSurfacesAreSeenFaceOnTheRightWayUp) {
  io::SceneFrame frame = io::scene_frame(io::make_scene(test::grid_soup(4, 4)));
  EXPECT_NEAR(frame.towards_eye[2], 1, 1e-9);
  EXPECT_NEAR(frame.up[1], 1, 1e-9);
  PolygonSoup floor = test::grid_soup(4, 4);
  floor.points.col(2) = -floor.points.col(1).eval();
  floor.points.col(1).setZero();
  frame = io::scene_frame(io::make_scene(floor));
  EXPECT_NEAR(frame.towards_eye[1], 1, 1e-9);
  EXPECT_NEAR(frame.up[2], -1, 1e-9);
  frame = io::scene_frame(sphere_scene());
  EXPECT_NEAR(frame.towards_eye.norm(), 1, 1e-12);
  EXPECT_NEAR(frame.towards_eye.dot(frame.up), 0, 1e-12);
  EXPECT_GT(frame.towards_eye[1], 0.2);
  PolygonSoup standing = test::octasphere_soup(2);
  standing.points.col(2).array() += 1;  // on the plane z = 0
  frame = io::scene_frame(io::make_scene(standing));
  EXPECT_GT(frame.towards_eye[2], 0.2);
  EXPECT_LT(frame.towards_eye[1], -0.2);  // from the front
  EXPECT_GT(frame.up[2], 0.5);
  standing.points.col(1).array() += 1;  // on both planes: y stays up
  EXPECT_GT(io::scene_frame(io::make_scene(standing)).up[1], 0.5);
}

TEST(SceneStyle, UprightAxisIsThatOnWhichThingsStand) {
  EXPECT_EQ(io::upright_axis(Vec3(-1, -1, 0), Vec3(1, 1, 2)), Vec3::UnitZ());
  EXPECT_EQ(io::upright_axis(Vec3(-1, 0, 0), Vec3(1, 1, 2)), Vec3::UnitY());
  EXPECT_EQ(io::upright_axis(Vec3(-1, -1, -1), Vec3(1, 1, 1)), Vec3::UnitY());
}

TEST(SceneStyle, MarksFollowTheCurves) {
  const io::Scene scene = sphere_scene();
  const io::SourceMarks marks = io::source_marks(scene, 1);
  double length[2] = {0, 0};
  for (const auto& stroke : marks.strokes) length[stroke.is_signed] += (stroke.b - stroke.a).norm();
  EXPECT_NEAR(length[1], 2 * std::acos(-1.0), 0.01);            // whole
  EXPECT_NEAR(length[0] / (1.6 * std::acos(-1.0)), 0.5, 0.02);  // dashes: about half
  ASSERT_FALSE(marks.arrows.empty());
  for (const auto& arrow : marks.arrows) {  // counter-clockwise about x
    EXPECT_GT(
        arrow.base[1] * (arrow.tip - arrow.base)[2] - arrow.base[2] * (arrow.tip - arrow.base)[1],
        0);
  }
}

TEST_F(PageTest, HoldsTheScene) {
  io::Scene scene = sphere_scene();
  scene.facts = {{"faces", "2048"}};
  scene.warnings = {"something is odd"};
  scene.more = {{"confidence", VecX::Constant(scene.points.rows(), 0.25)}};
  const auto page = written(scene);
  EXPECT_EQ(page["format"], "littoral scene");
  EXPECT_EQ(page["version"], 2);
  EXPECT_EQ(page["facts"][0][1], "2048");
  EXPECT_EQ(page["warnings"][0], "something is odd");
  const auto& surface = page["surface"];
  EXPECT_EQ(surface["positions"].get<std::string>().size(), (scene.points.size() * 4u + 2) / 3 * 4);
  EXPECT_EQ(surface["triangles"].get<std::string>().size(),
            (scene.triangles.size() * 4u + 2) / 3 * 4);
  EXPECT_EQ(surface["nodes"], "none");
  ASSERT_EQ(page["fields"].size(), 2u);
  EXPECT_EQ(page["fields"][0]["low"], -1.0);
  EXPECT_EQ(page["fields"][0]["spacing"], io::nice_spacing(-1, 1, 20));
  EXPECT_EQ(page["fields"][0]["map"], "diverging");
  EXPECT_EQ(page["fields"][1]["name"], "confidence");
  EXPECT_FALSE(page.contains("beside"));
}

TEST_F(PageTest, TwoResultsShareAFrameThatHoldsBoth) {
  io::Scene scene = sphere_scene(), other = sphere_scene();
  other.points.rowwise() += Eigen::RowVector3d(3, 0, 0);
  other.curves.clear();
  other.source_points.resize(0, 3);
  scene.beside = std::make_shared<const io::Scene>(other);
  const auto page = written(scene);
  EXPECT_EQ(page["frame"], page["beside"]["frame"]);
  const double centre = page["frame"]["centre"][0], radius = page["frame"]["radius"];
  EXPECT_LE(centre - radius, -1);
  EXPECT_GE(centre + radius, 4);
  EXPECT_LT(radius, 4);
}

TEST_F(PageTest, TextCannotEscapeIntoThePage) {
  io::Scene scene = sphere_scene();
  const std::string evil = "</script></title><script>window.smuggled = 1</script>\xff";
  scene.title = scene.field_name = evil;
  scene.facts = {{evil, evil}};
  const auto page = written(scene);
  EXPECT_EQ(page["title"].get<std::string>().substr(0, 9), "</script>");
  EXPECT_EQ(slurp(path).find("window.smuggled = 1</script>"), std::string::npos);
}

TEST_F(PageTest, ExtremeScalesStayFinite) {
  for (const double scale : {1e-150, 1e150}) {
    io::Scene scene = sphere_scene();
    scene.curves.clear();
    scene.source_points *= scale;
    scene.points *= scale;
    scene.values *= scale;
    const auto field = written(scene)["fields"][0];
    EXPECT_GT(field["spacing"], 0.0);
    EXPECT_EQ(field["high"].get<double>(), scene.values.maxCoeff());
  }
}

TEST_F(PageTest, RefusesBadScenesAndPaths) {
  EXPECT_THROW(io::write_page(path, io::Scene{}), InputError);
  EXPECT_FALSE(fs::exists(path));
  EXPECT_THROW(io::write_page("/nonexistent-folder/page.html", sphere_scene()), IoError);
}

// What a picture shows in sight at vertices, or at the middles of faces where each has a light of
// its own, for the browser's test to compare the page with: place, red, green, blue.
nlohmann::json picture_colours(io::Scene scene) {
  scene.curves.clear();
  scene.source_points.resize(0, 3);
  const io::PictureOptions options{.width = 640, .height = 640, .colour_bar = false};
  const io::Image image = io::draw_picture(scene, options);
  const double margin = 0.04 * 640 + 4;
  const io::Camera camera =
      io::fit_camera(scene, options, {margin, margin, 640 - margin, 640 - margin});
  const Vec3 eye = io::scene_frame(scene).towards_eye;
  MatX3 places = scene.points;
  if (scene.shading == io::Shading::flat) {
    places.resize(scene.triangles.rows(), 3);
    for (Eigen::Index t = 0; t < places.rows(); ++t) {
      const Eigen::RowVector3i corners = scene.triangles.row(t);
      places.row(t) = (scene.points.row(corners[0]) + scene.points.row(corners[1]) +
                       scene.points.row(corners[2])) /
                      3;
    }
  }
  nlohmann::json seen = nlohmann::json::array();
  for (Eigen::Index v = 0; v < places.rows(); v += 3) {
    const Vec3 p = places.row(v);
    if (p.dot(eye) < 0.5) continue;
    const Vec3 at = camera.project(p);
    const auto i =
        3 * static_cast<std::size_t>(static_cast<int>(at[1]) * 640 + static_cast<int>(at[0]));
    seen.push_back({p[0], p[1], p[2], image.rgb[i], image.rgb[i + 1], image.rgb[i + 2]});
  }
  return seen;
}

// With a dent in what is seen, which is dark where less of the sky is seen.
io::Scene dented(io::Scene scene) {
  const Vec3 eye = io::scene_frame(scene).towards_eye;
  scene.towards_eye = eye;
  for (auto p : scene.points.rowwise()) p *= 1 - 0.4 * std::exp(-8 * (1 - p.dot(eye)));
  return scene;
}

// The page that viewer/test opens in a browser; see there.
TEST_F(PageTest, WritesThePageForTheBrowserTest) {
  io::Scene scene = sphere_scene();
  scene.title = "sphere <script>window.smuggled = 1</script>";
  Eigen::Index vertex;
  (scene.points * io::scene_frame(scene).towards_eye + 0.3 * scene.points.col(0)).maxCoeff(&vertex);
  scene.facts = {{"method", "test <img src=x onerror=window.smuggled=1>"},
                 {"vertex", std::to_string(vertex)},
                 {"value", io::label_text(scene.values[vertex])}};
  scene.nodes = io::SceneNodes::faces;
  scene.warnings = {"a <b>warning</b>"};
  const VecX sureness = 0.3 + 0.6 * scene.points.col(1).array().square();
  scene.more = {{"confidence", sureness}};
  const char* out = std::getenv("LITTORAL_PAGE_OUT");
  io::write_page(out ? fs::path(out) : path, scene);
  if (out) {
    // Also of another field, of other kinds of shading, and as discs.
    nlohmann::json colours = {{"smooth", picture_colours(scene)}};
    io::Scene sure = scene;
    sure.values = scene.more[0].values;
    sure.field_name = "confidence";
    sure.isolines = 0;
    colours["confidence"] = picture_colours(sure);
    io::Scene other = dented(scene);
    io::write_page(std::string(out) + ".dented.html", other);
    for (const auto& [name, shading] :
         {std::pair("flat", io::Shading::flat), std::pair("occluded", io::Shading::occluded)}) {
      other.shading = shading;
      colours[name] = picture_colours(other);
    }
    io::show_as_discs(scene);
    io::write_page(std::string(out) + ".discs.html", scene);
    colours["discs"] = picture_colours(scene);
    std::ofstream(std::string(out) + ".json") << colours;
  }
  EXPECT_GT(fs::file_size(out ? fs::path(out) : path), 100'000u);
}

TEST(Page, WithoutTheViewerSaysSo) {
  if (io::has_viewer()) GTEST_SKIP() << "built with the viewer";
  EXPECT_THROW(io::write_page("page.html", sphere_scene()), UnsupportedError);
}

}  // namespace
}  // namespace littoral
