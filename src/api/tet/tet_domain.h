#pragma once
// Tet meshes as a domain of methods.

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "api/method.h"
#include "api/space/frame.h"
#include "base/lazy.h"
#include "domain/tet/tet_locator.h"
#include "littoral/tet_mesh.h"
#include "littoral/tet_sources.h"
#include "operators/tet_operators.h"
#include "sources/space/oriented_points.h"
#include "sources/space/space_distances.h"
#include "sources/space/tet_source_system.h"

namespace littoral {

/// A tet mesh. Answers are distances at its vertices [length]; +inf on components that no source
/// reaches, and at vertices of no tet. Flat and inverted tets are harmless; parts of a surface
/// outside the tets are left out, with a warning.
///
/// Errors: InputError for bad input and if no source lies in a tet, UnsupportedError for both kinds
/// of sources together and for values that the method does not tell apart, IoError where memory
/// will not do, Cancelled.
struct TetDomain {
  using Sources = TetSources;
  using Answer = VecX;
  static constexpr const char* title = "Distance through tets";

  std::shared_ptr<const TetMesh> mesh;

  std::string kind() const { return "tet mesh"; }
};

template <>
std::vector<Method<TetDomain>> library_methods();
// Its families:
std::vector<Method<TetDomain>> automatic_tet_methods();
std::vector<Method<TetDomain>> heat_tet_methods();
std::vector<Method<TetDomain>> regularized_tet_methods();
std::vector<Method<TetDomain>> quadratic_tet_methods();

/// Sources on a mesh, moved and scaled to about unit size about the origin: vertices of it, or a
/// surface with samples.
struct TetProblem {
  std::shared_ptr<const TetMesh> mesh;
  std::shared_ptr<const TetOperators> ops;
  std::vector<int> vertices;                  // ascending, each once, where values differ
  PolygonSoup surface;                        // triangles, or points with normals; as flipped
  OrientedPoints samples;                     // of the surface
  std::vector<TetPoint> places;               // of the samples
  std::vector<int> part;                      // of the samples, where parts are told apart
  std::shared_ptr<const TetLocator> locator;  // of these
  double h = 0;                               // between samples
  double value = 0;                           // [length] what all of the source is counted from
  // What its parts are counted from where they differ, beside that: of the vertices, or of the
  // surface's triangles or a cloud's points. Empty: all the same.
  std::vector<double> values;
  std::vector<double> sample_values;  // likewise

  /// The tets of some volume that hold sources, each once.
  std::vector<int> tets_with_sources() const;
  /// Components with sources. Throws InputError if there is none.
  std::vector<char> reached() const;
  /// A row for each vertex of the source or, of a surface, for each vertex next to it, of the
  /// samples nearest to that.
  TetSourceSystem terms() const;
  /// The part of a surface with faces that is counted from this value.
  TetProblem of_value(double counted) const;
  /// What is known around the source at nodes of tets of some volume: barycentrics of a tet's
  /// nodes, and `node(tet, i)`, their numbers. Of vertices, 0 there and nothing else. Throws
  /// UnsupportedError where values differ.
  std::map<int, TetNodeDistance> known(const std::vector<Eigen::Vector4d>& local,
                                       const std::function<int(int, int)>& node,
                                       Around around) const;
};

/// The mesh and its operators, moved and scaled; made once, for any sources.
class TetDiscretization {
 public:
  TetDiscretization(const TetMesh& mesh, Task task, Report& report);

  const std::shared_ptr<const TetMesh>& mesh() const { return mesh_; }
  const std::shared_ptr<const TetOperators>& operators() const { return ops_; }
  double unit() const { return frame_.unit; }  // [length]

  TetProblem problem(const TetSources& sources, Task task, Report& report) const;

 private:
  void place(TetProblem& problem, const TetSources& sources, const std::vector<double>& values,
             Task& task, Report& report) const;
  void warn_of_shadowed(const TetProblem& problem, Report& report) const;

  Frame frame_;
  std::shared_ptr<const TetMesh> mesh_;
  std::shared_ptr<const TetOperators> ops_;
  Kept<TetLocator> locator_;
};

/// A method from `make(discretization, options, hint)`, which returns what solves: a callable
/// (problem, options, task, report) -> values at the vertices, in the problem's units.
template <class S, class Make>
Method<TetDomain> make_tet_method(MethodInfo info, const OptionTable<S>& table, Make make) {
  info.domains = {"tet mesh"};
  return make_method<TetDomain>(
      std::move(info), table,
      [make](const TetDomain& domain, const S& options, SolveHint hint, const Task& task,
             Report& report) {
        const auto on = std::make_shared<const TetDiscretization>(*domain.mesh, task, report);
        return [on, solve = make(on, options, hint)](const TetSources& sources, S& used, Task& t,
                                                     Report& r) -> VecX {
          const TetProblem problem = on->problem(sources, t.stage(0.1, "placing the sources"), r);
          return (solve(problem, used, t, r) * on->unit()).array() + problem.value;
        };
      });
}

/// phi as large as a unit gradient allows, with the same zero set; rows (rows x vertices) at which
/// it vanishes. `domain` names the mesh in messages.
VecX sharpened_on_tets(const std::shared_ptr<const TetOperators>& ops, const std::string& domain,
                       const SpMat& rows, const VecX& phi, const Task& task, Report& report);

/// Throws IoError unless the operators of a mesh fit into memory: "a mesh of " and what to do.
void check_tet_memory(const TetMesh& mesh, const std::string& what, const std::string& remedy);

}  // namespace littoral
