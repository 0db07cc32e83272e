#include "solve/optimization/gradient_energy.h"

#include <algorithm>
#include <cmath>

namespace littoral {

namespace {

constexpr int max_dim = 3;
using Small = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, max_dim, 1>;
using In = Eigen::Map<const Small>;
using Out = Eigen::Map<Small>;

/// argmin 1/2 (c |z|^2 + d (n.z)^2) - q.z over the unit ball; n a unit vector, c, d >= 0.
Small minimize_in_ball(double c, double d, const Small& n, const Small& q) {
  const double along = n.dot(q);
  const Small across = q - along * n;
  const double along2 = along * along, across2 = across.squaredNorm();
  // z = along / (c + d + mu) n + across / (c + mu) with mu >= 0 the multiplier of the ball.
  auto norm2 = [&](double mu) {
    const double x = c + d + mu, y = c + mu;
    return (along2 > 0 ? along2 / (x * x) : 0) + (across2 > 0 ? across2 / (y * y) : 0);
  };
  double mu = 0;
  if (!(norm2(0) <= 1)) {
    // Newton on 1 / |z| - 1, concave and increasing in mu: from the left it never overshoots.
    mu = std::max(0.0, q.norm() - c - d);
    for (int k = 0; k < 50; ++k) {
      const double x = c + d + mu, y = c + mu;
      const double s = norm2(mu), length = std::sqrt(s);
      if (!(length < 1e150)) {  // at a pole: step off it
        mu = std::max(2 * mu, 1e-8 * q.norm());
        continue;
      }
      const double slope =
          (along2 > 0 ? along2 / (x * x * x) : 0) + (across2 > 0 ? across2 / (y * y * y) : 0);
      const double step = (length - 1) * s / slope;
      mu = std::max(0.0, mu + step);
      if (std::abs(step) <= 1e-15 * (mu + c)) break;
    }
  }
  Small z = Small::Zero(q.size());
  if (along2 > 0) z += along / (c + d + mu) * n;
  if (across2 > 0) z += across / (c + mu);
  const double length = z.norm();
  return length > 1 ? Small(z / length) : z;
}

/// argmin a/2 |z|^2 + rho/2 |z - w|^2 over the unit ball, for every cell.
template <int dim>
void into_ball(Eigen::Index cells, double a, const double* rho, const double* w, double* z) {
  for (Eigen::Index c = 0; c < cells; ++c, w += dim, z += dim) {
    double length2 = 0;
    for (int d = 0; d < dim; ++d) length2 += w[d] * w[d];
    const double share = rho[c] / (a + rho[c]), length = share * std::sqrt(length2);
    const double shrink = share / std::max(1.0, length);
    for (int d = 0; d < dim; ++d) z[d] = shrink * w[d];
  }
}
void into_ball(Eigen::Index cells, int dim, double a, const double* rho, const double* w,
               double* z) {
  if (dim == 3) return into_ball<3>(cells, a, rho, w, z);
  if (dim == 2) return into_ball<2>(cells, a, rho, w, z);
  into_ball<1>(cells, a, rho, w, z);
}

}  // namespace

void GradientEnergy::prox_all(Eigen::Index first, Eigen::Index count, int dim, const double* rho,
                              const double* w, double* z) const {
  for (Eigen::Index k = 0; k < count; ++k) prox(first + k, rho[k], w + k * dim, z + k * dim);
}

BallQuadraticEnergy::BallQuadraticEnergy(int dim, double a, double b, VecX v)
    : dim_(dim), a_(a), b_(b), v_(std::move(v)) {}

void BallQuadraticEnergy::prox(Eigen::Index cell, double rho, const double* w, double* z) const {
  const double v2 = b_ > 0 ? v_.segment(cell * dim_, dim_).squaredNorm() : 0;
  if (v2 > 0) {
    const Small n = v_.segment(cell * dim_, dim_) / std::sqrt(v2);
    Out(z, dim_) = minimize_in_ball(a_ + rho, b_ * v2, n, Small(rho * In(w, dim_)));
    return;
  }
  into_ball(1, dim_, a_, &rho, w, z);
}

void BallQuadraticEnergy::prox_all(Eigen::Index first, Eigen::Index count, int dim,
                                   const double* rho, const double* w, double* z) const {
  if (b_ > 0) return GradientEnergy::prox_all(first, count, dim, rho, w, z);
  into_ball(count, dim, a_, rho, w, z);
}

double BallQuadraticEnergy::value(Eigen::Index cell, const double* z) const {
  const In in(z, dim_);
  double sum = a_ * in.squaredNorm();
  if (b_ > 0) {
    const double dot = v_.segment(cell * dim_, dim_).dot(in);
    sum += b_ * dot * dot;
  }
  return 0.5 * sum;
}

double BallQuadraticEnergy::conjugate(Eigen::Index cell, const double* y) const {
  const In in(y, dim_);
  const double v2 = b_ > 0 ? v_.segment(cell * dim_, dim_).squaredNorm() : 0;
  Small z;
  if (v2 > 0) {
    const Small n = v_.segment(cell * dim_, dim_) / std::sqrt(v2);
    z = minimize_in_ball(a_, b_ * v2, n, Small(in));
  } else {
    const double length = in.norm();
    if (length <= a_) return a_ > 0 ? 0.5 * length * length / a_ : 0;
    return length - 0.5 * a_;
  }
  return in.dot(z) - value(cell, z.data());
}

double BallQuadraticEnergy::gauge(Eigen::Index, const double* z) const {
  return In(z, dim_).norm();
}

BallMaxNormEnergy::BallMaxNormEnergy(double a, MatX3 frames) : a_(a), frames_(std::move(frames)) {}

/// argmin a |E z|_inf^2 + rho/2 |z|^2 - q.z over the unit ball: where one coordinate is largest it
/// is a quadratic; where two are, z lies on one of six lines. The least candidate is the answer.
Vec2 BallMaxNormEnergy::minimize(Eigen::Index cell, double rho, const Vec2& q) const {
  const Eigen::Matrix<double, 2, 3> E = frames_.middleRows<2>(2 * cell);
  double best = 0;
  Vec2 answer = Vec2::Zero();
  auto offer = [&](const Vec2& z) {
    const double largest = (E.transpose() * z).cwiseAbs().maxCoeff();
    const double f = a_ * largest * largest + 0.5 * rho * z.squaredNorm() - q.dot(z);
    if (f < best) best = f, answer = z;
  };
  for (int i = 0; i < 3; ++i) {
    const double length = E.col(i).norm();
    if (length > 0)
      offer(minimize_in_ball(rho, 2 * a_ * length * length, Small(E.col(i) / length), Small(q)));
    for (int j = 0; j < i; ++j)
      for (const double sign : {-1., 1.}) {
        const Vec2 normal = E.col(i) + sign * E.col(j);
        if (!(normal.norm() > 1e-12)) continue;
        const Vec2 d = Vec2(-normal.y(), normal.x()).normalized();
        const double largest = (E.transpose() * d).cwiseAbs().maxCoeff();
        const double curvature = 2 * a_ * largest * largest + rho;
        const double along = q.dot(d);
        offer((curvature > std::abs(along) ? along / curvature : std::copysign(1.0, along)) * d);
      }
  }
  return answer;
}

void BallMaxNormEnergy::prox(Eigen::Index cell, double rho, const double* w, double* z) const {
  Eigen::Map<Vec2> out(z);
  out = minimize(cell, rho, rho * Eigen::Map<const Vec2>(w));
}

double BallMaxNormEnergy::value(Eigen::Index cell, const double* z) const {
  const Vec3 x = frames_.middleRows<2>(2 * cell).transpose() * Eigen::Map<const Vec2>(z);
  const double largest = x.cwiseAbs().maxCoeff();
  return a_ * largest * largest;
}

double BallMaxNormEnergy::conjugate(Eigen::Index cell, const double* y) const {
  const Eigen::Map<const Vec2> in(y);
  const Vec2 z = minimize(cell, 0, in);
  return in.dot(z) - value(cell, z.data());
}

double BallMaxNormEnergy::gauge(Eigen::Index, const double* z) const {
  return Eigen::Map<const Vec2>(z).norm();
}

}  // namespace littoral
