#pragma once
// The two kinds of things a picture is made of, drawn into bands of sample rows.

#include <vector>

#include "io/render/camera.h"
#include "io/render/openness.h"
#include "io/render/scene.h"
#include "io/render/scene_style.h"
#include "littoral/types.h"

namespace littoral::io {

/// Rows [y0, y1) of samples: depth as 1/w (0: nothing there) and colour, 0..255.
struct Band {
  int width = 0, y0 = 0, y1 = 0;
  std::vector<double> nearness;
  std::vector<Eigen::Vector3f> colour;
  std::size_t at(int x, int y) const {
    return std::size_t(y - y0) * std::size_t(width) + std::size_t(x);
  }
};

/// How bright a surface looks at a place of the picture (samples): lit from the eye's upper left,
/// alike from both sides. The normal is unit, in the eye's frame.
float brightness(const Camera& camera, const Vec3& normal, double x, double y);

/// The surface with its field and isolines, prepared for drawing.
class SurfaceRaster {
 public:
  /// `scale`: samples along a pixel; `rows`: sample rows of a band (all but the last).
  /// `open`: of the vertices, or empty.
  SurfaceRaster(const Scene& scene, Openness open, const Camera& camera, const FieldStyle& style,
                double scale, int height, int rows);

  /// Draws band number b (rows b*rows ...) wherever the surface is nearer than what is there.
  void draw(int b, Band& band) const;

 private:
  void cover(int t, Band& band, std::vector<int>& owner) const;
  Eigen::Vector3f shade(int t, double x, double y) const;
  float opening(int t, const double* part, const Vec3& normal) const;
  double mean_slope(int t, const double* part, const Vec3& normal, double x, double y) const;
  double line_strength(double value, double slope, bool& zero) const;

  const Scene& scene_;
  Openness open_;
  const Camera& camera_;
  FieldStyle style_;
  std::vector<double> levels_;
  double scale_;
  MatX3 screen_;                                     // vertices x 3, see Camera::project
  MatX3 normals_;                                    // vertices x 3, either sign; zero: the face's
  Eigen::Matrix<double, Eigen::Dynamic, 6> slopes_;  // slope_tensors, per radius
  std::vector<int> band_offsets_, band_triangles_;
};

/// Source curves and points: thick strokes, arrow heads and discs of constant size in pixels.
class MarkRaster {
 public:
  MarkRaster(const Scene& scene, const Camera& camera, double scale);
  void draw(Band& band) const;

 private:
  struct Mark {
    Vec3 p[3];     // projected; a stroke uses two, an arrow head its tip and base corners
    bool head;     // an arrow head?
    double reach;  // half the thickness, samples
    Eigen::Vector3f colour;
  };
  void draw(const Mark& mark, double rim, bool core, Band& band) const;

  std::vector<Mark> marks_;
  double scale_;
};

/// Vertex normals of a triangle soup whose faces may disagree in orientation: each face counts with
/// the sign that agrees with the largest face at the vertex. Unit, or zero where there is no area
/// and on creases, where faces keep their own normals.
MatX3 unsigned_normals(const MatX3& points, const MatX3i& triangles, double length_scale);

/// Gradient in a triangle with sides u and v of what grows by p along u and by q along v; 0 where
/// there is no area or a value is not finite.
Vec3 gradient_in_triangle(const Vec3& u, const Vec3& v, double p, double q);

/// At each vertex the mean of g g^T over its triangles, by area, where g is the gradient of a field
/// that is linear on them: xx, yy, zz, xy, xz, yz. The slope across a line of the picture is then
/// the same on both sides of an edge, and opposite gradients do not cancel. Triangles without area
/// or with a value that is not finite count as 0.
Eigen::Matrix<double, Eigen::Dynamic, 6> slope_tensors(const MatX3& points, const MatX3i& triangles,
                                                       const VecX& values, double length_scale);

}  // namespace littoral::io
