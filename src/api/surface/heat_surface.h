#pragma once
// Where the heat methods are solved on a surface: its discretization, or better triangles.

#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include "api/surface/beside_marching.h"
#include "api/surface/discretization.h"
#include "base/lazy.h"
#include "solve/heat/heat_system.h"

namespace littoral {

/// What the method diffuses from the sources: functions can use a cover, vectors cannot.
enum class Diffused { functions, vectors };

/// Operators with sources on them.
struct HeatProblem {
  std::shared_ptr<const Operators> ops;
  SourceSystem terms;
};

/// A triangle mesh on better triangles of the same surface. Curves are cut by the new edges, so
/// these depend on the sources, but for sources at vertices.
class RetriangulatedSurface {
 public:
  RetriangulatedSurface(SurfaceDomain domain, Report& report)
      : domain_(std::move(domain)), T_(triangulation_of(domain_, report)) {}

  const std::shared_ptr<const IntrinsicTriangulation>& given() const { return T_; }

  /// `shared` says whether later solves meet the same operators, so that factors are worth keeping.
  HeatProblem problem(const Sources& sources,
                      const std::function<Diffused(const PlacedSources&)>& needs, bool& shared,
                      Task& task, Report& report) const;

 private:
  struct Made;
  Made made_for(const PlacedSources& placed, Diffused diffused, Report& report,
                const Task& task) const;

  SurfaceDomain domain_;
  std::shared_ptr<const IntrinsicTriangulation> T_;
  Kept<Made> for_vectors_, for_functions_;  // without sources
};

/// What both heat methods share: a discretization, or better triangles.
class HeatSurface {
 public:
  HeatSurface(const SurfaceDomain& domain, bool intrinsic_delaunay, const Task& task,
              Report& report)
      : domain_(domain) {
    if (intrinsic_delaunay)
      fine_.emplace(domain, report);
    else
      plain_.emplace(domain, task, report);
  }
  /// On a discretization that is there.
  explicit HeatSurface(SurfaceDiscretization plain)
      : domain_(plain.domain()), plain_(std::move(plain)) {}

  const SurfaceDomain& domain() const { return domain_; }
  const SurfaceDiscretization& plain() const { return *plain_; }

  /// How many nodes solves have, roughly where these are better triangles.
  Eigen::Index nodes() const {
    return plain_ ? plain_->operators()->scalar.M.size() : 2 * fine_->given()->n_vertices;
  }

  HeatProblem problem(const Sources& sources,
                      const std::function<Diffused(const PlacedSources&)>& needs, bool& shared,
                      Task& task, Report& report) const {
    if (fine_) return fine_->problem(sources, needs, shared, task, report);
    shared = true;
    return {plain_->operators(),
            plain_->system(sources, task.stage(0.1, "placing the sources"), report)};
  }
  SurfaceAnswer at_input(const VecX& phi) const {
    if (plain_) return plain_->at_input(phi);
    return {phi.head(domain_.mesh->n_vertices()), {}};
  }

  /// What the answer is to be measured by, walked beside the solve; null: nothing. Fast marching
  /// takes a tenth of the time of a first solve, and longer than a later one, so it is walked where
  /// there is one only.
  std::unique_ptr<BesideMarching> marching(const Sources& sources, SolveHint hint,
                                           const Task& task) const;
  /// What the answer says about itself.
  void check(BesideMarching* marching, const VecX& phi, const Task& task, Report& report) const;

 private:
  SurfaceDomain domain_;
  std::optional<SurfaceDiscretization> plain_;  // one of the two
  std::optional<RetriangulatedSurface> fine_;
};

/// Signed heat as another method needs it: values at the vertices of the input, which nobody
/// checks. T: the triangulation of a triangle mesh, which may be null.
std::function<VecX(const Sources&, Task, Report&)> unchecked_signed_heat(
    const SurfaceDomain& domain, std::shared_ptr<const IntrinsicTriangulation> T,
    const SignedHeat& options, SolveHint hint, Task task, Report& report);

}  // namespace littoral
