#pragma once
// Distance through tet meshes.

#include <memory>

#include "littoral/context.h"
#include "littoral/methods.h"
#include "littoral/options.h"
#include "littoral/report.h"
#include "littoral/tet_mesh.h"
#include "littoral/tet_sources.h"
#include "littoral/types.h"

namespace littoral {

/// Distance at the vertices of a tet mesh.
struct TetField {
  TetMesh mesh;
  VecX values;  // vertices [length], +inf on components that no source reaches
  Report report{};
};

/// A method prepared for one tet mesh; copies share it, `solve` may be called from several threads.
/// The default is TetAutomatic{}: signed from surfaces, unsigned from vertices.
class TetDistanceSolver {
 public:
  explicit TetDistanceSolver(TetMesh mesh, const AnyMethod& method = {},
                             const Context& context = {});
  /// Throws InputError for bad input and if no source lies in a tet, UnsupportedError for both
  /// kinds of sources together, IoError where memory will not do, Cancelled.
  TetField solve(const TetSources& sources, const Context& context = {}) const;

 private:
  struct Prepared;
  std::shared_ptr<const Prepared> prepared_;
};

TetField distance(const TetMesh& mesh, const TetSources& sources, const AnyMethod& method = {},
                  const Context& context = {});

}  // namespace littoral
