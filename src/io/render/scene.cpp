#include "io/render/scene.h"

#include <algorithm>
#include <cmath>

#include "base/index.h"
#include "base/option_table.h"
#include "littoral/error.h"

namespace littoral::io {

namespace {

[[noreturn]] void refuse(const std::string& what, const char* code = "option-value") {
  throw InputError("scene: " + what, code);
}

void check_values(const VecX& values, Eigen::Index n) {
  if (values.size() != n)
    refuse(std::to_string(values.size()) + " values for " + std::to_string(n) + " vertices");
  for (Eigen::Index v = 0; v < n; ++v)
    if (std::isnan(values[v]))
      refuse("the value of vertex " + std::to_string(v) + " is NaN", "not-finite");
}

}  // namespace

Scene make_scene(const PolygonSoup& soup, const std::string& field) {
  Scene scene;
  scene.points = soup.points;
  scene.field_name = field;
  if (const auto it = soup.scalars.find(field); it != soup.scalars.end()) scene.values = it->second;
  if (const auto it = soup.scalars.find("weight"); it != soup.scalars.end() && field != "weight")
    if (scene.values.size() && it->second.minCoeff() >= 0 && it->second.maxCoeff() <= 1)
      scene.weights = it->second;
  for (const auto& [name, values] : soup.scalars)
    if (name != field && name != "weight" && values.size() == soup.points.rows() &&
        !values.hasNaN())
      scene.more.push_back({name, values});
  Eigen::Index count = 0;
  bool polygons = false;
  for (int f = 0; f < soup.n_faces(); ++f) {
    const auto corners = index(soup.face(f).size());
    count += std::max<Eigen::Index>(0, corners - 2);
    polygons |= corners > 3;
  }
  scene.triangles.resize(count, 3);
  if (polygons) scene.inner_sides.assign(std::size_t(count), 0);
  Eigen::Index t = 0;
  for (int f = 0; f < soup.n_faces(); ++f) {
    const auto face = soup.face(f);
    for (std::size_t k = 2; k < face.size(); ++k, ++t) {
      scene.triangles.row(t) << face[0], face[k - 1], face[k];
      if (!polygons) continue;
      scene.faces.push_back(f);
      const int first = k > 2 ? 1 : 0, last = k + 1 < face.size() ? 4 : 0;
      scene.inner_sides[t] = static_cast<unsigned char>(first | last);
    }
  }
  return scene;
}

void add_sources(Scene& scene, const SurfaceMesh& mesh, const Sources& sources) {
  if (scene.points.rows() == mesh.n_vertices())
    scene.nodes = mesh.n_faces() > 0 ? SceneNodes::faces : SceneNodes::vertices;
  for (const Curve& curve : sources.curves) {
    SceneCurve shown{MatX3(index(curve.nodes.size()), 3), curve.is_signed};
    for (std::size_t i = 0; i < curve.nodes.size(); ++i) {
      shown.points.row(index(i)) = mesh.position(curve.nodes[i]).transpose();
    }
    scene.curves.push_back(std::move(shown));
  }
  for (const SpaceCurve& curve : sources.space_curves) {
    scene.curves.push_back({curve.points, curve.is_signed});
  }
  const Eigen::Index before = scene.source_points.rows();
  const auto added = index(sources.points.size());
  scene.source_points.conservativeResize(before + added, 3);
  for (Eigen::Index i = 0; i < added; ++i) {
    scene.source_points.row(before + i) = mesh.position(sources.points[i]).transpose();
  }
}

void describe(Scene& scene, const std::string& title, const Report& report) {
  scene.title = title;
  if (report.method.empty()) return;
  std::vector<std::pair<std::string, std::string>> facts = {{"method", report.method},
                                                            {"domain", report.domain}};
  for (const auto& [name, size] : report.sizes) {
    const std::pair fact(name, number_text(size));
    const bool known = std::find(facts.begin(), facts.end(), fact) != facts.end();
    if (size == std::floor(size) && !known) facts.push_back(fact);  // counts, once each
  }
  facts.insert(facts.end(), scene.facts.begin(), scene.facts.end());
  double seconds = 0;
  for (const auto& [stage, time] : report.timings) seconds += time;
  facts.emplace_back("time", number_text(std::round(100 * seconds) / 100) + " s");
  scene.facts = std::move(facts);
  scene.options.insert(scene.options.end(), report.options.begin(), report.options.end());
  for (const Warning& warning : report.warnings) scene.warnings.push_back(warning.text);
}

void check_scene(const Scene& scene) {
  const Eigen::Index n = scene.points.rows();
  if (scene.triangles.rows() == 0) refuse("the surface has no faces to show", "empty-input");
  for (Eigen::Index t = 0; t < scene.triangles.rows(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int v = scene.triangles(t, k);
      if (v < 0 || v >= n) {
        refuse("triangle " + std::to_string(t) + " refers to vertex " + std::to_string(v) +
               ", there are " + std::to_string(n));
      }
      if (!scene.points.row(v).allFinite()) {
        refuse("vertex " + std::to_string(v) + " is not finite", "not-finite");
      }
    }
  }
  if (!scene.inner_sides.empty() && index(scene.inner_sides.size()) != scene.triangles.rows()) {
    refuse("inner_sides must have one entry per triangle");
  }
  if (!scene.faces.empty() && index(scene.faces.size()) != scene.triangles.rows()) {
    refuse("faces must have one entry per triangle");
  }
  if (scene.values.size() != 0) check_values(scene.values, n);
  for (const SceneField& field : scene.more) check_values(field.values, n);
  if (scene.weights.size() != 0 && (scene.weights.size() != n || !(scene.weights.minCoeff() >= 0 &&
                                                                   scene.weights.maxCoeff() <= 1)))
    refuse("weights must be between 0 and 1, one per vertex");
  if (scene.discs.rows() != 0 && (scene.discs.rows() != n || !scene.discs.allFinite()))
    refuse("discs must be finite, one per vertex");
  for (const SceneCurve& curve : scene.curves) {
    if (!curve.points.allFinite()) refuse("a source curve has a node that is not finite");
  }
  if (!scene.source_points.allFinite()) refuse("a source point is not finite");
  for (const double level : scene.levels) {
    if (!std::isfinite(level)) refuse("an isoline level is not finite");
  }
  if (scene.isolines < 0) refuse("the number of isolines is negative");
  if (scene.beside) check_scene(*scene.beside);
}

}  // namespace littoral::io
