#include "cli/plan/plan.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iostream>

#include "api/report_json.h"
#include "base/option_table.h"
#include "base/parallel.h"
#include "base/platform/memory.h"
#include "spatial/boundary_edges.h"
#include "spatial/triangulate.h"

namespace littoral::cli {

namespace {

constexpr double long_run = 30;      // seconds that are said before they pass
constexpr double shared_work = 0.8;  // of the work that threads share: Amdahl's law
constexpr Eigen::Index few_faces = 20000;
constexpr double cells_for_points = 128;  // along the longest side, where points are asked

/// Two digits: more would promise too much.
double rough(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1e", value);
  return std::strtod(text, nullptr);
}

PlannedRun estimated(const RunPlan& plan, const std::string& verb, const MethodInfo& method) {
  PlannedRun out;
  out.reason = (plan.method.empty() ? "the default: " : "asked for: ") + method.summary;
  out.available_memory_mb = std::round(std::min(available_memory(), 1e18) / (1 << 20));
  const std::optional<RunCost> cost =
      run_cost(plan.like.empty() ? verb : plan.like, method.name, plan.elements, plan.work);
  if (!cost) return out;
  const double seconds = plan.share * cost->seconds;
  out.processor_seconds = rough(seconds);
  out.seconds = rough(seconds * (1 - shared_work + shared_work / std::max(1, thread_count())));
  out.memory_mb = rough(plan.share * cost->bytes / (1 << 20));
  return out;
}

/// The shapes in cells of this side.
SurfaceWork surface_work(const CsgShapes& shapes, double side, bool thorough) {
  SurfaceWork work;
  for (const Shape& shape : shapes.all) {
    const MatX3& points = shape.surface.points;
    const MatX3i triangles = triangles_of(triangulate(shape.surface));
    const auto corner = [&](Eigen::Index f, int k) { return Vec3(points.row(triangles(f, k))); };
    double area = 0, free_length = 0;
    for (Eigen::Index f = 0; f < triangles.rows(); ++f)
      area += 0.5 * (corner(f, 1) - corner(f, 0)).cross(corner(f, 2) - corner(f, 0)).norm();
    // Finding them takes a while, which a run whose plan is not shown does not spend.
    if (thorough || triangles.rows() <= few_faces)
      for (const auto& [a, b] : boundary_edges(points, triangles))
        free_length += (points.row(a) - points.row(b)).norm();
    const auto faces = static_cast<double>(triangles.rows());
    work.faces += faces;
    work.cells += area / (side * side);
    work.free_length += free_length / side;
    if (free_length > 0) work.open_faces += faces;
  }
  return work;
}

std::string estimate_text(const std::optional<double>& value, const char* unit) {
  return value ? "about " + number_text(*value) + " " + unit : "not known";
}

RunPlan plan_of_shapes(const CsgShapes& shapes, const std::string& domain, double points) {
  RunPlan plan{shapes.all.front().request.method.name(),
               domain,
               Registry<SpaceDomain>::instance().infos(),
               {},
               points};
  double vertices = 0, faces = 0;
  for (const Shape& shape : shapes.all) {
    vertices += shape.surface.n_vertices();
    faces += shape.surface.n_faces();
  }
  plan.sizes = {{"shapes", static_cast<double>(shapes.all.size())},
                {"vertices", vertices},
                {"faces", faces},
                {domain == "grid" ? "nodes" : "points", points}};
  return plan;
}

}  // namespace

RunPlan plan_in_space(const CsgShapes& shapes, double points, bool thorough) {
  RunPlan plan = plan_of_shapes(shapes, "set of points", points);
  plan.work = surface_work(shapes, longest_side(shapes) / cells_for_points, thorough);
  return plan;
}

RunPlan plan_in_space(const CsgShapes& shapes, const Grid& grid, bool thorough) {
  RunPlan plan = plan_of_shapes(shapes, "grid", static_cast<double>(grid.n_nodes()));
  for (const auto& [name, a] :
       {std::pair("nodes along x", 0), {"nodes along y", 1}, {"nodes along z", 2}})
    plan.sizes.emplace_back(name, grid.n[a]);
  plan.sizes.emplace_back("spacing", grid.spacing.minCoeff());
  plan.work = surface_work(shapes, grid.spacing.minCoeff(), thorough);
  return plan;
}

void add_plan_option(CLI::App& verb, Session& session) {
  verb.add_flag("--dry-run", session.dry_run,
                "read and check the input, and print the method, the sizes and the estimated time "
                "and memory; compute and write nothing");
}

bool planned(const RunPlan& plan, Session& session) {
  const auto found = std::ranges::find(plan.methods, plan.method, &MethodInfo::name);
  const MethodInfo& method = found == plan.methods.end() ? plan.methods.front() : *found;
  const PlannedRun run = estimated(plan, session.record.verb, method);
  if (!session.dry_run) {
    const bool too_much = run.memory_mb.value_or(0) > run.available_memory_mb;
    if (too_much || run.seconds.value_or(0) > long_run) {
      session.note("this will take " + estimate_text(run.seconds, "s") + " and " +
                   estimate_text(run.memory_mb, "MB") +
                   (too_much ? ", more than the " + number_text(run.available_memory_mb) +
                                   " MB that are free without swapping"
                             : "") +
                   (plan.shorter.empty() ? "" : "; " + plan.shorter));
    }
    return false;
  }
  session.print_warnings();
  Report& report = session.report;
  report.method = method.name;
  report.domain = plan.domain;
  report.status = "planned";
  report.sizes = plan.sizes;
  session.record.plan = run;
  if (session.json) {
    session.facts() << run_json(session.record, report) << "\n";
    return true;
  }
  std::ostream& out = session.facts();
  out << "method: " << method.name << " (" << run.reason << ")\ndomain: " << plan.domain << "\n";
  for (const auto& [name, size] : plan.sizes) out << name << ": " << number_text(size) << "\n";
  out << "time: " << estimate_text(run.seconds, "s")
      << "\nprocessor time: " << estimate_text(run.processor_seconds, "s")
      << "\nmemory: " << estimate_text(run.memory_mb, "MB") << ", "
      << number_text(run.available_memory_mb)
      << " MB are free\noutputs: " << listed(session.record.outputs) << "\n";
  return true;
}

}  // namespace littoral::cli
