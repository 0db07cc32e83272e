#pragma once
// Tori from the neighbourhoods of oriented points (thesis, section 5.1.1).

#include <memory>
#include <span>
#include <vector>

#include "base/task.h"
#include "methods/tori/learned_fit.h"
#include "methods/tori/torus.h"
#include "sources/oriented_points.h"
#include "spatial/point_tree.h"

namespace littoral {

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
