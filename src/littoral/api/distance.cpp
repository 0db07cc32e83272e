#include "littoral/api/distance.h"

#include <memory>

#include "littoral/api/registry.h"
#include "littoral/base/error.h"
#include "littoral/domain/intrinsic_triangulation.h"
#include "littoral/methods/signed_heat.h"
#include "littoral/methods/unsigned_heat.h"
#include "littoral/operators/triangles.h"
#include "littoral/sources/pieces.h"
#include "littoral/sources/triangle_source_terms.h"

namespace littoral {

namespace {

template <class S>
S parse_options(const OptionTable<S>& table, const DistanceRequest& request) {
  const MethodInfo& method = find_method(request.method);
  S options;
  for (const auto& [name, text] : request.options) {
    check_has_option(method, name);
    table.set(options, name, text);
  }
  return options;
}

template <class S>
void report_options(const OptionTable<S>& table, const S& options, Report& report) {
  for (std::size_t i = 0; i < table.infos().size(); ++i)
    report.options.emplace_back(table.infos()[i].name, table.get(options, i));
}

VecX signed_heat(std::shared_ptr<const Operators> ops, const SourceTerms& terms,
                 SignedHeatOptions options, Task& task, Report& report) {
  if (options.time_scale == 0) options.time_scale = automatic_time_scale(terms);
  report_options(signed_heat_options(), options, report);
  const auto method = [&] {
    const Stopwatch watch(report, "factor");
    return SignedHeat(std::move(ops), options.time_scale, task.stage(0.65, "factoring"));
  }();
  return method.solve(terms, options, task.stage(0.25, "solving"), report);
}

VecX unsigned_heat(std::shared_ptr<const Operators> ops, const SourceTerms& terms,
                   const UnsignedHeatOptions& options, Task& task, Report& report) {
  report_options(unsigned_heat_options(), options, report);
  const auto method = [&] {
    const Stopwatch watch(report, "factor");
    return UnsignedHeat(std::move(ops), options, task.stage(0.65, "factoring"));
  }();
  const Stopwatch watch(report, "solve");
  return method.solve(terms, task.stage(0.25, "solving"), report);
}

void report_sizes(const SurfaceMesh& mesh, const PreparedSources& prepared, Report& report) {
  report.sizes.emplace_back("vertices", mesh.n_vertices());
  report.sizes.emplace_back("faces", mesh.n_faces());
  report.sizes.emplace_back("edges", mesh.n_edges());
  report.sizes.emplace_back("components", mesh.n_components());
  report.sizes.emplace_back("source_curves", prepared.n_curves);
  report.sizes.emplace_back("source_pieces", static_cast<double>(prepared.pieces.size()));
  report.sizes.emplace_back("source_points", static_cast<double>(prepared.points.size()));
}

}  // namespace

void check_request(const DistanceRequest& request) {
  if (find_method(request.method).name == "signed-heat")
    parse_options(signed_heat_options(), request);
  else
    parse_options(unsigned_heat_options(), request);
}

VecX surface_distance(const SurfaceMesh& mesh, const SurfaceSources& sources,
                      const DistanceRequest& request, Task task, Report& report) {
  check_request(request);
  report.method = request.method;
  report.domain = "triangle mesh";
  const PreparedSources prepared = [&] {
    const Stopwatch watch(report, "sources");
    return prepare(mesh, sources, request.flip, report, task.stage(0.02, "placing the sources"));
  }();
  report_sizes(mesh, prepared, report);
  task.checkpoint();
  const IntrinsicTriangulation triangulation = [&] {
    const Stopwatch watch(report, "triangulation");
    return intrinsic_triangulation(mesh, report);
  }();
  task.stage(0.03, "operators").checkpoint();
  const auto [ops, terms] = [&] {
    const Stopwatch watch(report, "operators");
    return std::pair(std::make_shared<const Operators>(triangle_operators(triangulation)),
                     source_terms(mesh, triangulation, prepared));
  }();
  task.stage(0.05, "heat method").checkpoint();
  return request.method == "signed-heat"
             ? signed_heat(ops, terms, parse_options(signed_heat_options(), request), task, report)
             : unsigned_heat(ops, terms, parse_options(unsigned_heat_options(), request), task,
                             report);
}

}  // namespace littoral
