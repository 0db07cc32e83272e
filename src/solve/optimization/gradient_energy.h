#pragma once
// Convex functions of one small vector per cell, through what splitting methods ask of them; and
// those of vectors in the unit ball, which keep |grad u| <= 1 with or without a regularizer.

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
  /// The same for `count` cells from `first` on, whose numbers begin at the given places.
  virtual void prox_all(Eigen::Index first, Eigen::Index count, int dim, const double* rho,
                        const double* w, double* z) const;
  /// phi(z); z is in the set.
  virtual double value(Eigen::Index cell, const double* z) const = 0;
  /// sup_z y.z - phi(z).
  virtual double conjugate(Eigen::Index cell, const double* y) const = 0;
  /// Least t >= 0 with z / t in the set: more than 1 outside it.
  virtual double gauge(Eigen::Index cell, const double* z) const = 0;
};

/// phi = 1/2 z^T (a I + b v v^T) z in the unit ball, v a vector per cell. a = b = 0 is the ball
/// alone.
class BallQuadraticEnergy : public GradientEnergy {
 public:
  /// v: dim cells, or empty where b = 0.
  BallQuadraticEnergy(int dim, double a, double b, VecX v);
  void prox(Eigen::Index cell, double rho, const double* w, double* z) const override;
  void prox_all(Eigen::Index first, Eigen::Index count, int dim, const double* rho, const double* w,
                double* z) const override;
  double value(Eigen::Index cell, const double* z) const override;
  double conjugate(Eigen::Index cell, const double* y) const override;
  double gauge(Eigen::Index cell, const double* z) const override;

 private:
  int dim_;
  double a_, b_;
  VecX v_;
};

/// phi = a |E z|_inf^2 in the unit ball: E holds the two axes of each cell's frame in space (eq.
/// S9).
class BallMaxNormEnergy : public GradientEnergy {
 public:
  /// frames: 2 cells x 3, orthonormal pairs of rows.
  BallMaxNormEnergy(double a, MatX3 frames);
  void prox(Eigen::Index cell, double rho, const double* w, double* z) const override;
  double value(Eigen::Index cell, const double* z) const override;
  double conjugate(Eigen::Index cell, const double* y) const override;
  double gauge(Eigen::Index cell, const double* z) const override;

 private:
  Vec2 minimize(Eigen::Index cell, double rho, const Vec2& q) const;
  double a_;
  MatX3 frames_;
};

}  // namespace littoral
