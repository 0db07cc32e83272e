#pragma once
// How a method of distance on surfaces joins the program: one entry in a list, made from an options
// table and a function; checks, flags, reports and documentation follow from that.

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "api/registry.h"
#include "base/report.h"
#include "base/task.h"
#include "base/types.h"
#include "domain/mesh/polygon_soup.h"
#include "domain/mesh/surface_mesh.h"
#include "sources/pieces.h"
#include "sources/surface_sources.h"

namespace littoral {

/// What every method of distance on a surface is given.
struct SurfaceProblem {
  const SurfaceMesh& mesh;  // a mesh without faces is a point cloud
  const SurfaceSources& sources;
  bool flip = false;
  const MatX3* face_normals = nullptr;  // of the boundary of voxels: corrected, faces x 3

  /// "triangle mesh", "polygon mesh", "point cloud" or "voxel surface", as in MethodInfo::domains.
  std::string domain() const;
};

/// What it answers.
struct SurfaceResult {
  VecX values;                       // vertices of the input [length], +inf where no source reaches
  std::optional<PolygonSoup> shown;  // a finer or cut surface with a scalar "distance", for files
                                     // and pages where that says more than the input's vertices
};

using OptionTexts =
    std::vector<std::pair<std::string, std::string>>;  // name, value; others default

/// One method: what the world may know, and how it runs.
struct SurfaceMethod {
  MethodInfo info;
  std::function<void(const OptionTexts&)> check;  // throws InputError unless all can be read
  std::function<SurfaceResult(const SurfaceProblem&, const OptionTexts&, Task&, Report&)> run;
};

/// Reads options by name; throws InputError if the method lacks one or a value is out of range.
template <class S>
S parse_options(const MethodInfo& method, const OptionTable<S>& table, const OptionTexts& texts) {
  S options;
  for (const auto& [name, text] : texts) {
    check_has_option(method, name);
    table.set(options, name, text);
  }
  return options;
}

/// Puts all options with the values used into the report.
template <class S>
void report_options(const OptionTable<S>& table, const S& options, Report& report) {
  for (std::size_t i = 0; i < table.infos().size(); ++i)
    report.options.emplace_back(table.infos()[i].name, table.get(options, i));
}

/// An entry from a table of options S and `run(problem, options, task, report)`, which may change
/// its options to the values used; they are reported afterwards.
template <class S, class Run>
SurfaceMethod surface_method(MethodInfo info, const OptionTable<S>& table, Run run) {
  info.options = table.infos();
  SurfaceMethod method;
  method.check = [info, &table](const OptionTexts& texts) { parse_options(info, table, texts); };
  method.run = [info, &table, run](const SurfaceProblem& problem, const OptionTexts& texts,
                                   Task& task, Report& report) {
    S options = parse_options(info, table, texts);
    SurfaceResult result = run(problem, options, task, report);
    report_options(table, options, report);
    return result;
  };
  method.info = std::move(info);
  return method;
}

/// Places the sources on the mesh (`prepare`), with sizes and seconds in the report; the first 2 %
/// of a task. `on` is a finer mesh with sources of its own, on which they are placed instead.
PreparedSources prepared_sources(const SurfaceProblem& problem, Task& task, Report& report);
PreparedSources prepared_sources(const SurfaceProblem& problem, const SurfaceMesh& on,
                                 const SurfaceSources& sources, Task& task, Report& report);

/// All methods of distance on surfaces, the default first. Each family is a function of its own.
const std::vector<SurfaceMethod>& surface_methods();
std::vector<SurfaceMethod> heat_methods();       // signed and unsigned
std::vector<SurfaceMethod> geodesic_methods();   // exact polyhedral, fast marching
std::vector<SurfaceMethod> quadratic_methods();  // quadratic-order geodesics
std::vector<SurfaceMethod> regularized_methods();

}  // namespace littoral
