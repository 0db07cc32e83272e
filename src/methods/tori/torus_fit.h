#pragma once
// Tori from the neighbourhoods of oriented points (thesis, section 5.1.1).

#include <Eigen/Core>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/task.h"
#include "methods/tori/torus.h"
#include "sources/space/oriented_points.h"
#include "spatial/point_tree.h"

namespace littoral {

/// A small network, trained by python/train_torus_fit.py, that says how much each neighbour counts
/// when a torus is fitted. What it sees does not change under rotation, translation and scale.
/// Immutable, may be asked from several threads.
class LearnedFit {
 public:
  static constexpr int neighbours = 16, features = 8, hidden = 24;
  using Features = Eigen::Matrix<float, features, neighbours>;  // one neighbour a column

  /// Logarithms of factors.
  struct Factors {
    Eigen::Matrix<float, 2, neighbours> of_neighbours;  // on the equations of height, of normal
    float of_point, of_torus;  // on that of the point itself; on the torus in the blend
  };

  /// Layers as train_torus_fit.py writes them. Throws InputError naming `file` and what is wrong if
  /// sizes are others than these, a number is missing, not finite or beyond 1e4, or more follows.
  static LearnedFit parse(std::string_view text, const std::string& file);

  /// The one that comes with the library.
  static std::shared_ptr<const LearnedFit> built_in();

  Factors operator()(const Features& seen) const;

 private:
  template <int outputs, int inputs>
  struct Layer {
    Eigen::Matrix<float, outputs, inputs> matrix;
    Eigen::Matrix<float, outputs, 1> offset;
  };
  Layer<hidden, features> first_;      // of a neighbour
  Layer<hidden, 2 * hidden> context_;  // of their means and largest ones
  Layer<hidden, 2 * hidden> second_;   // of a neighbour in its context
  Layer<2, hidden> neighbour_, point_;
};

/// How a torus is fitted to a neighbourhood.
struct TorusFit {
  int neighbours = 8;           // that enter the fit
  double weight_exponent = 2;   // neighbours weigh 1 / distance^this
  double normal_weight = 0.25;  // of a neighbour's normal against its height
  double self_weight = 1.5;     // of passing through the point itself
  double ridge = 1e-3;          // on the three quadratic coefficients
  double curvature_limit = 3;   // |curvature| rho is at most this
  // If not null it multiplies these weights, for points with as many neighbours as it looks at.
  std::shared_ptr<const LearnedFit> learned = nullptr;

  static TorusFit by(std::shared_ptr<const LearnedFit> learned) {
    TorusFit fit;
    fit.learned = std::move(learned);
    return fit;
  }
  /// For clouds as they are, and for noisy ones: more neighbours, of more equal weight, and less
  /// trust in the point itself.
  static TorusFit exact() { return {}; }
  static TorusFit noisy() { return {16, 1, 0.25, 0.1, 1e-3, 2, nullptr}; }
};

/// Coefficients of the height over the tangent plane (eq. 5.2), in the frame of tangent_frame(n).
struct HeightPolynomial {
  double a00 = 0, a01 = 0, a10 = 0, a11 = 0, a02 = 0, a20 = 0;
  double normal_residual = 0;  // root mean square difference to the neighbours' normals
  double log_weight = 0;       // what the learned fit adds to that of the torus
};

/// Two unit vectors s, t with s x t = n.
void tangent_frame(const Vec3& n, Vec3& s, Vec3& t);

/// Weighted least squares over heights and normals of neighbours (rows of `points` and `normals`);
/// exact on planes and, where the neighbours lie on one, on spheres. `scale` [length] is the
/// distance of the farthest neighbour, > 0.
HeightPolynomial fit_heights(const TorusFit& fit, const OrientedPoints& cloud, int point,
                             std::span<const Neighbour> neighbours, double scale);

/// The torus with the point, normal and curvatures of the polynomial at its origin: first and
/// second fundamental form of eq. 5.2.
Torus torus_of(const HeightPolynomial& a, const Vec3& p, const Vec3& n, double rho,
               double curvature_limit);

/// One torus for each point. The points must be distinct, the normals unit.
std::vector<Torus> fit_tori(const OrientedPoints& cloud, const PointTree& tree, const TorusFit& fit,
                            const Task& task = {});

}  // namespace littoral
