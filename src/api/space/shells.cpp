#include "api/space/shells.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/option_table.h"
#include "contour/isosurface.h"
#include "contour/redistance.h"
#include "io/write.h"

namespace littoral {

namespace {

// The field of the shape {distance <= level} taken out to `reach` beyond its surface, less `back`:
// the second of two offsets.
VolumeField offset_back(const VolumeField& distance, double level, double back, double reach,
                        const char* name, Report& report, Task task) {
  Report unheard;  // open at the box: the result says so itself
  const PolygonSoup surface = isosurface(distance.grid, distance.values, level, {}, unheard,
                                         task.stage(0.3, std::string(name) + ": first offset"));
  if (surface.n_faces() == 0)
    throw InputError(std::string(name) + " by " + number_text(std::abs(level)) +
                     " leaves nothing: no surface at distance " + number_text(level));
  VolumeField field = distance;
  field.values = redistance(distance.grid, distance.values, level, surface, reach,
                            task.stage(0.7, std::string(name) + ": distance to it"));
  field.values.array() -= back;
  report.sizes.emplace_back(std::string(name) + ": triangles between",
                            static_cast<double>(surface.n_faces()));
  return field;
}

}  // namespace

std::vector<Shell> level_shells(const VolumeField& volume, const std::vector<double>& levels,
                                bool close_at_box, Report& report, Task task) {
  std::vector<Shell> shells;
  bool any = false;
  for (const double level : levels) {
    PolygonSoup surface =
        isosurface(volume.grid, volume.values, level, {.close = close_at_box}, report,
                   task.stage(1.0 / static_cast<double>(levels.size()), "contouring"));
    if (surface.n_faces() == 0)
      report.warn("there is no surface at level " + number_text(level) + "; values run from " +
                  number_text(volume.values.minCoeff()) + " to " +
                  number_text(volume.values.maxCoeff()));
    any = any || surface.n_faces() != 0;
    report.sizes.emplace_back("triangles", static_cast<double>(surface.n_faces()));
    shells.push_back({level, std::move(surface)});
  }
  if (!any) throw InputError("none of the levels is met: there is nothing to write");
  return shells;
}

std::vector<Shell> offset_shells(const VolumeField& distance, const std::vector<double>& offsets,
                                 const Morphology& morphology, bool close_at_box, Report& report,
                                 Task task) {
  const double open = morphology.open, close = morphology.close;
  if (!(open >= 0) || !(close >= 0) || !std::isfinite(open + close))
    throw InputError("offset: the radii of opening and closing must not be negative");
  double farthest = 0;
  for (const double d : offsets) farthest = std::max(farthest, std::abs(d));
  // Values are wanted up to the farthest offset, on both sides, and a few nodes beyond.
  const double more = farthest + 3 * distance.grid.spacing.norm();
  VolumeField field = distance;
  if (open > 0)
    field = offset_back(field, -open, open, 2 * open + close + more, "opening", report,
                        task.stage(0.3, "opening"));
  if (close > 0)
    field = offset_back(field, close, -close, 2 * close + more, "closing", report,
                        task.stage(0.3, "closing"));
  return level_shells(field, offsets, close_at_box, report, task.stage(1, "contouring"));
}

PolygonSoup join_shells(const std::vector<Shell>& shells) {
  PolygonSoup all;
  Eigen::Index points = 0;
  for (const Shell& shell : shells) points += shell.surface.points.rows();
  all.points.resize(points, 3);
  VecX level(points);
  Eigen::Index used = 0;
  for (const Shell& shell : shells) {
    const PolygonSoup& s = shell.surface;
    all.points.middleRows(used, s.points.rows()) = s.points;
    level.segment(used, s.points.rows()).setConstant(shell.level);
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

void write_shells(const std::vector<std::string>& files, const std::vector<Shell>& shells) {
  if (files.size() == 1) {
    io::write_surface(files.front(), join_shells(shells));
    return;
  }
  if (files.size() != shells.size())
    throw InputError("there are " + std::to_string(files.size()) + " output files for " +
                     std::to_string(shells.size()) +
                     " levels: name one file for all, or one for each");
  for (std::size_t i = 0; i < files.size(); ++i)
    io::write_surface(files[i], join_shells({shells[i]}));
}

}  // namespace littoral
