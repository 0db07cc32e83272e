#pragma once
// Signed distance and winding numbers in space, around surfaces, soups and clouds that may be
// broken.

#include <memory>
#include <optional>
#include <vector>

#include "littoral/context.h"
#include "littoral/mesh.h"
#include "littoral/methods.h"
#include "littoral/options.h"
#include "littoral/polygon_soup.h"
#include "littoral/report.h"
#include "littoral/volume.h"

namespace littoral {

class PointwiseDistance;

/// From which side an input is measured.
struct Orientation {
  bool flip = false;              // reverse all normals: the other side is positive
  bool estimate_normals = false;  // of a cloud, instead of those it has
};

/// What the values of a volume stand for.
enum class VolumeMeaning {
  automatic,  // mask or distance where the values say so, otherwise an InputError
  distance,   // signed, negative inside [length]; taken as it is
  mask,       // 0 outside, anything else inside
  density     // larger values are inside
};

/// Values, and their gradients where they were asked for.
struct DistanceSamples {
  VecX values;            // queries [length]
  MatX3 gradients{0, 3};  // queries x 3
};

/// Points to ask at: queries x 3, row by row; other matrices are copied into one.
using Queries = Eigen::Ref<const MatX3>;

/// Where an input is nearest to some points.
struct NearestPoints {
  MatX3 points{0, 3};       // queries x 3
  VecXi elements;           // queries: face of a surface, point of a cloud
  MatX3i corners{0, 3};     // queries x 3: vertices, of polygons those of the triangle cut from it
  MatX3 barycentric{0, 3};  // queries x 3: of these corners, in [0, 1]
  VecX distances;           // queries [length]
};

/// Signed distance around a surface, soup or oriented cloud, negative inside [length]. Immutable;
/// copies share it; may be asked from several threads.
class Sdf {
 public:
  /// At a point. Throws UnsupportedError for methods that need a grid (SpaceSignedHeat,
  /// SpaceRegularized): these can be sampled.
  double operator()(const Vec3& x) const;
  /// Of the formula where it is smooth; zero where it has none.
  Vec3 gradient(const Vec3& x) const;

  /// At points (queries x 3), on all threads. Throws InputError naming a point that is not finite.
  VecX at(const Queries& points, const Context& context = {}) const;
  DistanceSamples with_gradients(const Queries& points, const Context& context = {}) const;

  /// Where the input itself is nearest, without what a method adds to it (queries x 3). The first
  /// call builds a tree. Throws InputError as `at`, UnsupportedError for combinations and volumes.
  NearestPoints closest(const Queries& points, const Context& context = {}) const;
  /// Generalized winding number of the input: 1 inside, 0 outside of a closed surface. Likewise.
  VecX winding_number(const Queries& points, const Context& context = {}) const;
  /// How sure inside and outside are at points, 0 to 1: 1 where the winding number is that of a
  /// closed surface, 0 half way between. Likewise.
  VecX confidence(const Queries& points, const Context& context = {}) const;

  /// At the nodes of a grid. Values scale with the input and do not change when it is moved with
  /// the grid. Throws InputError for a box that misses the input, IoError where memory will not do.
  Volume sample(const Grid& grid, const Context& context = {}) const;

  /// The corners of the box around the input and the balls of its negative values: 2 x 3 [length].
  Eigen::Matrix<double, 2, 3> bounds() const;
  /// Of the preparation.
  const Report& report() const;

  /// For the library's own layers.
  struct Impl;
  explicit Sdf(std::shared_ptr<const Impl> impl) : impl_(std::move(impl)) {}
  const Impl& impl() const { return *impl_; }

 private:
  std::shared_ptr<const Impl> impl_;
};

/// Signed distance to the input: a surface where the soup has faces, otherwise a cloud. Without a
/// method, tori for clouds; surfaces are completed over their holes and then measured.
/// Throws InputError for bad input (nothing to measure from, numbers that are not finite).
Sdf signed_distance(const PolygonSoup& input, const AnyMethod& method = {},
                    const Orientation& orientation = {}, const Context& context = {});
Sdf signed_distance(const Mesh& input, const AnyMethod& method = {},
                    const Orientation& orientation = {}, const Context& context = {});
/// The same counted from values [length]: one for all, or one for each face or each point of a
/// cloud. Around closed surfaces the least of c + d outside and the greatest of c - d inside, d
/// being the distance to what has the value c; around points without normals, which have no sides,
/// the least of c + d, negative in balls of radius -c. Throws UnsupportedError where values differ
/// and the method takes one alone, or has to complete the input.
Sdf signed_distance(const PolygonSoup& input, std::vector<double> values,
                    const AnyMethod& method = {}, const Orientation& orientation = {},
                    const Context& context = {});
/// A volume of signed distance, linear between nodes; outside its box a bound of the distance.
Sdf signed_distance(const Volume& volume);
/// Signed distance to what a volume bounds: voxels of a mask, a density above `threshold` (without
/// one, half way between its extremes), or distance as above. Throws InputError where `automatic`
/// cannot tell, saying what was seen.
Sdf signed_distance(const Volume& volume, VolumeMeaning meaning,
                    const std::optional<double>& threshold = {}, const Context& context = {});

/// The smaller, the larger of two distances, the first without the second; corners where they meet
/// are rounded this far from them [length]. The sign and zero set are right; the magnitude is a
/// bound.
Sdf unite(const Sdf& a, const Sdf& b, double blend = 0);
Sdf intersect(const Sdf& a, const Sdf& b, double blend = 0);
Sdf subtract(const Sdf& a, const Sdf& b, double blend = 0);

/// Generalized winding number at points (queries x 3): 1 inside, 0 outside of a closed surface.
VecX winding_number(const PolygonSoup& input, const MatX3& points,
                    const Orientation& orientation = {}, const Context& context = {});

/// The tori that fit a cloud best, as a cloud that signed_distance takes as it is; by Tori{}.
PolygonSoup fit_tori(const PolygonSoup& cloud, const AnyMethod& tori = {},
                     const Orientation& orientation = {}, const Context& context = {});

/// The surface on which a volume takes the value `level`, with larger values outside; closed unless
/// it meets the box, or everywhere with `close_at_box`. Throws InputError if it is met nowhere.
Mesh isosurface(const Volume& volume, double level = 0, bool close_at_box = false,
                const Context& context = {});

/// What is done to a shape before its offsets are taken [length].
struct Morphology {
  double open = 0;   // erode by this, then dilate: thin parts go
  double close = 0;  // dilate by this, then erode: gaps fill; after opening
};

/// The surfaces at signed distance d from the shape {volume <= 0}, one for each d [length].
std::vector<Mesh> offset(const Volume& distance, const std::vector<double>& distances,
                         const Morphology& morphology = {}, const Context& context = {});

/// The same of a shape that is sampled on a grid, with vertices exactly at the distances where the
/// shape can be asked anywhere; those of a volume are at the distances by interpolation.
std::vector<Mesh> offset(const Sdf& shape, const Grid& grid, const std::vector<double>& distances,
                         const Morphology& morphology = {}, const Context& context = {});

/// A closed wall about the surface at signed distance `at`: the surface half the thickness farther
/// out and, reversed, the one half the thickness farther in [length].
Mesh wall(const Volume& distance, double thickness, double at = 0,
          const Morphology& morphology = {}, const Context& context = {});

}  // namespace littoral
