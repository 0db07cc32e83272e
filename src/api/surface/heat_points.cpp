#include "api/surface/heat_points.h"

#include "base/now_and_then.h"
#include "methods/heat/finalize.h"
#include "methods/heat/time_scale.h"

namespace littoral {

struct FromPoints::Point {
  std::size_t number;  // of its sources
  HeatProblem problem;
  StripDistance best{};
  double scale = 0, first_share = 0;
};

std::vector<FromPoints::Point> FromPoints::placed(std::span<const Sources> sources,
                                                  const Task& task,
                                                  std::span<Report> reports) const {
  const auto needs = [](const PlacedSources&) { return Diffused::functions; };
  std::vector<Point> points;
  for (std::size_t i = 0; i < sources.size(); ++i) {
    stop_if_cancelled(task);
    bool shared = false;
    Task placing;  // which takes little time
    HeatProblem problem = surface_.problem(sources[i], needs, shared, placing, reports[i]);
    if (shared && HeatStrips::takes(problem.terms)) points.push_back({i, std::move(problem)});
  }
  return points;
}

bool FromPoints::diffuse(std::vector<Point>& points, double scale, bool rises,
                         const Task& task) const {
  std::vector<Point*> left;
  for (Point& point : points) left.push_back(&point);
  for (int raised = 0; raised <= most_raises && !left.empty(); ++raised, scale *= 4) {
    const auto strips = strips_at_(points[0].problem.ops, scale);
    if (!strips) return false;
    std::vector<const SourceSystem*> systems;
    for (const Point* point : left) systems.push_back(&point->problem.terms);
    std::vector<StripDistance> distances = strips->solve(systems, values_, task);
    std::vector<Point*> unsettled;
    for (std::size_t k = 0; k < left.size(); ++k) {
      Point& point = *left[k];
      const double share = distances[k].misaligned;
      if (raised == 0) point.first_share = share;
      if (!distances[k].found) {
        point.best.found = false;
        continue;
      }
      if (raised == 0 || share < least_gain * point.best.misaligned) {
        point.best = std::move(distances[k]);
        point.scale = scale;
      }
      if (rises && point.first_share > tolerable_share && point.best.misaligned > settled_share)
        unsettled.push_back(&point);
    }
    left = std::move(unsettled);
  }
  return true;
}

FromPoints::Answers FromPoints::solve(std::span<const Sources> sources, double scale, bool given,
                                      std::span<double> scales, const Task& task,
                                      std::span<Report> reports) const {
  Answers answers(sources.size());
  std::vector<Point> points = placed(sources, task, reports);
  if (points.empty()) return answers;
  const std::shared_ptr<const Operators> ops = points[0].problem.ops;
  const bool rises = may_rise(given ? scale : 0, *ops);
  if (!diffuse(points, scale, rises, task)) return answers;
  for (Point& point : points) {
    if (!point.best.found) continue;
    Report& report = reports[point.number];
    const StripDistance& d = point.best;
    report.iterations.emplace_back("heat passes", d.passes);
    report.residuals.emplace_back("poisson", d.residual);
    report.residuals.emplace_back(misaligned_area_fraction, d.misaligned);
    report.residuals.emplace_back(off_unit_area_fraction, d.off_unit);
    report_unreached(ops->scalar.component, ops->scalar.n_components, point.problem.terms.reached,
                     d.values.size(), report);
    if (point.scale > scale)
      report.warn("time-scale-raised",
                  raised_warning(scale, point.scale, point.first_share, d.misaligned));
    else if (!rises)
      warn_misaligned(report);
    surface_.check(nullptr, d.values, task, report);
    scales[point.number] = point.scale;
    answers[point.number] = surface_.at_input(d.values);
  }
  return answers;
}

}  // namespace littoral
