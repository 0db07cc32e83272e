#include "api/space/repair_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "api/space/input_queries.h"
#include "api/space/kept_surface.h"
#include "api/space/space_input.h"
#include "api/space/surface_difference.h"
#include "api/space/surface_parts.h"
#include "api/space/walls.h"
#include "api/surface/mesh_info.h"
#include "base/counted.h"
#include "base/index.h"
#include "base/option_table.h"
#include "contour/fit_to_surface.h"
#include "contour/isosurface.h"
#include "contour/redistance.h"
#include "littoral/error.h"
#include "littoral/options.h"
#include "spatial/triangulate.h"

namespace littoral {

namespace {

constexpr std::array resolutions = {64, 96, 128, 192, 256, 384, 512};  // for an error
constexpr int most_nodes = 256;    // along the longest side, unless more are asked for
constexpr double hopeless = 1024;  // nodes: thinner parts are not worth a finer grid
constexpr int samples = 20000;     // on each surface, for distances
constexpr double missed = 0.5;     // spacings: input farther from the result is not part of it;
                                   // twice that where edges are cut off
constexpr double missed_share = 0.01;
constexpr double lowered = 0.9;    // of the least error: what counts as lower
constexpr int most_in_vain = 2;    // grids one after the other that do not lower the error
constexpr double usual_wall = 3;   // spacings: thickness of sheets that nobody gave one
constexpr double on_sheet = 1e-9;  // spacings: values of nodes on a sheet are not farther from zero

void check(const RepairOptions& options, bool is_cloud) {
  check_grid_options(options.grid);
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
  double within = 0;           // without a grid: share of the input's area left out
};

double size_named(const Report& report, const std::string& name) {
  for (const auto& [each, value] : report.sizes)
    if (each == name) return value;
  return 0;
}

/// Does it say that memory, or numbers, do not suffice?
bool is_too_large(const Error& error) { return error.code() == "too-large"; }

/// Distance on the grid asked for; without one, on a finer grid where parts are thinner than the
/// spacing of the usual one, if that is possible.
SpaceAnswer answered(const PolygonSoup& input, GridOptions asked, const SpaceRequest& request,
                     Grid& grid, Task task, Report& report) {
  const bool free = !asked.resolution && !asked.spacing;
  if (free) asked.resolution = repair_nodes;
  const Report before = report;
  grid = choose_grid(input, asked);
  SpaceAnswer answer =
      grid_answer(input, grid, request, task.stage(free ? 0.3 : 1, "distance"), report);
  const double needed = size_named(report, "resolution that holds the thin parts");
  if (!free || needed <= repair_nodes || needed > hopeless) return answer;
  const Report of_usual = std::exchange(report, before);
  asked.resolution = static_cast<int>(std::min<double>(needed, most_nodes));
  try {
    const Grid finer = choose_grid(input, asked);
    answer = grid_answer(input, finer, request, task.stage(1, "distance"), report);
    grid = finer;
  } catch (const Error& error) {
    if (!is_too_large(error)) throw;
    report = of_usual;
  }
  return answer;
}

/// The triangles without the first ones that are marked.
PolygonSoup without(const PolygonSoup& triangles, const std::vector<char>& marked) {
  PolygonSoup out;
  out.points = triangles.points;
  for (int f = 0; f < triangles.n_faces(); ++f)
    if (f >= static_cast<int>(marked.size()) || !marked[f]) out.add_face(triangles.face(f));
  return out;
}

Made contoured(const PolygonSoup& input, const RepairOptions& options, const SpaceRequest& request,
               const GridOptions& grid, Task task, Report& report) {
  const Report before = report;
  Made made;
  const Box box = bounding_box(input);
  const double side = box.size().maxCoeff();
  if (options.thicken > 100 * side)
    throw InputError("option thicken must be at most 100 times as long as the input",
                     "option-value");
  SpaceAnswer answer;
  const auto measure = [&](double wall) {
    report = before;
    GridOptions wide = grid;
    if (!grid.bounds && wall > 0) wide.padding += wall / side;
    answer =
        answered(input, wide, request, made.distance.grid, task.stage(0.5, "distance"), report);
  };
  measure(options.thicken);
  double h = made.distance.grid.spacing.minCoeff();
  // Nodes that lie on a sheet have the value zero, but for rounding: they are not inside.
  const auto holds_inside = [&](const VecX& values) {
    return (values.array() < -on_sheet * h).any();
  };
  const bool is_empty = !holds_inside(answer.at_nodes);
  const bool sheets = is_empty && input.n_faces() > 0 && options.thicken == 0;
  const double thicken = sheets ? usual_wall * h : options.thicken;
  if (sheets) {
    const bool room = (box.low - made.distance.grid.origin).minCoeff() >= thicken / 2 + h;
    if (!room && !grid.bounds) measure(thicken);
    h = made.distance.grid.spacing.minCoeff();
    report.status = "uncertain";
    report.warn("sheets-thickened",
                "no node of the grid lies inside of the input: its faces became walls " +
                    rounded_text(thicken) +
                    " thick; option thicken says how thick, a larger option resolution finds thin "
                    "parts, and if all of it is reversed, say option flip");
  }
  made.distance.values = std::move(answer.at_nodes);
  VecX& values = made.distance.values;
  const JoinedTriangles target = join_triangles(input, answer.completion);
  made.target = soup_of(target.points, target.triangles);
  const auto contour = [&] {
    if (!holds_inside(values))
      throw InputError(
          "the input has no inside: no node of the grid lies in it. Thin parts need a larger "
          "option resolution; if all of it is reversed, say option flip",
          "no-inside");
    made.surface = isosurface(made.distance.grid, values, -on_sheet * h, {.close = true}, report,
                              task.stage(0.1, "contour"));
    untangle(made.surface.points, triangles_of(made.surface), task.stage(0.05, "checking"));
  };
  const auto fit = [&](const JoinedTriangles& to) {
    if (!options.fit || input.n_faces() == 0) return;
    const FittedSurface fitted =
        fit_to_surface(made.surface.points, triangles_of(made.surface), to.points, to.triangles, h,
                       task.stage(0.6, "fitting"));
    made.surface = soup_of(fitted.points, fitted.faces);
    made.fitted = true;
    made.moved = fitted.n_moved;
    made.kept = fitted.n_kept;
  };
  Walls walls;
  const Report before_contour = report;
  if (is_empty && thicken > 0) {
    walls = walls_of_all(triangulate(input), made.distance.grid, thicken, task);
  } else {
    contour();
    fit(target);
    if (!(thicken > 0)) return made;
    walls = walls_of(triangulate(input), made.surface, made.distance,
                     missed * (made.fitted ? 1 : 2) * h, thicken, task.stage(0.1, "walls"));
  }
  if (walls.triangles > 0) report = before_contour;  // another surface takes its place
  report.sizes.emplace_back("triangles that became walls", walls.triangles);
  report.sizes.emplace_back("share of the area that became walls", walls.share);
  if (walls.triangles == 0) return made;
  if (thicken < 2 * h)
    report.warn("wall-thin", "walls of thickness " + rounded_text(thicken) +
                                 " are thinner than two cells of the grid (" + rounded_text(2 * h) +
                                 "): they may have holes; raise option resolution");
  const WallDistance to_walls = wall_distance(walls, made.distance.grid, task.stage(0.1, "walls"));
  values = values.cwiseMin(to_walls.at_nodes);
  contour();
  fit(join_triangles(without(made.target, walls.wholly), to_walls.surface));
  return made;
}

void drop_parts(PolygonSoup& surface, const RepairOptions& options, Report& report) {
  const SurfaceParts parts = parts_of(surface);
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
                         " parts are smaller than " + rounded_text(options.smallest_part),
                     "nothing-there");
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

constexpr std::array counted_facts = {"faces",
                                      "components",
                                      "boundary_edges",
                                      "nonmanifold_edges",
                                      "nonmanifold_vertices",
                                      "inconsistently_oriented_edges",
                                      "self_intersecting_triangles"};

void add_counts(const std::string& name, const std::vector<InfoEntry>& facts, Report& report) {
  for (std::string key : counted_facts) {
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
    (is_inside(distance, points.row(i)) ? out.inside : out.outside) += 1;
  }
  out.inside /= static_cast<double>(far.size());
  out.outside /= static_cast<double>(far.size());
  return out;
}

/// Counts before and after, distances both ways; warns of what is not as it should be.
void compare(const PolygonSoup& input, Made& made, bool thickened, Report& report, Task task) {
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
    report.warn(
        "result-unsound",
        "the result is not sound: " +
            counted(static_cast<std::int64_t>(open), "edge or vertex is", "edges or vertices are") +
            " open or nonmanifold, " +
            counted(static_cast<std::int64_t>(crossing), "face crosses", "faces cross") +
            " others; try another option resolution");
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
  const Missed share = made.distance.values.size() > 0
                           ? missed_parts(input, made, task.stage(0.2, "comparing"))
                           : Missed{made.within, 0};
  report.sizes.emplace_back("input within the result, share", share.inside);
  report.sizes.emplace_back("input missed, share", share.outside);
  if (share.outside > missed_share) {
    report.status = "uncertain";
    report.warn(
        "parts-lost",
        number_text(std::round(1000 * share.outside) / 10) +
            " % of the input's area is not part of the result: " +
            (thickened ? "dents at holes, and small parts; raise option resolution"
                       : "sheets without an inside, or parts thinner than the grid; use option "
                         "thicken, or raise option resolution"));
  }
}

}  // namespace

PolygonSoup repair_surface(const PolygonSoup& input, const RepairOptions& options,
                           const SpaceRequest& request, Task task, Report& report) {
  check(options, input.n_faces() == 0);
  chosen_method<SpaceDomain>(request.method)->options(request.method);  // also where none is needed
  const bool as_it_is = !options.remesh && !request.flip && request.method.name().empty();
  const Report before = report;
  auto kept = as_it_is ? kept_surface(input, task.stage(0.3, "looking"), report) : std::nullopt;
  if (kept && options.thicken > 0 && kept->dropped > 0) {  // which becomes walls
    kept.reset();
    report = before;
  }
  if (kept) {
    report.method = SpaceAutomatic::method;
    report.domain = "surface";
    report.sizes.emplace_back("triangles of the input turned, share", kept->turned);
    Made made;
    made.surface = std::move(kept->surface);
    made.target = triangulate(input);
    made.within = kept->dropped;
    drop_parts(made.surface, options, report);
    compare(input, made, options.thicken > 0, report, task.stage(1, "comparing"));
    return std::move(made.surface);
  }
  const auto once = [&](const GridOptions& grid, Task part) {
    report = before;
    Made made = contoured(input, options, request, grid, part.stage(0.7, "surface"), report);
    drop_parts(made.surface, options, report);
    compare(input, made, options.thicken > 0, report, part.stage(0.3, "comparing"));
    return std::move(made.surface);
  };
  if (options.error == 0) return once(options.grid, task);
  PolygonSoup best;
  Report of_best;
  double least = infinity;
  int nodes = 0, in_vain = 0;
  std::string why_not_finer;
  for (const int n : resolutions) {
    GridOptions grid = options.grid;
    grid.spacing = {};
    grid.resolution = n;
    PolygonSoup surface;
    try {
      surface = once(grid, task.stage(n / 1632.0, "surface"));
    } catch (const Error& error) {
      if (nodes == 0 || !is_too_large(error)) throw;
      why_not_finer = "; a finer grid is too large";
      break;
    }
    const double error = size_named(report, "result to input and closure: largest");
    if (error <= options.error) return surface;
    in_vain = error < lowered * least ? 0 : in_vain + 1;
    if (error < least) {
      best = std::move(surface);
      of_best = report;
      least = error;
      nodes = n;
    }
    if (in_vain == most_in_vain) {
      why_not_finer = "; finer grids do not lower it";
      break;
    }
  }
  report = of_best;
  report.status = "uncertain";
  report.warn("accuracy-missed", "the largest error is " + rounded_text(least) + " with " +
                                     std::to_string(nodes) + " nodes, not " +
                                     rounded_text(options.error) + why_not_finer);
  return best;
}

}  // namespace littoral
