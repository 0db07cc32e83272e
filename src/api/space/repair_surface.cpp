#include "api/space/repair_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "api/space/input_queries.h"
#include "api/space/surface_difference.h"
#include "api/surface/mesh_info.h"
#include "base/disjoint_sets.h"
#include "base/option_table.h"
#include "contour/fit_to_surface.h"
#include "contour/isosurface.h"
#include "contour/redistance.h"
#include "littoral/error.h"
#include "spatial/triangulate.h"

namespace littoral {

namespace {

constexpr std::array resolutions = {64, 96, 128, 192, 256, 384, 512};  // for an error
constexpr int samples = 20000;  // on each surface, for distances
constexpr double missed = 0.5;  // spacings: input farther from the result is not part of it;
                                // twice that where edges are cut off
constexpr double missed_share = 0.01;

void check(const RepairOptions& options, bool is_cloud) {
  for (const auto& [name, value] : {std::pair("error", options.error),
                                    {"thicken", options.thicken},
                                    {"smallest-part", options.smallest_part}})
    if (!(value >= 0 && std::isfinite(value)))
      throw InputError(
          std::string("option ") + name + " must be a length, not " + number_text(value),
          "option-value");
  if (options.thicken > 0 && is_cloud)
    throw UnsupportedError("option thicken is for surfaces: points have no sheets between them",
                           "options-conflict");
  if (options.error > 0 && is_cloud)
    throw UnsupportedError("option error is for surfaces: nothing is known between points",
                           "options-conflict");
}

/// A surface on its way.
struct Made {
  PolygonSoup surface;
  Volume distance;     // whose contour it was
  PolygonSoup target;  // the input and what closes it
  bool fitted = false;
  double moved = 0, kept = 0;  // vertices by the fit
};

Made contoured(const PolygonSoup& input, const RepairOptions& options, const SpaceRequest& request,
               const GridOptions& grid, Task task, Report& report) {
  Made made;
  GridOptions wide = grid;
  if (!grid.bounds && options.thicken > 0) {
    Box box;
    for (const auto& point : input.points.rowwise()) box.add(point.transpose());
    wide.padding += options.thicken / box.size().maxCoeff();
  }
  made.distance.grid = choose_grid(input, wide);
  const double h = made.distance.grid.spacing.minCoeff();
  SpaceAnswer answer =
      grid_answer(input, made.distance.grid, request, task.stage(0.5, "distance"), report);
  made.distance.values = std::move(answer.at_nodes);
  const JoinedTriangles target = join_triangles(input, answer.completion);
  made.target = soup_of(target.points, target.triangles);
  VecX& values = made.distance.values;
  if (options.thicken > 0) {
    if (options.thicken < 2 * h)
      report.warn("wall-thin", "walls of thickness " + number_text(options.thicken) +
                                   " are thinner than two cells of the grid (" +
                                   number_text(2 * h) +
                                   "): they may have holes; use a larger resolution");
    const VecX to_input = redistance(made.distance.grid, values, 0, triangulate(input),
                                     options.thicken + 2 * h, task.stage(0.1, "walls"));
    values = values.cwiseMin((to_input.cwiseAbs().array() - options.thicken / 2).matrix());
  }
  if (!(values.array() < 0).any())
    throw InputError(
        "the input has no inside: no node of the grid lies in it. Sheets become walls with option "
        "thicken; thin parts need a larger resolution; if all of it is reversed, flip it",
        "no-inside");
  // Nodes that lie on a sheet have the value zero: they are not inside.
  made.surface = isosurface(made.distance.grid, values, -1e-9 * h, {.close = true}, report,
                            task.stage(0.1, "contour"));
  untangle(made.surface.points, triangles_of(made.surface), task.stage(0.05, "checking"));
  if (!options.fit || options.thicken > 0 || input.n_faces() == 0) return made;
  const FittedSurface fitted =
      fit_to_surface(made.surface.points, triangles_of(made.surface), target.points,
                     target.triangles, h, task.stage(0.6, "fitting"));
  made.surface = soup_of(fitted.points, fitted.faces);
  made.fitted = true;
  made.moved = fitted.n_moved;
  made.kept = fitted.n_kept;
  return made;
}

/// Closed parts: which one each face is in, the box and the volume of each.
struct Parts {
  std::vector<int> of_face;
  std::vector<Box> boxes;
  std::vector<double> volumes;
};

Parts parts_of(const PolygonSoup& surface) {
  DisjointSets sets(surface.n_vertices());
  for (int f = 0; f < surface.n_faces(); ++f)
    for (const int v : surface.face(f)) sets.join(surface.face(f)[0], v);
  int count = 0;
  const std::vector<int> number = sets.numbered(count);
  Parts parts;
  parts.boxes.resize(static_cast<std::size_t>(count));
  parts.volumes.resize(static_cast<std::size_t>(count), 0);
  std::vector<int> first(static_cast<std::size_t>(count), -1);  // a vertex of each
  for (int f = 0; f < surface.n_faces(); ++f) {
    const auto face = surface.face(f);
    const int part = number[face[0]];
    parts.of_face.push_back(part);
    std::array<Vec3, 3> x;
    for (std::size_t k = 0; k < 3; ++k) {
      x[k] = surface.points.row(face[k]);
      parts.boxes[part].add(x[k]);
    }
    if (first[part] < 0) first[part] = face[0];
    const Vec3 origin = surface.points.row(first[part]);  // near the part: little cancels
    parts.volumes[part] += (x[0] - origin).dot((x[1] - origin).cross(x[2] - origin)) / 6;
  }
  return parts;
}

/// The faces of the parts that stay, with their vertices alone.
PolygonSoup with_parts(const PolygonSoup& surface, const Parts& parts,
                       const std::vector<char>& stays) {
  PolygonSoup out;
  std::vector<int> number(static_cast<std::size_t>(surface.n_vertices()), -1);
  std::vector<int> used;
  for (int f = 0; f < surface.n_faces(); ++f) {
    if (!stays[parts.of_face[f]]) continue;
    std::array<int, 3> face;
    for (std::size_t k = 0; k < 3; ++k) {
      int& v = number[surface.face(f)[k]];
      if (v < 0) {
        v = static_cast<int>(used.size());
        used.push_back(surface.face(f)[k]);
      }
      face[k] = v;
    }
    out.add_face(face);
  }
  out.points.resize(static_cast<Eigen::Index>(used.size()), 3);
  for (std::size_t v = 0; v < used.size(); ++v)
    out.points.row(static_cast<Eigen::Index>(v)) = surface.points.row(used[v]);
  return out;
}

void drop_parts(PolygonSoup& surface, const RepairOptions& options, Report& report) {
  const Parts parts = parts_of(surface);
  std::vector<char> stays(parts.boxes.size(), 1);
  double small = 0, cavities = 0;
  for (std::size_t i = 0; i < stays.size(); ++i) {
    const bool is_small = parts.boxes[i].size().norm() < options.smallest_part;
    const bool is_cavity = parts.volumes[i] < 0;
    if (is_small)
      ++small;
    else if (is_cavity && !options.cavities)
      ++cavities;
    stays[i] = !is_small && (options.cavities || !is_cavity);
  }
  const auto left = std::count(stays.begin(), stays.end(), 1);
  if (left == 0)
    throw InputError("option smallest-part: all " + std::to_string(stays.size()) +
                         " parts are smaller than " + number_text(options.smallest_part),
                     "option-value");
  if (small + cavities > 0) surface = with_parts(surface, parts, stays);
  report.sizes.emplace_back("parts", static_cast<double>(left));
  report.sizes.emplace_back("small parts dropped", small);
  report.sizes.emplace_back("cavities filled", cavities);
}

double value_of(const std::vector<InfoEntry>& facts, const std::string& key) {
  for (const InfoEntry& fact : facts)
    if (fact.key == key) {
      if (const auto* yes = std::get_if<bool>(&fact.value)) return *yes ? 1 : 0;
      return std::get<double>(fact.value);
    }
  throw Error("no fact named " + key);
}

constexpr std::array counted = {"faces",
                                "components",
                                "boundary_edges",
                                "nonmanifold_edges",
                                "nonmanifold_vertices",
                                "inconsistently_oriented_edges",
                                "self_intersecting_triangles"};

void add_counts(const std::string& name, const std::vector<InfoEntry>& facts, Report& report) {
  for (std::string key : counted) {
    const double value = value_of(facts, key);
    std::replace(key.begin(), key.end(), '_', ' ');
    report.sizes.emplace_back(name + ": " + key, value);
  }
}

/// Shares of the input's area that are far from the result: within it, and outside.
struct Missed {
  double inside = 0, outside = 0;
};

Missed missed_parts(const PolygonSoup& input, const Made& made, Task task) {
  const MatX3 points = spread_over(input, samples);
  const Volume& distance = made.distance;
  const double h = distance.grid.spacing.maxCoeff() * (made.fitted ? 1 : 2);
  const VecX far = NearestOnInput(made.surface).at(points, task.stage(1, "comparing")).distances;
  Missed out;
  for (Eigen::Index i = 0; i < far.size(); ++i) {
    if (far[i] <= missed * h) continue;
    // Sheets: the distance about them is positive on both sides; within the result, negative.
    const Vec3 at =
        (points.row(i).transpose() - distance.grid.origin).cwiseQuotient(distance.grid.spacing);
    const Vec3 last =
        Eigen::Map<const Eigen::Vector3i>(distance.grid.n.data()).cast<double>().array() - 1;
    (interpolate(distance, at.cwiseMax(0).cwiseMin(last)) < 0 ? out.inside : out.outside) += 1;
  }
  out.inside /= static_cast<double>(far.size());
  out.outside /= static_cast<double>(far.size());
  return out;
}

/// Counts before and after, distances both ways; warns of what is not as it should be.
void compare(const PolygonSoup& input, Made& made, Report& report, Task task) {
  PolygonSoup& result = made.surface;
  const auto after = surface_info(result);
  if (input.n_faces() > 0) add_counts("input", surface_info(input), report);
  add_counts("result", after, report);
  const double handles =
      value_of(after, "components") - value_of(after, "euler_characteristic") / 2;
  report.sizes.emplace_back("result: handles", handles);
  report.sizes.emplace_back("vertices moved onto the input", made.moved);
  report.sizes.emplace_back("vertices held back so that nothing crosses", made.kept);
  if (const double open = value_of(after, "boundary_edges") + value_of(after, "nonmanifold_edges") +
                          value_of(after, "nonmanifold_vertices"),
      crossing = value_of(after, "self_intersecting_triangles");
      open + crossing > 0) {
    report.status = "uncertain";
    report.warn("result-unsound", "the result is not sound: " + number_text(open) +
                                      " edges or vertices are open or nonmanifold, " +
                                      number_text(crossing) +
                                      " faces cross others; try another resolution");
  }
  const OneSidedDistance to_input =
      one_sided_distance(result, input, samples, task.stage(0.2, "comparing"));
  result.scalars["distance"] = to_input.at_vertices;
  report.sizes.emplace_back("result to input: largest", to_input.largest);
  if (input.n_faces() == 0) return;
  const OneSidedDistance there =
      one_sided_distance(result, made.target, samples, task.stage(0.4, "comparing"));
  const OneSidedDistance back =
      one_sided_distance(input, result, samples, task.stage(0.2, "comparing"));
  for (const auto& [name, value] :
       {std::pair("result to input and closure: largest", there.largest),
        {"result to input and closure: mean", there.mean},
        {"input to result: largest", back.largest},
        {"input to result: mean", back.mean}})
    report.sizes.emplace_back(name, value);
  const Missed share = missed_parts(input, made, task.stage(0.2, "comparing"));
  report.sizes.emplace_back("input within the result, share", share.inside);
  report.sizes.emplace_back("input missed, share", share.outside);
  if (share.outside > missed_share) {
    report.status = "uncertain";
    report.warn(
        "parts-lost",
        number_text(std::round(1000 * share.outside) / 10) +
            " % of the input's area is not part of the result: sheets without an inside, or "
            "parts thinner than the grid; use option thicken, or a larger resolution");
  }
}

double largest_error(const Report& report) {
  for (const auto& [name, value] : report.sizes)
    if (name == "result to input and closure: largest") return value;
  return 0;
}

}  // namespace

PolygonSoup repair_surface(const PolygonSoup& input, const RepairOptions& options,
                           const SpaceRequest& request, Task task, Report& report) {
  check(options, input.n_faces() == 0);
  const Report before = report;
  const auto once = [&](const GridOptions& grid, Task part) {
    report = before;
    Made made = contoured(input, options, request, grid, part.stage(0.7, "surface"), report);
    drop_parts(made.surface, options, report);
    compare(input, made, report, part.stage(0.3, "comparing"));
    return std::move(made.surface);
  };
  if (options.error == 0) return once(options.grid, task);
  PolygonSoup surface;
  for (const int n : resolutions) {
    GridOptions grid = options.grid;
    grid.spacing = {};
    grid.resolution = n;
    surface = once(grid, task.stage(n / 1632.0, "surface"));
    if (largest_error(report) <= options.error) return surface;
  }
  report.status = "uncertain";
  report.warn("accuracy-missed", "the largest error is " + number_text(largest_error(report)) +
                                     " with " + std::to_string(resolutions.back()) +
                                     " nodes, not " + number_text(options.error));
  return surface;
}

}  // namespace littoral
