#include "api/surface/level_lines.h"

#include <cmath>

#include "base/index.h"
#include "base/option_table.h"
#include "littoral/error.h"

namespace littoral {

namespace {

// Signed distance from the line {values = level}, less `back`.
VecX offset_back(const Solver<SurfaceDomain>& solver, const SurfaceMesh& mesh, const VecX& values,
                 double level, double back, const char* name, Report& report, Task task) {
  Sources between;
  for (Polyline& line : isolines(mesh, values, level)) {
    Curve curve;
    curve.nodes = std::move(line.nodes);
    if (line.closed) curve.nodes.push_back(curve.nodes.front());
    // A line has larger values on its left, a signed curve its positive side: the sign stays.
    between.curves.push_back(std::move(curve));
  }
  if (between.curves.empty())
    throw InputError(std::string(name) + " by " + number_text(std::abs(level)) +
                         " leaves nothing: no line at distance " + number_text(level),
                     "nothing-there");
  Report second;
  VecX distance = solver.solve(between, std::move(task), second).values;
  for (const auto& [stage, seconds] : second.timings)
    report.timings.emplace_back(std::string(name) + ": " + stage, seconds);
  for (const auto& [code, text] : second.warnings)
    report.warn(code, std::string(name) + ": " + text);
  distance.array() -= back;
  return distance;
}

}  // namespace

std::vector<LevelLines> level_lines(const SurfaceMesh& mesh, const VecX& values,
                                    const std::vector<double>& levels, Report& report, Task task) {
  std::vector<LevelLines> all;
  bool any = false;
  for (const double level : levels) {
    task.stage(1.0 / static_cast<double>(levels.size()), "tracing lines").checkpoint();
    all.push_back({level, isolines(mesh, values, level)});
    if (all.back().lines.empty())
      report.warn("level-missed", "there are no lines at level " + rounded_text(level) +
                                      "; values run from " + rounded_text(values.minCoeff()) +
                                      " to " + rounded_text(values.maxCoeff()));
    any = any || !all.back().lines.empty();
  }
  if (!any)
    throw InputError("no face takes one of the levels; values run from " +
                         rounded_text(values.minCoeff()) + " to " + rounded_text(values.maxCoeff()),
                     "nothing-there");
  return all;
}

std::vector<LevelLines> offset_lines(const Solver<SurfaceDomain>& solver, const SurfaceMesh& mesh,
                                     const Sources& sources, const std::vector<double>& offsets,
                                     const Morphology& morphology, Report& report, Task task) {
  const double open = morphology.open, close = morphology.close;
  if (!(open >= 0) || !(close >= 0) || !std::isfinite(open + close))
    throw InputError("offset: the radii of opening and closing must not be negative",
                     "option-value");
  const double steps = 1 + (open > 0) + (close > 0);
  VecX values = solver.solve(sources, task.stage(0.9 / steps, "distance"), report).values;
  if (open > 0)
    values = offset_back(solver, mesh, values, -open, open, "opening", report,
                         task.stage(0.9 / steps, "opening"));
  if (close > 0)
    values = offset_back(solver, mesh, values, close, -close, "closing", report,
                         task.stage(0.9 / steps, "closing"));
  return level_lines(mesh, values, offsets, report, task.stage(1, "tracing lines"));
}

PolygonSoup join_lines(const SurfaceMesh& mesh, const std::vector<LevelLines>& levels) {
  PolygonSoup out;
  std::vector<Vec3> points;
  std::vector<double> level_of_point;
  for (const LevelLines& level : levels) {
    for (const Polyline& line : level.lines) {
      std::vector<int> indices;
      for (const SurfacePoint& node : line.nodes) {
        indices.push_back(static_cast<int>(points.size()));
        points.push_back(mesh.position(node));
        level_of_point.push_back(level.level);
      }
      if (line.closed) indices.push_back(indices.front());
      out.lines.push_back(std::move(indices));
    }
  }
  out.points.resize(index(points.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i) out.points.row(index(i)) = points[i];
  out.scalars["level"] =
      Eigen::Map<const VecX>(level_of_point.data(), index(level_of_point.size()));
  return out;
}

}  // namespace littoral
