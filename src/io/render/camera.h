#pragma once
// Where points in space fall in a picture.

#include "io/render/picture.h"
#include "io/render/scene_style.h"
#include "littoral/types.h"

namespace littoral::io {

/// A pinhole camera in front of everything it shows.
struct Camera {
  Vec3 centre;             // in space
  double radius = 1;       // unit of length of camera space
  Eigen::Matrix3d to_eye;  // rows: right, up, towards the eye
  double x0 = 0, y0 = 0;   // camera space point that falls on (cx, cy)
  double distance = 4;     // of the eye
  double focal = 1;        // samples
  double cx = 0, cy = 0;   // samples

  /// Horizontal and vertical position (samples, y down) and distance w > 0 along the line of sight.
  Vec3 project(const Vec3& p) const {
    const Vec3 q = to_eye * ((p - centre) / radius);
    const double w = distance - q[2];
    return {cx + focal * (q[0] - x0) / w, cy - focal * (q[1] - y0) / w, w};
  }
  /// The place in space that falls on (x, y) at distance w along the line of sight.
  Vec3 unproject(double x, double y, double w) const {
    const Vec3 q(x0 + w * (x - cx) / focal, y0 - w * (y - cy) / focal, distance - w);
    return centre + radius * (to_eye.transpose() * q);
  }
  Vec3 eye() const { return unproject(cx, cy, 0); }
};

/// A camera of 30 degrees opening that fits the scene into a rectangle (left, top, right, bottom,
/// in samples). Throws InputError for an unusable view direction.
Camera fit_camera(const Scene& scene, const PictureOptions& options, const Eigen::Vector4d& window);

}  // namespace littoral::io
