#pragma once
// The signed heat method (Feng & Crane 2024): distance with a sign, to geometry that may be broken.

#include <memory>
#include <optional>
#include <vector>

#include "base/option_table.h"
#include "base/report.h"
#include "base/task.h"
#include "methods/heat/scalar_heat.h"
#include "methods/heat/vector_heat.h"
#include "operators/calculus.h"
#include "solve/poisson/poisson.h"
#include "sources/source_terms.h"

namespace littoral {

/// How values at the source are held (section 7.1).
enum class Constraint { none, zero_set, level_sets };

/// Afterwards slope 1 almost everywhere and the same signs: on linear elements (section 7.3), or
/// with the zero set as the source of quadratic-order geodesics.
enum class Sharpening { off, on, quadratic };

/// Where the diffused vectors come from where all sources are points.
enum class PointVectors { gradient, radial };

struct SignedHeatOptions {
  double time_scale = 0;  // t = time_scale h^2; 0: automatic_time_scale
  int constraint = static_cast<int>(Constraint::zero_set);
  double soft = 0;  // > 0: penalty instead of the constraint, per mean edge length of source
  bool preserve_normals = false;  // diffused vectors equal the normals at the source itself
  int points = static_cast<int>(PointVectors::gradient);
  bool intrinsic_delaunay = false;  // on better triangles of the same surface
  bool discontinuous = false;       // integrate with the least jumps (section 7.2) instead of none
  double tear = 1;                  // jumps above that many mean edge lengths stay ...
  double smoothing = 1;    // ... others close by heat flow for that many squared ones; 0: all stay
  int sharpen = 0;         // Sharpening
  int sharpen_solver = 0;  // SharpenSolver
  bool bounding_only = false;  // leave out parts of curves that bound nothing
};

/// Names, ranges, defaults and one sentence for each of the above.
const OptionTable<SignedHeatOptions>& signed_heat_options();

/// Time scale used for a source set when the option is 0.
double automatic_time_scale(const SourceTerms& terms);

/// Which diffusions sources need: of vectors, of scalars.
struct Diffusions {
  bool vectors = true, scalars = true;
};
Diffusions needed_diffusions(const SourceTerms& terms, const SignedHeatOptions& options);

/// The factorizations of one domain; immutable, `solve` may be called from several threads.
///
/// Sources diffuse as vectors (eq. 12). For points alone these are the gradient of scalar heat: in
/// the plane the same field, as -grad commutes with diffusion, but one that the boundary does not
/// bend and of which each cell can take the nearest point's.
class SignedHeat {
 public:
  /// Factors M + t L with t = time_scale h^2, for vectors or scalars or both, and L. The operators
  /// are shared, not copied. Expecting one solve only, large heat matrices are left unfactored.
  SignedHeat(std::shared_ptr<const Operators> ops, double time_scale, Task task = {},
             Diffusions diffusions = {}, Expect expect = Expect::many_solves);

  /// The same with another time scale; the order of elimination and the Poisson factor are shared.
  SignedHeat with_time_scale(double time_scale, Task task) const;

  /// Generalized signed distance at the nodes (nodes) [length of the input], +inf on components
  /// that no source reaches. Throws UnsupportedError if a diffusion is needed that was left out.
  VecX solve(const SourceTerms& terms, const SignedHeatOptions& options, Task task,
             Report& report) const;

  /// Steps I and II: unit vectors at the cells (2 cells), 0 where no source reaches.
  VecX directions(const SourceTerms& terms, const SignedHeatOptions& options, const Task& task,
                  Report& report) const;

 private:
  VecX integrate(const SourceTerms& terms, const VecX& Y, const SignedHeatOptions& options,
                 const Task& task, Report& report) const;
  double factor_megabytes() const;
  bool add_across_pinches(const VecX& phi, std::vector<char>& reached, VecX& Y, const Task& task,
                          Report& report) const;

  void factor_heat(double time_scale, Diffusions diffusions, Task& task);

  std::shared_ptr<const Operators> ops_;
  Expect expect_;
  Ordering order_;  // of the nodes
  std::shared_ptr<const Poisson> poisson_;
  double root_t_ = 0;
  std::optional<VectorHeat> heat_;
  std::optional<ScalarHeat> scalar_heat_;
};

}  // namespace littoral
