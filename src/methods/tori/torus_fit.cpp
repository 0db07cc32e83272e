#include "methods/tori/torus_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <array>
#include <limits>

#include "base/parallel.h"

namespace littoral {

void tangent_frame(const Vec3& n, Vec3& s, Vec3& t) {
  s = n.cross(std::abs(n.x()) > 0.9 ? Vec3::UnitY() : Vec3::UnitX()).normalized();
  t = n.cross(s);
}

namespace {

/// A neighbour in the frame of a point, lengths in units of the fit's scale.
struct SeenNeighbor {
  double S, T, H;   // place along s, t and n
  double A, B;      // its normal along s and t
  double distance;  // distance, kept away from 0
  double height_weight, normal_weight;
};

/// What the network sees of a neighbour (python/train_torus_fit.py: fit).
Eigen::Matrix<float, LearnedFit::features, 1> features_of(const SeenNeighbor& j, const Vec3& d,
                                                          const Vec3& m, const Vec3& n) {
  const double rises = j.H / j.distance, seen = d.dot(m) / j.distance;
  const double inverse = 1 / std::sqrt(j.S * j.S + j.T * j.T + 1e-8);
  Eigen::Matrix<double, LearnedFit::features, 1> out;
  out << std::min(d.norm(), 4.0), rises, seen, m.dot(n), (j.A * j.S + j.B * j.T) * inverse,
      std::abs(j.A * j.T - j.B * j.S) * inverse, std::abs(rises), std::abs(seen);
  return out.cast<float>();
}

}  // namespace

HeightPolynomial fit_heights(const TorusFit& fit, const OrientedPoints& cloud, int point,
                             std::span<const Neighbour> neighbours, double scale) {
  using Vec6 = Eigen::Matrix<double, 6, 1>;
  using Mat6 = Eigen::Matrix<double, 6, 6>;
  const Vec3 p = cloud.points.row(point), n = cloud.normals.row(point);
  Vec3 s, t;
  tangent_frame(n, s, t);
  constexpr std::size_t most = 64;
  std::array<SeenNeighbor, most> rows;
  const std::size_t count = std::min(neighbours.size(), most);
  const bool learned = fit.learned && count == LearnedFit::neighbours;
  LearnedFit::Features features;
  for (std::size_t j = 0; j < count; ++j) {
    const Vec3 d = (cloud.points.row(neighbours[j].point).transpose() - p) / scale;
    const Vec3 m = cloud.normals.row(neighbours[j].point);
    const double distance = std::max(d.norm(), 0.05);
    const double weight = fit.weight_exponent == 2   ? 1 / (distance * distance)
                          : fit.weight_exponent == 1 ? 1 / distance
                                                     : std::pow(distance, -fit.weight_exponent);
    rows[j] = {d.dot(s), d.dot(t), d.dot(n), m.dot(s), m.dot(t), distance, weight, 0};
    rows[j].normal_weight = weight * fit.normal_weight;
    if (learned) features.col(j) = features_of(rows[j], d, m, n);
  }
  double self_weight = fit.self_weight, log_weight = 0;
  if (learned) {
    const LearnedFit::Factors factors = (*fit.learned)(features);
    for (std::size_t j = 0; j < count; ++j) {
      const Eigen::Index column = j;
      // Those that the closed form does not look at begin with little weight.
      const double base = static_cast<int>(j) < fit.neighbours ? 0 : -4;
      rows[j].height_weight *= std::exp(base + factors.of_neighbours(0, column));
      rows[j].normal_weight *= std::exp(base + factors.of_neighbours(1, column));
    }
    self_weight *= std::exp(factors.of_point);
    log_weight = factors.of_torus;
  }
  Mat6 M = Mat6::Zero();  // normal equations; unknowns a00, a01, a10, a11, a02, a20
  Vec6 r = Vec6::Zero();
  auto add = [&](const Vec6& g, double value, double weight) {
    const Vec6 weighted = weight * g;
    M.noalias() += weighted * g.transpose();
    r += value * weighted;
  };
  for (const SeenNeighbor& j : std::span(rows).first(count)) {
    // Height over the plane, shortened so that points of a sphere lie exactly on a paraboloid with
    // its curvature: on it |d|^2 = -2 R H.
    const double S = j.S, T = j.T, flat = S * S + T * T;
    const double height = flat > 0 ? j.H * flat / (flat + j.H * j.H) : 0.0;
    add((Vec6() << 1, T, S, S * T, T * T, S * S).finished(), height, j.height_weight);
    // Normals: the derivatives of the height are minus the normal's tangential components
    // (Weingarten's form: no division by the third, which may be small).
    add((Vec6() << 0, 0, 1, T, 0, 2 * S).finished(), -j.A, j.normal_weight);
    add((Vec6() << 0, 1, 0, S, 2 * T, 0).finished(), -j.B, j.normal_weight);
  }
  M(0, 0) += self_weight;
  M.diagonal().tail<3>().array() += fit.ridge;
  M.diagonal().array() += 1e-9;
  const Vec6 a = M.ldlt().solve(r);
  HeightPolynomial out;
  if (!a.allFinite()) return out;
  double residual = 0, total = 0;
  for (const SeenNeighbor& j : std::span(rows).first(count)) {
    const double da = a[2] + a[3] * j.T + 2 * a[5] * j.S + j.A;
    const double db = a[1] + a[3] * j.S + 2 * a[4] * j.T + j.B;
    residual += j.normal_weight * (da * da + db * db);
    total += j.normal_weight;
  }
  out = {a[0] * scale, a[1], a[2], a[3] / scale, a[4] / scale, a[5] / scale, 0, log_weight};
  out.normal_residual = total > 0 ? std::sqrt(residual / total) : 0;
  return out;
}

Torus torus_of(const HeightPolynomial& a, const Vec3& p, const Vec3& n, double rho,
               double curvature_limit) {
  Vec3 s, t;
  tangent_frame(n, s, t);
  Torus torus;
  torus.rho = rho;
  torus.q = p + a.a00 * n;
  // Tangents Q_s = s + a10 n, Q_t = t + a01 n at the origin, and the normal across them.
  const double length = std::sqrt(1 + a.a10 * a.a10 + a.a01 * a.a01);
  torus.n = (n - a.a10 * s - a.a01 * t) / length;
  const Vec3 Qs = s + a.a10 * n, Qt = t + a.a01 * n;
  const Vec3 f1 = Qs.normalized(), f2 = torus.n.cross(f1);
  // Shape operator in the orthonormal frame f1, f2: J^-T II J^-1 with [Qs Qt] = [f1 f2] J.
  Eigen::Matrix2d J, II;
  J << f1.dot(Qs), f1.dot(Qt), f2.dot(Qs), f2.dot(Qt);
  II << 2 * a.a20, a.a11, a.a11, 2 * a.a02;
  const Eigen::Matrix2d inverse = J.inverse();
  const Eigen::Matrix2d W = inverse.transpose() * (II / length) * inverse;
  const double mean = 0.5 * (W(0, 0) + W(1, 1)), half = 0.5 * (W(0, 0) - W(1, 1));
  const double off = 0.5 * (W(0, 1) + W(1, 0)), radius = std::hypot(half, off);
  const double angle = 0.5 * std::atan2(off, half);
  const Vec3 larger = std::cos(angle) * f1 + std::sin(angle) * f2;  // direction of mean + radius
  torus.k1 = mean + radius;
  torus.k2 = mean - radius;
  torus.e1 = larger;
  if (std::abs(torus.k1) > std::abs(torus.k2)) {
    std::swap(torus.k1, torus.k2);
    torus.e1 = torus.n.cross(larger);
  }
  const double limit = curvature_limit / rho;
  torus.k1 = std::clamp(torus.k1, -limit, limit);
  torus.k2 = std::clamp(torus.k2, -limit, limit);
  torus.log_weight =
      std::clamp(-20 * std::abs(a.a00) / rho - 4 * a.normal_residual + a.log_weight, -10.0, 0.0);
  return torus;
}

std::vector<Torus> fit_tori(const OrientedPoints& cloud, const PointTree& tree, const TorusFit& fit,
                            const Task& task) {
  constexpr int spacing_neighbour = 6;  // rho is the distance of this one
  const std::size_t n = cloud.size();
  std::vector<Torus> tori(n);
  const int seen = fit.learned ? LearnedFit::neighbours : fit.neighbours;
  const int wanted = std::max(seen, spacing_neighbour) + 1;
  const std::vector<int> order = tree.order();  // what is near is fitted soon after
  parallel_for(n, 256, [&](std::size_t begin, std::size_t end) {
    task.checkpoint();
    std::vector<Neighbour> found(wanted);
    for (std::size_t place = begin; place < end; ++place) {
      const int point = order[place];
      const std::size_t i = point;
      const Vec3 p = cloud.points.row(point), normal = cloud.normals.row(point);
      // The first neighbour is the point itself, as points are distinct.
      const int others = tree.nearest(p, wanted, found.data()) - 1;
      if (others <= 0) {  // a single point: its plane, trusted everywhere
        tori[i] = torus_of({}, p, normal, std::numeric_limits<double>::max(), 0);
        continue;
      }
      const int unit = std::min(others, fit.neighbours);  // lengths are in units of its distance
      const std::size_t used = others >= seen ? seen : unit;
      const double scale = std::sqrt(found[unit].squared_distance);
      const double rho = std::sqrt(found[std::min(others, spacing_neighbour)].squared_distance);
      const HeightPolynomial a =
          fit_heights(fit, cloud, point, std::span(found).subspan(1, used), scale);
      tori[i] = torus_of(a, p, normal, rho, fit.curvature_limit);
    }
  });
  return tori;
}

}  // namespace littoral
