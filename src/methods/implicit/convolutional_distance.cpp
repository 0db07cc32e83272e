#include "methods/implicit/convolutional_distance.h"

#include <cmath>

#include "spatial/point_blocks.h"
#include "spatial/point_tree.h"
#include "spatial/winding_number.h"

namespace littoral {

namespace {

using Lanes = PointBlocks::Lanes;
using Block = PointBlocks::Block;

constexpr double sample_reach = 32;  // in 1/lambda beyond the nearest sample: e^-32 is rounding

/// Sums of sixteen lanes at a time of a vector.
struct VectorSum {
  Lanes x = Lanes::Zero(), y = Lanes::Zero(), z = Lanes::Zero();
  Vec3 total() const { return {x.sum(), y.sum(), z.sum()}; }
};

/// What the three sums share: samples near a query, exponents shifted by the distance sigma to the
/// nearest one.
class KernelSum : public PointwiseDistance {
 public:
  KernelSum(const OrientedPoints& samples, double lambda)
      : lambda_(lambda),
        nearest_(samples.points),
        blocks_(samples.points, samples.normals, samples.areas) {}

 protected:
  /// Offsets d = x - p, their lengths, and e = A exp(-lambda (r - sigma)) of one block.
  struct Terms {
    Lanes dx, dy, dz, r, e, plane;  // plane: <x - p, n>
  };

  double sigma(const Vec3& x) const { return std::sqrt(nearest_.nearest(x).squared_distance); }

  template <class Visit>
  void visit(const Vec3& x, double sigma, const Visit& body) const {
    const Vec3 q = x - blocks_.origin();
    const double least = 1e-12 / lambda_;  // at a sample, where kernels may be singular
    blocks_.visit(x, sigma + sample_reach / lambda_, [&](const Block& b) {
      Terms t;
      t.dx = q[0] - b.x;
      t.dy = q[1] - b.y;
      t.dz = q[2] - b.z;
      t.r = (t.dx * t.dx + t.dy * t.dy + t.dz * t.dz).sqrt().max(least);
      t.e = b.area * (-lambda_ * (t.r - sigma)).exp();
      t.plane = t.dx * b.nx + t.dy * b.ny + t.dz * b.nz;
      body(b, t);
    });
  }

  double lambda_;
  PointTree nearest_;
  PointBlocks blocks_;
};

class HopfColeSum : public KernelSum {
 public:
  using KernelSum::KernelSum;
  DistanceSample at(const Vec3& x) const override {
    const double s = sigma(x);
    Lanes w = Lanes::Zero();
    VectorSum dw;
    visit(x, s, [&](const Block& b, const Terms& t) {
      // w = sum A (lambda r + 1) <d, n> / (2 pi r^3) e^(-lambda (r - sigma)); the factor 1 / (2 pi)
      // follows below.
      const Lanes k = t.e * (lambda_ * t.r + 1) / t.r.cube();
      w += k * t.plane;
      // d/dr of (lambda r + 1) r^-3 e^(-lambda r) = -(lambda^2 r^2 + 3 lambda r + 3) r^-4 e^...
      const Lanes slope =
          -t.e * (lambda_ * lambda_ * t.r * t.r + 3 * lambda_ * t.r + 3) / t.r.pow(5) * t.plane;
      dw.x += k * b.nx + slope * t.dx;
      dw.y += k * b.ny + slope * t.dy;
      dw.z += k * b.nz + slope * t.dz;
    });
    const double sum = w.sum();
    DistanceSample out;
    if (sum == 0 || !std::isfinite(sum)) return out;
    const double sign = sum > 0 ? 1 : -1;
    out.value = sign * (-std::log(std::abs(sum) / (2 * M_PI)) / lambda_ + s);
    out.gradient = -sign / (lambda_ * sum) * dw.total();
    return out;
  }
};

class PlanarSum : public KernelSum {
 public:
  using KernelSum::KernelSum;
  DistanceSample at(const Vec3& x) const override {
    const double s = sigma(x);
    Lanes N = Lanes::Zero(), D = Lanes::Zero();
    VectorSum dN, dD;
    visit(x, s, [&](const Block& b, const Terms& t) {
      N += t.e * t.plane;
      D += t.e;
      const Lanes slope = -lambda_ * t.e / t.r;
      dD.x += slope * t.dx;
      dD.y += slope * t.dy;
      dD.z += slope * t.dz;
      dN.x += t.e * b.nx + slope * t.plane * t.dx;
      dN.y += t.e * b.ny + slope * t.plane * t.dy;
      dN.z += t.e * b.nz + slope * t.plane * t.dz;
    });
    DistanceSample out;
    out.value = N.sum() / D.sum();
    out.gradient = (dN.total() - out.value * dD.total()) / D.sum();
    return out;
  }
};

class LogSumExpSum : public KernelSum {
 public:
  LogSumExpSum(const OrientedPoints& samples, double lambda)
      : KernelSum(samples, lambda),
        winding_(samples.points, samples.normals, samples.areas),
        mean_area_(samples.areas.mean()) {}
  DistanceSample at(const Vec3& x) const override {
    const double s = sigma(x);
    Lanes sum = Lanes::Zero();
    VectorSum slope;
    visit(x, s, [&](const Block&, const Terms& t) {
      sum += t.e;
      slope.x += t.e * t.dx / t.r;
      slope.y += t.e * t.dy / t.r;
      slope.z += t.e * t.dz / t.r;
    });
    const double sign = winding_(x) > 0.5 ? -1 : 1;
    DistanceSample out;
    out.value = sign * (s - std::log(sum.sum() / mean_area_) / lambda_);
    out.gradient = sign * slope.total() / sum.sum();
    return out;
  }

 private:
  WindingNumber winding_;
  double mean_area_;
};

}  // namespace

std::unique_ptr<const PointwiseDistance> hopf_cole_distance(const OrientedPoints& samples,
                                                            double lambda) {
  return std::make_unique<HopfColeSum>(samples, lambda);
}

std::unique_ptr<const PointwiseDistance> planar_distance(const OrientedPoints& samples,
                                                         double lambda) {
  return std::make_unique<PlanarSum>(samples, lambda);
}

std::unique_ptr<const PointwiseDistance> log_sum_exp_distance(const OrientedPoints& samples,
                                                              double lambda) {
  return std::make_unique<LogSumExpSum>(samples, lambda);
}

}  // namespace littoral
