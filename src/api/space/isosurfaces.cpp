#include "api/space/isosurfaces.h"

#include <algorithm>
#include <cmath>

#include "base/counted.h"
#include "base/option_table.h"
#include "contour/isosurface.h"
#include "contour/redistance.h"
#include "domain/mesh/surface_mesh.h"
#include "io/write.h"
#include "littoral/error.h"

namespace littoral {

namespace {

// The field of the shape {distance <= level} taken out to `reach` beyond its surface, less `back`:
// the second of two offsets.
Volume offset_back(const Volume& distance, double level, double back, double reach,
                   const char* name, Report& report, Task task) {
  Report unheard;  // open at the box: the result says so itself
  const PolygonSoup surface = isosurface(distance.grid, distance.values, level, {}, unheard,
                                         task.stage(0.3, std::string(name) + ": first offset"));
  if (surface.n_faces() == 0)
    throw InputError(std::string(name) + " by " + rounded_text(std::abs(level)) +
                         " leaves nothing: no surface at distance " + rounded_text(level),
                     "nothing-there");
  Volume field = distance;
  field.values = redistance(distance.grid, distance.values, level, surface, reach,
                            task.stage(0.7, std::string(name) + ": distance to it"));
  field.values.array() -= back;
  report.sizes.emplace_back(std::string(name) + ": triangles between",
                            static_cast<double>(surface.n_faces()));
  return field;
}

/// What to do about a level so near to a sheet between the nodes that none is within it; else
/// empty.
std::string if_too_thin(const Volume& volume, double level) {
  if (!(0 < level && level < volume.values.minCoeff())) return "";
  return "; what lies within it is thinner than the grid: option spacing " + rounded_text(level) +
         " would show it";
}

}  // namespace

std::vector<Isosurface> isosurfaces(const Volume& volume, const std::vector<double>& levels,
                                    bool close_at_box, Report& report, Task task,
                                    const PointwiseDistance* exact) {
  std::vector<Isosurface> surfaces;
  IsosurfaceOptions options{.close = close_at_box};
  if (exact) options.function = [exact](const Vec3& x) { return exact->value(x); };
  bool any = false;
  for (const double level : levels) {
    PolygonSoup surface =
        isosurface(volume.grid, volume.values, level, options, report,
                   task.stage(1.0 / static_cast<double>(levels.size()), "contouring"));
    if (surface.n_faces() == 0)
      report.warn("level-missed",
                  "there is no surface at level " + rounded_text(level) + "; values run from " +
                      rounded_text(volume.values.minCoeff()) + " to " +
                      rounded_text(volume.values.maxCoeff()) + if_too_thin(volume, level));
    any = any || surface.n_faces() != 0;
    report.sizes.emplace_back("triangles", static_cast<double>(surface.n_faces()));
    surfaces.push_back({level, std::move(surface)});
  }
  if (!any)
    throw InputError("the distance takes none of the levels; it runs from " +
                         rounded_text(volume.values.minCoeff()) + " to " +
                         rounded_text(volume.values.maxCoeff()) +
                         (levels.empty() ? "" : if_too_thin(volume, levels.front())),
                     "nothing-there");
  return surfaces;
}

std::vector<Isosurface> offset_isosurfaces(const Volume& distance,
                                           const std::vector<double>& offsets,
                                           const Morphology& morphology, bool close_at_box,
                                           Report& report, Task task,
                                           const PointwiseDistance* exact) {
  const double open = morphology.open, close = morphology.close;
  if (!(open >= 0) || !(close >= 0) || !std::isfinite(open + close))
    throw InputError("offset: the radii of opening and closing must not be negative",
                     "option-value");
  double farthest = 0;
  for (const double d : offsets) farthest = std::max(farthest, std::abs(d));
  // Values are wanted up to the farthest offset, on both sides, and a few nodes beyond.
  const double more = farthest + 3 * distance.grid.spacing.norm();
  Volume field = distance;
  if (open > 0)
    field = offset_back(field, -open, open, 2 * open + close + more, "opening", report,
                        task.stage(0.3, "opening"));
  if (close > 0)
    field = offset_back(field, close, -close, 2 * close + more, "closing", report,
                        task.stage(0.3, "closing"));
  return isosurfaces(field, offsets, close_at_box, report, task.stage(1, "contouring"),
                     open > 0 || close > 0 ? nullptr : exact);
}

std::vector<Isosurface> wall_isosurfaces(const Volume& distance, const std::vector<double>& offsets,
                                         double thickness, const Morphology& morphology,
                                         bool close_at_box, Report& report, Task task,
                                         const PointwiseDistance* exact) {
  if (!(thickness > 0) || !std::isfinite(thickness))
    throw InputError("the thickness of a wall must be positive", "option-value");
  const double spacing = distance.grid.spacing.maxCoeff();
  if (thickness < spacing) {
    constexpr double finest = 1024;  // nodes along the longest side that are worth naming
    const double nodes = *std::max_element(distance.grid.n.begin(), distance.grid.n.end());
    const double needed = std::ceil(2 * spacing / thickness * nodes);
    report.warn("wall-thin",
                "a wall of thickness " + rounded_text(thickness) +
                    " is thinner than the spacing of the grid, " + rounded_text(spacing) +
                    ": it may have holes; " +
                    (needed <= finest
                         ? "option resolution " + number_text(needed) + " has two cells across it"
                         : "take a thicker wall, or smaller option bounds"));
  }
  std::vector<double> levels;
  for (const double d : offsets)
    for (const double side : {0.5, -0.5}) levels.push_back(d + side * thickness);
  Report measured;
  std::vector<Isosurface> sides = offset_isosurfaces(distance, levels, morphology, close_at_box,
                                                     measured, std::move(task), exact);
  measured.warnings.clear();  // of levels, which are said below
  report.merge(measured);
  std::vector<Isosurface> walls;
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    Isosurface& outer = sides[2 * i];
    PolygonSoup& inner = sides[2 * i + 1].surface;
    if (outer.surface.n_faces() == 0)
      throw InputError("no wall at offset " + rounded_text(offsets[i]) +
                           ": its outer surface, at " + rounded_text(outer.level) + ", is empty",
                       "nothing-there");
    if (inner.n_faces() == 0)
      report.warn("wall-thin", "the wall at offset " + rounded_text(offsets[i]) +
                                   " is solid: there is no surface at " +
                                   rounded_text(sides[2 * i + 1].level));
    for (int f = 0; f < inner.n_faces(); ++f)
      std::reverse(inner.corners.begin() + inner.face_offsets[f],
                   inner.corners.begin() + inner.face_offsets[std::size_t(f) + 1]);
    PolygonSoup wall = join_isosurfaces({outer, sides[2 * i + 1]});
    wall.scalars.clear();
    int open_edges = 0;
    const SurfaceMesh mesh(wall);
    for (int e = 0; e < mesh.n_edges(); ++e) open_edges += mesh.edge_faces(e).size() == 1;
    if (open_edges > 0)
      report.warn("open-surface",
                  "the wall at offset " + rounded_text(offsets[i]) + " is open along " +
                      counted(open_edges, "edge", "edges") +
                      " where it meets the box: raise option padding, or use option clip");
    walls.push_back({offsets[i], std::move(wall)});
  }
  return walls;
}

