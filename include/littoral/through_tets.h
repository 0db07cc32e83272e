#pragma once
// Distance through tet meshes.

#include <memory>

#include "littoral/context.h"
#include "littoral/mesh.h"
#include "littoral/methods.h"
#include "littoral/options.h"
#include "littoral/report.h"
#include "littoral/tet_mesh.h"
#include "littoral/tet_sources.h"
#include "littoral/types.h"
#include "littoral/volume.h"

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

/// Tets that fill the cube on the longest side of a grid around a surface or cloud: as small as the
/// grid's spacing, to a power of two, where the input is, and twice as large by every few of them
/// away from it (thesis 4.5). Right-handed, conforming. Throws InputError for options out of
/// range, an input without extent and more than 2^26 tets, IoError where memory will not do,
/// Cancelled.
TetMesh tets_around(const PolygonSoup& input, const GridOptions& options = {},
                    const Context& context = {});

/// The surface on which a field takes the value `level`, with larger values outside; closed unless
/// it meets the boundary of the tets. Throws InputError if it is met nowhere and for values that
/// are not finite.
Mesh isosurface(const TetField& field, double level = 0, const Context& context = {});

}  // namespace littoral
