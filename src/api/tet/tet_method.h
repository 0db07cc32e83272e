#pragma once
// How a method of distance through tets joins the program: one entry in a list, as on surfaces.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "api/surface/surface_method.h"
#include "domain/tet/tet_mesh.h"
#include "operators/tet_operators.h"
#include "sources/oriented_points.h"
#include "sources/tet_source_terms.h"

namespace littoral {

/// What every method of distance through tets is given, moved and scaled to about unit size about
/// the origin: a mesh, and sources that are vertices of it or a surface with samples.
struct TetProblem {
  std::shared_ptr<const TetMesh> mesh;
  std::shared_ptr<const TetOperators> ops;
  std::vector<int> vertices;
  PolygonSoup surface;
  OrientedPoints samples;        // of the surface
  std::vector<TetPoint> places;  // of the samples
  double h = 0;                  // between samples

  /// The tets of some volume that hold sources, each once.
  std::vector<int> tets_with_sources() const;
  /// A row for each vertex of the source or, of a surface, for each vertex next to it, of the
  /// samples nearest to that.
  TetSourceTerms terms() const;
};

/// One method, of which the methods on surfaces tell the world the rest.
struct TetMethod {
  std::string name;
  std::function<void(const OptionTexts&)> check;  // throws InputError unless all can be read
  /// Values at the vertices of the mesh, +inf where no source reaches.
  std::function<VecX(const TetProblem&, const OptionTexts&, Task&, Report&)> run;
};

/// An entry from a table of options, `read(texts)` that makes them, and `run(problem, options,
/// task, report)`, which may change them to the values used; they are reported afterwards.
template <class S, class Read, class Run>
TetMethod tet_method(std::string name, const OptionTable<S>& table, Read read, Run run) {
  return {std::move(name), [read](const OptionTexts& texts) { read(texts); },
          [&table, read, run](const TetProblem& problem, const OptionTexts& texts, Task& task,
                              Report& report) {
            S options = read(texts);
            VecX distance = run(problem, options, task, report);
            report_options(table, options, report);
            return distance;
          }};
}

/// All methods of distance through tets, the default first. Each family is a function of its own.
const std::vector<TetMethod>& tet_methods();
std::vector<TetMethod> heat_tet_methods();
std::vector<TetMethod> regularized_tet_methods();
std::vector<TetMethod> quadratic_tet_methods();

[[noreturn]] void throw_not_on_tets(const std::string& method);

/// Throws IoError unless the operators of a mesh fit into memory: "a mesh of " and what to do.
void check_tet_memory(const TetMesh& mesh, const std::string& what, const std::string& remedy);

}  // namespace littoral
