#include "api/surface/surface_domain.h"

#include <cmath>

#include "sources/surface/source_values.h"

namespace littoral {

namespace {

/// A method that measures from the least value of the sources.
class FromLeastValue final : public Solver<SurfaceDomain> {
 public:
  FromLeastValue(MethodInfo info, std::string kind,
                 std::shared_ptr<const Solver<SurfaceDomain>> method)
      : info_(std::move(info)), kind_(std::move(kind)), method_(std::move(method)) {}

  SurfaceAnswer solve(const Sources& sources, Task task, Report& report) const override {
    const ValueRange range = value_range(sources);
    const bool finite = std::isfinite(range.low) && std::isfinite(range.high);
    if ((range.low == 0 && range.high == 0) || !finite)  // an error that names the source
      return method_->solve(sources, task, report);
    if (!range.same() && !info_.different_values)
      refuse_different_values(info_, kind_, Registry<SurfaceDomain>::instance().infos());
    SurfaceAnswer answer = method_->solve(shifted_values(sources, -range.low), task, report);
    answer.values.array() += range.low;
    if (answer.shown)
      if (const auto at = answer.shown->scalars.find("distance"); at != answer.shown->scalars.end())
        at->second.array() += range.low;
    return answer;
  }

  AtOnce at_once() const override { return method_->at_once(); }
  Answers solve_together(std::span<const Sources> sources, const Task& task,
                         std::span<Report> reports) const override {
    for (const Sources& each : sources) {
      const ValueRange range = value_range(each);
      if (range.low != 0 || range.high != 0) return Answers(sources.size());
    }
    return method_->solve_together(sources, task, reports);
  }

 private:
  MethodInfo info_;
  std::string kind_;
  std::shared_ptr<const Solver<SurfaceDomain>> method_;
};

}  // namespace

template <>
std::shared_ptr<const Solver<SurfaceDomain>> with_additions<SurfaceDomain>(
    const MethodInfo& info, const SurfaceDomain& domain,
    std::shared_ptr<const Solver<SurfaceDomain>> solver) {
  return std::make_shared<const FromLeastValue>(info, domain.kind(), std::move(solver));
}

std::string SurfaceDomain::kind() const {
  if (face_normals) return "voxel surface";
  if (mesh->n_faces() == 0) return "point cloud";
  return mesh->is_triangle_mesh() ? "triangle mesh" : "polygon mesh";
}

SurfaceDomain domain_of(const SurfaceMesh& mesh, const MatX3* face_normals) {
  if (face_normals && face_normals->rows() != mesh.n_faces())
    throw InputError("there are " + std::to_string(face_normals->rows()) + " normals for " +
                         std::to_string(mesh.n_faces()) + " faces",
                     "sizes-differ");
  const auto borrowed = [](const auto* object) {
    return std::shared_ptr<std::remove_pointer_t<decltype(object)>>(object, [](const auto*) {});
  };
  return {borrowed(&mesh), face_normals ? borrowed(face_normals) : nullptr};
}

}  // namespace littoral
