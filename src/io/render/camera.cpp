#include "io/render/camera.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "littoral/error.h"

namespace littoral::io {

namespace {

template <class Visit>
void for_each_point(const Scene& scene, const Visit& visit) {
  for (Eigen::Index i = 0; i < scene.triangles.size(); ++i) {
    visit(Vec3(scene.points.row(scene.triangles.data()[i])));
  }
  for (const SceneCurve& curve : scene.curves) {
    for (Eigen::Index i = 0; i < curve.points.rows(); ++i) visit(Vec3(curve.points.row(i)));
  }
  for (Eigen::Index i = 0; i < scene.source_points.rows(); ++i) {
    visit(Vec3(scene.source_points.row(i)));
  }
}

Vec3 direction(const Vec3& v, const char* name) {
  const double length = v.stableNorm();
  if (!(length > 0) || !std::isfinite(length)) {
    throw InputError(std::string("picture: ") + name + " must be a finite, nonzero direction",
                     "option-value");
  }
  return v / length;
}

}  // namespace

Camera fit_camera(const Scene& scene, const PictureOptions& options,
                  const Eigen::Vector4d& window) {
  const SceneFrame frame = scene_frame(scene);
  const Vec3 z =
      options.towards_eye ? direction(*options.towards_eye, "towards_eye") : frame.towards_eye;
  Vec3 wish = options.up ? direction(*options.up, "up") : frame.up;
  Vec3 x = wish.cross(z);
  if (x.norm() < 1e-6 && !options.up) {
    wish = std::abs(z[1]) > 0.9 ? Vec3(0, 0, -1) : Vec3(0, 1, 0);
    x = wish.cross(z);
  }
  if (x.norm() < 1e-6) throw InputError("picture: up is parallel to towards_eye", "option-value");
  x.normalize();

  Camera camera;
  camera.centre = frame.centre;
  camera.radius = frame.radius;
  camera.to_eye << x.transpose(), z.cross(x).transpose(), z.transpose();
  camera.cx = 0.5 * (window[0] + window[2]);
  camera.cy = 0.5 * (window[1] + window[3]);
  const double half_x = 0.5 * (window[2] - window[0]), half_y = 0.5 * (window[3] - window[1]);
  camera.focal = std::min(half_x, half_y) / std::tan(std::acos(-1.0) / 12);

  double left = 1, right = -1, bottom = 1, top = -1;
  for_each_point(scene, [&](const Vec3& p) {
    const Vec3 q = camera.to_eye * ((p - camera.centre) / camera.radius);
    left = std::min(left, q[0]);
    right = std::max(right, q[0]);
    bottom = std::min(bottom, q[1]);
    top = std::max(top, q[1]);
  });
  camera.x0 = 0.5 * (left + right);
  camera.y0 = 0.5 * (bottom + top);
  // Perspective shows the near side larger: centre what is seen, then fit, a few times over.
  for (int round = 0; round < 4; ++round) {
    camera.distance = 1.2;  // outside the unit sphere that holds everything
    for_each_point(scene, [&](const Vec3& p) {
      const Vec3 q = camera.to_eye * ((p - camera.centre) / camera.radius);
      const double across =
          std::max(std::abs(q[0] - camera.x0) / half_x, std::abs(q[1] - camera.y0) / half_y);
      camera.distance = std::max(camera.distance, q[2] + across * camera.focal);
    });
    if (round == 3) break;
    Eigen::Vector2d low = Eigen::Vector2d::Constant(1e9), high = -low;
    for_each_point(scene, [&](const Vec3& p) {
      const Eigen::Vector2d q = camera.project(p).head<2>();
      low = low.cwiseMin(q);
      high = high.cwiseMax(q);
    });
    const double unit = (camera.distance - 0.2) / camera.focal;
    camera.x0 += unit * (0.5 * (low[0] + high[0]) - camera.cx);
    camera.y0 -= unit * (0.5 * (low[1] + high[1]) - camera.cy);
  }
  return camera;
}

}  // namespace littoral::io
