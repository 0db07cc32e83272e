#pragma once
// A surface drawn ray by ray into the bands of a picture.

#include <optional>

#include "io/render/camera.h"
#include "io/render/openness.h"
#include "io/render/raster.h"
#include "io/render/scene.h"
#include "spatial/triangle_bvh.h"

namespace littoral::io {

/// Draws scene.trace: one ray a pixel, and one a sample where neighbouring pixels differ.
class TraceRaster {
 public:
  /// `open`: of the scene's vertices, or empty; `samples` along a pixel's side.
  TraceRaster(const Scene& scene, Openness open, const Camera& camera, const FieldStyle& style,
              int samples);

  /// Draws wherever the surface is nearer than what is there. Nothing without scene.trace.
  void draw(Band& band) const;

 private:
  struct Seen {
    double nearness = 0;  // 0: nothing
    Vec3 normal;          // in the eye's frame
    float lit = 1;        // what comes through to it from everywhere
  };
  Seen look(double x, double y) const;
  void put(const Seen& seen, int x, int y, Band& band) const;

  const SceneTrace* trace_;
  std::optional<TriangleBvh> near_;  // where it is known how open the surface is
  Openness open_;
  const Camera& camera_;
  int samples_;
  Eigen::Vector3f colour_;
};

}  // namespace littoral::io
