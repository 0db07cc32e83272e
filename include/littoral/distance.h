#pragma once
// Distance on surfaces: once, for many sources, and between many points.

#include <memory>
#include <vector>

#include "littoral/context.h"
#include "littoral/field.h"
#include "littoral/mesh.h"
#include "littoral/methods.h"
#include "littoral/options.h"
#include "littoral/sources.h"

namespace littoral {

/// Distance from the sources at the vertices of the mesh [length]; signed for signed curves, with
/// positive values to the left of travel. The default is Automatic{}.
///
/// Throws InputError and UnsupportedError for bad input before anything is factored, SolveError if
/// a solve breaks down, IoError where memory will not do, Cancelled.
Field distance(const Mesh& mesh, const Sources& sources, const AnyMethod& method = {},
               const Context& context = {});

/// A method prepared for one mesh: everything that does not depend on the sources is computed once.
/// Copies share it; `solve` may be called from several threads.
class DistanceSolver {
 public:
  explicit DistanceSolver(Mesh mesh, const AnyMethod& method = {}, const Context& context = {});

  /// As `distance`. The field's report holds what was found out about the mesh, and this solve's
  /// seconds.
  Field solve(const Sources& sources, const Context& context = {}) const;

  const Mesh& mesh() const;
  /// Of the preparation.
  const Report& report() const;

  /// For the library's own layers.
  struct Prepared;
  const Prepared& prepared() const { return *prepared_; }

 private:
  std::shared_ptr<const Prepared> prepared_;
};

/// Distances between points of a surface.
struct DistanceMatrix {
  MatX values;  // from x to [length], +inf between components
  Report report;
  operator const MatX&() const { return values; }
};

/// Row i holds the distances from from[i] to all of `to`, by one solve for each row on shared
/// factors, side by side, and sixteen at once by SignedHeat and UnsignedHeat as long as nothing but
/// distance to points is asked of them; Symmetric{} finds all pairs of vertices at once. Values
/// inside faces are linear between the vertices. Errors as for `distance`, and UnsupportedError for
/// Symmetric{} with points that are not vertices.
DistanceMatrix distance_matrix(const Mesh& mesh, const std::vector<SurfacePoint>& from,
                               const std::vector<SurfacePoint>& to, const AnyMethod& method = {},
                               const Context& context = {});

/// The same to all vertices.
DistanceMatrix distance_matrix(const Mesh& mesh, const std::vector<SurfacePoint>& from,
                               const AnyMethod& method = {}, const Context& context = {});

}  // namespace littoral
