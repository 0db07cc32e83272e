#include "sources/space/oriented_points.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "base/counted.h"
#include "base/stable_length.h"
#include "littoral/error.h"
#include "spatial/triangulate.h"

namespace littoral {

namespace {

constexpr double max_samples = 1 << 26;
constexpr std::size_t samples_between_checkpoints = 65536;

void check_faces(const PolygonSoup& soup) {
  if (soup.n_faces() == 0) throw InputError("the mesh has no faces", "empty-input");
  for (int f = 0; f < soup.n_faces(); ++f)
    for (int v : soup.face(f))
      if (!soup.points.row(v).allFinite())
        throw InputError("face " + std::to_string(f) + " has vertex " + std::to_string(v) +
                             ", whose coordinates are not finite",
                         "not-finite");
}

using Triangle = std::array<Vec3, 3>;

Triangle corners_of(const PolygonSoup& triangles, int f) {
  const auto v = triangles.face(f);
  return {triangles.points.row(v[0]), triangles.points.row(v[1]), triangles.points.row(v[2])};
}

/// Halves a triangle at its longest side until no side is longer than max_side.
template <class Visit>
void refine(const Triangle& whole, double max_side, const Visit& visit) {
  std::vector<Triangle> stack{whole};
  while (!stack.empty()) {
    const Triangle t = stack.back();
    stack.pop_back();
    int longest = 0;
    double length = 0;
    for (int k = 0; k < 3; ++k) {
      const double side = (t[(k + 1) % 3] - t[k]).norm();
      if (side > length) {
        length = side;
        longest = k;
      }
    }
    if (!(length > max_side)) {
      visit(t);
      continue;
    }
    const Vec3 &a = t[longest], &b = t[(longest + 1) % 3], &c = t[(longest + 2) % 3];
    const Vec3 middle = (a + b) / 2;
    stack.push_back({a, middle, c});
    stack.push_back({middle, b, c});
  }
}

void check_count(double samples) {
  if (samples > max_samples)
    throw InputError("more than " + std::to_string(static_cast<int>(max_samples)) +
                         " samples of the input are needed; lower option resolution",
                     "too-large");
}

/// Samples that triangles with an area need at least: one for every max_side of their length.
double least_samples(const PolygonSoup& triangles, double max_side) {
  double least = 0;
  for (int f = 0; f < triangles.n_faces(); ++f) {
    const Triangle t = corners_of(triangles, f);
    const Vec3 ab = t[1] - t[0], bc = t[2] - t[1], ca = t[0] - t[2];
    if (stable_length(ab.cross(bc)) > 0)
      least += std::max(1.0, std::max({ab.norm(), bc.norm(), ca.norm()}) / max_side);
  }
  return least;
}

}  // namespace

OrientedPoints sample_faces(const PolygonSoup& soup, double max_side, Report& report,
                            SamplesPerTriangle count, const Task& task) {
  check_faces(soup);
  const PolygonSoup triangles = triangulate(soup);
  check_count(least_samples(triangles, max_side));
  std::vector<Vec3> points, normals;
  std::vector<double> areas;
  int flat = 0;
  for (int f = 0; f < triangles.n_faces(); ++f) {
    const Triangle t = corners_of(triangles, f);
    const Vec3 twice = (t[1] - t[0]).cross(t[2] - t[0]);
    const double norm = stable_length(twice);
    if (!(norm > 0) || !std::isfinite(norm)) {
      ++flat;
      continue;
    }
    refine(t, max_side, [&](const Triangle& part) {
      if (points.size() % samples_between_checkpoints == 0) task.checkpoint();
      const Vec3 middle = (part[0] + part[1] + part[2]) / 3;
      const double area = (part[1] - part[0]).cross(part[2] - part[0]).stableNorm() / 2;
      if (!(area > 0)) return;  // of a needle, by rounding
      if (count == SamplesPerTriangle::one) {
        points.push_back(middle);
        normals.emplace_back(twice / norm);
        areas.push_back(area);
        return;
      }
      for (const Vec3& corner : part) {
        points.emplace_back((middle + corner) / 2);
        normals.emplace_back(twice / norm);
        areas.push_back(area / 3);
      }
    });
    check_count(static_cast<double>(points.size()));
  }
  if (points.empty()) throw InputError("no face of the mesh has any area", "empty-input");
  if (flat > 0)
    report.warn("degenerate-faces",
                counted(flat, "face without area was", "faces without area were") + " left out");
  OrientedPoints out;
  const Eigen::Index n = points.size();
  out.points.resize(n, 3);
  out.normals.resize(n, 3);
  for (Eigen::Index i = 0; i < n; ++i) {
    out.points.row(i) = points[i];
    out.normals.row(i) = normals[i];
  }
  out.areas = Eigen::Map<const VecX>(areas.data(), n);
  return out;
}

double sample_spacing(const OrientedPoints& samples) {
  // An equilateral triangle of side e has the area sqrt(3)/4 e^2.
  const double total = samples.areas.sum();
  const double root = samples.areas.cwiseProduct(samples.areas.cwiseSqrt()).sum() / total;
  return root / std::sqrt(std::sqrt(3.0) / 4);
}

}  // namespace littoral
