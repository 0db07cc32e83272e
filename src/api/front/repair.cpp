#include "littoral/repair.h"

#include <utility>

#include "api/front/running.h"
#include "api/space/repair_surface.h"

namespace littoral {

Repaired repair(const PolygonSoup& input, const RepairOptions& options, const AnyMethod& method,
                const Orientation& orientation, const Context& context) {
  return run(context, [&](const Task& task) {
    Report report;
    PolygonSoup surface = repair_surface(
        input, options, {method, orientation.flip, orientation.estimate_normals}, task, report);
    return Repaired{Mesh(std::move(surface)), std::move(report)};
  });
}

}  // namespace littoral
