#pragma once
// Any method in one call: prepared for a domain and solved once.

#include <memory>
#include <utility>
#include <vector>

#include "api/surface/pairs.h"
#include "api/surface/surface_domain.h"
#include "api/surface/winding.h"
#include "api/tet/tet_domain.h"

namespace littoral::test {

inline SurfaceAnswer surface_answer(const SurfaceMesh& mesh, const Sources& sources,
                                    const AnyMethod& method, Report& report,
                                    const MatX3* face_normals = nullptr) {
  return solve_once(method, domain_of(mesh, face_normals), sources, {}, report);
}

inline VecX surface_distance(const SurfaceMesh& mesh, const Sources& sources,
                             const AnyMethod& method, Report& report,
                             const MatX3* face_normals = nullptr) {
  return surface_answer(mesh, sources, method, report, face_normals).values;
}

inline PairsAnswer pair_distances(const SurfaceMesh& mesh, const std::vector<int>& vertices,
                                  const AnyMethod& method, Report& report) {
  return littoral::pair_distances(domain_of(mesh), vertices, method, {}, report);
}

/// A solver that is asked for one set of sources at a time.
class OneByOne final : public Solver<SurfaceDomain> {
 public:
  explicit OneByOne(std::shared_ptr<const Solver<SurfaceDomain>> solver)
      : solver_(std::move(solver)) {}
  SurfaceAnswer solve(const Sources& sources, Task task, Report& report) const override {
    return solver_->solve(sources, std::move(task), report);
  }

 private:
  std::shared_ptr<const Solver<SurfaceDomain>> solver_;
};

inline WindingAnswer surface_winding(const SurfaceMesh& mesh, const Sources& sources,
                                     const AnyMethod& method, Report& report) {
  return solve_once(method, WindingDomain{domain_of(mesh).mesh}, sources, {}, report);
}

inline WindingAnswer surface_winding(const SurfaceMesh& mesh, const Sources& sources,
                                     const AnyMethod& method = {}) {
  Report report;
  return surface_winding(mesh, sources, method, report);
}

inline VecX tet_mesh_distance(const TetMesh& mesh, const TetSources& sources,
                              const AnyMethod& method, Report& report) {
  return solve_once(method, TetDomain{std::make_shared<const TetMesh>(mesh)}, sources, {}, report);
}

}  // namespace littoral::test
