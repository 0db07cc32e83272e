#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "api/space/volume_meaning.h"
#include "api/surface/mesh_info.h"
#include "api/surface/surface_advice.h"
#include "base/index.h"
#include "base/option_table.h"
#include "domain/tet/tet_locator.h"
#include "littoral/error.h"
#include "spatial/triangulate.h"

namespace littoral {

namespace {

/// Of surface_info.
template <class Value>
Value fact_of(const std::vector<InfoEntry>& facts, const std::string& key) {
  const auto found = std::ranges::find(facts, key, &InfoEntry::key);
  return found == facts.end() ? Value() : std::get<Value>(found->value);
}

void add_thickness(std::vector<InfoEntry>& facts, const PolygonSoup& soup) {
  constexpr int samples = 1000;
  const bool measurable = fact_of<bool>(facts, "closed") && fact_of<bool>(facts, "orientable") &&
                          fact_of<double>(facts, "vertices_not_finite") == 0 &&
                          fact_of<double>(facts, "degenerate_faces") < soup.n_faces();
  if (!measurable) return;
  const std::vector<double> balls = inner_ball_diameters(triangulate(soup), samples);
  if (balls.empty()) return;
  facts.push_back({"thickness_5_percent", balls[balls.size() / 20]});
  facts.push_back({"thickness_median", balls[balls.size() / 2]});
}

std::vector<InfoEntry> info_of(const PolygonSoup& soup) {
  std::vector<InfoEntry> facts = surface_info(soup);
  const auto number = [&](const char* key) { return fact_of<double>(facts, key); };
  const auto is = [&](const char* key) { return fact_of<bool>(facts, key); };
  SurfaceTraits traits;
  traits.has_faces = soup.n_faces() > 0;
  traits.has_normals = is("has_normals");
  traits.only_triangles =
      std::all_of(soup.face_offsets.begin() + 1, soup.face_offsets.end(),
                  [before = 0](int end) mutable { return end - std::exchange(before, end) == 3; });
  traits.closed = is("closed");
  traits.watertight = is("watertight");
  traits.orientable = is("orientable");
  traits.boundary_loops = number("boundary_loops");
  traits.nonmanifold_edges = number("nonmanifold_edges");
  traits.turned = number("triangles_turned_against_most");
  traits.crossing = number("self_intersecting_triangles");
  if (const double angle = number("smallest_angle"); angle > 0) traits.smallest_angle = angle;
  add_thickness(facts, soup);
  double longest = 0;
  if (const auto box = fact_of<std::vector<double>>(facts, "bounding_box"); box.size() == 6)
    for (std::size_t a = 0; a < 3; ++a) longest = std::max(longest, box[a + 3] - box[a]);
  facts.push_back({"unit_guess", guess_unit(longest)});
  facts.push_back({"recommendation", recommendation_for(traits)});
  return facts;
}

std::string recommendation_for(const Volume& volume) {
  try {
    if (meaning_of(volume) == VolumeMeaning::distance)
      return "sdf, query, offset: as they are; the values look like signed distance";
  } catch (const InputError&) {
    return "sdf, query, offset: say what the values are with option as, or make them distances "
           "with option redistance; contour takes them as they are";
  }
  try {
    check_side_of_mask(volume, false);
    return "sdf, query, offset: as they are; the values are a mask, what is not 0 is inside";
  } catch (const InputError&) {
    return "sdf, query, offset: the values are a mask, and what is not 0 fills its border: "
           "take option flip where 0 is inside, or say that they are a mask (option as)";
  }
}

std::vector<InfoEntry> info_of(const Volume& volume) {
  const Grid& grid = volume.grid;
  const Vec3 far = grid.point(grid.n[0] - 1, grid.n[1] - 1, grid.n[2] - 1);
  double low = infinity, high = -low;
  double not_finite = 0, negative = 0;
  for (const double value : volume.values) {
    if (value < 0) ++negative;
    if (!std::isfinite(value)) {
      ++not_finite;
      continue;
    }
    low = std::min(low, value);
    high = std::max(high, value);
  }
  const auto triple = [](const Vec3& v) { return std::vector<double>{v[0], v[1], v[2]}; };
  return {{"field", volume.name},
          {"nodes", static_cast<double>(grid.n_nodes())},
          {"nodes_along_axes",
           std::vector<double>{double(grid.n[0]), double(grid.n[1]), double(grid.n[2])}},
          {"spacing", triple(grid.spacing)},
          {"bounding_box", std::vector<double>{grid.origin[0], grid.origin[1], grid.origin[2],
                                               far[0], far[1], far[2]}},
          {"values", std::vector<double>{low, high}},
          {"values_negative", negative},
          {"values_not_finite", not_finite},
          {"recommendation", recommendation_for(volume)}};
}

std::vector<InfoEntry> info_of(const io::TetFile& file) {
  const TetMesh& mesh = file.mesh;
  double flat = 0, inverted = 0, volume = 0, not_finite = 0;
  std::vector<char> used(std::size_t(mesh.n_vertices()), 0);
  Vec3 low = Vec3::Constant(infinity), high = -low;
  for (const auto& tet : mesh.tets.rowwise()) {
    Eigen::Matrix3d edges;
    for (int k = 0; k < 3; ++k)
      edges.row(k) = mesh.points.row(tet[k + 1]) - mesh.points.row(tet[0]);
    for (const int v : tet) {
      used[v] = 1;
      low = low.cwiseMin(mesh.points.row(v).transpose());
      high = high.cwiseMax(mesh.points.row(v).transpose());
    }
    const double signed_volume = edges.determinant() / 6;
    if (!std::isfinite(signed_volume)) {
      ++not_finite;
    } else if (!(std::abs(signed_volume) >
                 1e-14 * std::pow(edges.rowwise().norm().maxCoeff(), 3))) {
      ++flat;
    } else {
      volume += std::abs(signed_volume);
      if (signed_volume < 0) ++inverted;
    }
  }
  const MatX3i boundary = boundary_faces(mesh);
  const std::string fields = listed_names(file.scalars);
  return {{"vertices", double(mesh.n_vertices())},
          {"tets", double(mesh.n_tets())},
          {"triangles", double(file.triangles.rows())},
          {"boundary_faces", double(boundary.rows())},
          {"unused_vertices", double(std::count(used.begin(), used.end(), 0))},
          {"flat_tets", flat},
          {"inverted_tets", inverted},
          {"tets_with_numbers_not_finite", not_finite},
          {"volume", volume},
          {"bounding_box", std::vector<double>{low[0], low[1], low[2], high[0], high[1], high[2]}},
          {"fields", fields.empty() ? "none" : fields},
          {"recommendation",
           std::string(flat + inverted > 0 ? "distance: auto; flat and inverted tets make it less "
                                             "exact around them"
                                           : "distance: auto")}};
}

}  // namespace

std::vector<InfoEntry> content_info(const io::Content& content) {
  return std::visit([](const auto& held) { return info_of(held); }, content);
}

}  // namespace littoral
