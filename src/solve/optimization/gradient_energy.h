#pragma once
// Convex functions of one small vector per cell, through what splitting methods ask of them.

#include <memory>

#include "littoral/types.h"

namespace littoral {

/// A convex phi(cell, z), z of `dim` numbers, infinite outside a bounded convex set around 0. A new
/// regularizer of gradients is one small class.
class GradientEnergy {
 public:
  virtual ~GradientEnergy() = default;
  /// z := argmin phi(z) + rho/2 |z - w|^2.
  virtual void prox(Eigen::Index cell, double rho, const double* w, double* z) const = 0;
  /// phi(z); z is in the set.
  virtual double value(Eigen::Index cell, const double* z) const = 0;
  /// sup_z y.z - phi(z).
  virtual double conjugate(Eigen::Index cell, const double* y) const = 0;
  /// Least t >= 0 with z / t in the set: more than 1 outside it.
  virtual double gauge(Eigen::Index cell, const double* z) const = 0;
};

}  // namespace littoral
