#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/dense_decompositions.h"
#include "io/render/scene_style.h"
#include "littoral/error.h"

namespace littoral::io {

namespace {

// Sums over the triangles: second moments of the corners, weighted by area so that the sampling of
// the surface does not matter, in units of the frame's radius. Without triangles, over the points.
Eigen::Matrix3d moments(const Scene& scene, const SceneFrame& frame) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  Vec3 first = Vec3::Zero();
  double weight = 0;
  for (Eigen::Index t = 0; t < scene.triangles.rows(); ++t) {
    Vec3 p[3];
    for (int k = 0; k < 3; ++k) {
      p[k] = (Vec3(scene.points.row(scene.triangles(t, k))) - frame.centre) / frame.radius;
    }
    const double area = 0.5 * (p[1] - p[0]).cross(p[2] - p[0]).norm();
    for (const Vec3& q : p) {
      sum += area / 3 * q * q.transpose();
      first += area / 3 * q;
    }
    weight += area;
  }
  if (!(weight > 0)) {
    for (const auto& point : scene.source_points.rowwise()) {
      const Vec3 q = (Vec3(point) - frame.centre) / frame.radius;
      sum += q * q.transpose();
      first += q;
    }
    weight = static_cast<double>(scene.source_points.rows());
  }
  if (!(weight > 0)) return Eigen::Matrix3d::Identity();
  return sum / weight - first * first.transpose() / (weight * weight);
}

Vec3 front_view(const Eigen::Matrix3d& second) {
  // Horizontal principal axis of least extent: looking along it shows the most.
  const double mean = (second(0, 0) + second(2, 2)) / 2, off = (second(0, 2) + second(2, 0)) / 2;
  const double half = (second(0, 0) - second(2, 2)) / 2, apart = std::hypot(half, off);
  const double narrow = std::sqrt(std::max(0.0, mean - apart));
  const double wide = std::sqrt(std::max(0.0, mean + apart));
  const double widest = std::atan2(off, half) / 2;  // angle from x
  Vec3 front(0, 0, 1);
  if (narrow < 0.8 * wide) front = Vec3(-std::sin(widest), 0, std::cos(widest));
  if (front[2] < -0.3 || (front[2] < 0.3 && front[0] < 0)) front = -front;
  const double height = std::sqrt(std::max(0.0, second(1, 1)));
  const double degree = std::acos(-1.0) / 180;
  const double turn = 30 * degree;
  // The flatter the shape lies, the more from above.
  const double lying = std::clamp(1 - height / std::max(narrow, 1e-12), 0.0, 1.0);
  const double lift = (20 + 30 * lying) * degree;
  const Vec3 side(front[2], 0, -front[0]);
  const Vec3 horizontal = std::cos(turn) * front + std::sin(turn) * side;
  return std::cos(lift) * horizontal + std::sin(lift) * Vec3(0, 1, 0);
}

Vec3 unit_direction(const Vec3& v, const std::string& name) {
  const double length = v.stableNorm();
  if (!(length > 0) || !std::isfinite(length))
    throw InputError("option " + name + ": a direction must be finite and not zero",
                     "option-value");
  return v / length;
}

}  // namespace

Vec3 upright_axis(const Vec3& low, const Vec3& high) {
  const double small = 0.01 * (high - low).maxCoeff();
  auto stands_on = [&](int axis) { return std::abs(low[axis]) <= small; };
  return stands_on(2) && !stands_on(1) && high[2] - low[2] > 10 * small ? Vec3::UnitZ()
                                                                        : Vec3::UnitY();
}

SceneFrame scene_frame(const Scene& scene) {
  SceneFrame frame;
  const double big = std::numeric_limits<double>::max();
  Vec3 low = Vec3::Constant(big), high = -low;
  const auto include = [&](const Vec3& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  };
  for (Eigen::Index i = 0; i < scene.triangles.size(); ++i) {
    include(scene.points.row(scene.triangles.data()[i]));
  }
  for (const SceneCurve& curve : scene.curves) {
    for (Eigen::Index i = 0; i < curve.points.rows(); ++i) include(curve.points.row(i));
  }
  for (Eigen::Index i = 0; i < scene.source_points.rows(); ++i) include(scene.source_points.row(i));
  frame.centre = 0.5 * low + 0.5 * high;
  frame.radius = std::max((0.5 * high - 0.5 * low).stableNorm(), 1e-290);

  Eigen::Matrix3d upright = Eigen::Matrix3d::Identity();  // rows: right, up, to the front
  if (upright_axis(low, high)[2] > 0) upright << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  const Eigen::Matrix3d second = moments(scene, frame);
  const Eigenvectors3 axes = symmetric_eigenvectors(second);
  Vec3 view;
  if (scene.volume) {
    view = Vec3::Constant(0.45);                            // onto the slice
    if (scene.up && (*scene.up)[2] > 0.9) view[1] = -0.45;  // the front is at low y
    view[scene.volume->axis] = 1;
  } else if (axes.values[0] < 1e-6 * axes.values[2]) {
    view = axes.vectors.col(0);
    Eigen::Index largest;
    view.cwiseAbs().maxCoeff(&largest);
    if (view[largest] < 0) view = -view;
  } else {
    view = upright.transpose() * front_view(upright * second * upright.transpose());
  }
  if (scene.up && !scene.towards_eye) {  // the front above, about the axis that is up
    const Vec3 axis = unit_direction(*scene.up, "up");
    const Vec3 other = std::abs(axis[0]) < 0.9 ? Vec3::UnitX() : Vec3::UnitY();
    const Vec3 side = (other - other.dot(axis) * axis).normalized();
    upright.row(1) = axis;
    upright.row(0) = side;
    upright.row(2) = side.cross(axis);
    if (!scene.volume)
      view = upright.transpose() * front_view(upright * second * upright.transpose());
  }
  if (scene.towards_eye) view = unit_direction(*scene.towards_eye, "view");
  frame.towards_eye = view.normalized();
  Vec3 up = scene.up ? unit_direction(*scene.up, "up") : Vec3(upright.row(1));
  if (std::abs(frame.towards_eye.dot(up)) > (scene.up ? 1 - 1e-9 : 0.99)) {
    if (scene.up)
      throw InputError("option up is parallel to the direction of the view", "option-value");
    up = -upright.row(2);
  }
  frame.up = (up - up.dot(frame.towards_eye) * frame.towards_eye).normalized();
  return frame;
}

}  // namespace littoral::io