PolygonSoup join_isosurfaces(const std::vector<Isosurface>& surfaces) {
  PolygonSoup all;
  Eigen::Index points = 0;
  for (const Isosurface& shell : surfaces) points += shell.surface.points.rows();
  all.points.resize(points, 3);
  VecX level(points);
  Eigen::Index used = 0;
  for (const Isosurface& shell : surfaces) {
    const PolygonSoup& s = shell.surface;
    all.points.middleRows(used, s.points.rows()) = s.points;
    level.segment(used, s.points.rows()).setConstant(shell.level);
    for (const auto& [name, values] : s.scalars) {
      all.scalars[name].conservativeResize(points);
      all.scalars[name].segment(used, s.points.rows()) = values;
    }
    for (int f = 0; f < s.n_faces(); ++f) {
      std::vector<int> face(s.face(f).begin(), s.face(f).end());
      for (int& v : face) v += static_cast<int>(used);
      all.add_face(face);
    }
    used += s.points.rows();
  }
  if (points > 0) all.scalars["level"] = std::move(level);
  return all;
}

void write_isosurfaces(const std::vector<std::string>& files,
                       const std::vector<Isosurface>& surfaces) {
  if (files.size() == 1) {
    io::write_surface(files.front(), join_isosurfaces(surfaces));
    return;
  }
  if (files.size() != surfaces.size())
    throw InputError("there are " + std::to_string(files.size()) + " output files for " +
                         std::to_string(surfaces.size()) +
                         " levels: name one file for all, or one for each",
                     "usage");
  for (std::size_t i = 0; i < files.size(); ++i)
    io::write_surface(files[i], join_isosurfaces({surfaces[i]}));
}

}  // namespace littoral
