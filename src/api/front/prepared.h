#pragma once
// What a DistanceSolver shares between its copies.

#include <memory>

#include "api/method.h"
#include "api/surface/surface_domain.h"
#include "littoral/distance.h"

namespace littoral {

struct DistanceSolver::Prepared {
  Mesh mesh;
  Report report;
  std::shared_ptr<const Solver<SurfaceDomain>> solver;
};

}  // namespace littoral
