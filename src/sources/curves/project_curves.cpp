#include "sources/curves/project_curves.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/option_table.h"
#include "littoral/error.h"

namespace littoral {

namespace {

constexpr double most_samples = 2e6;
constexpr double corner_snap = 1e-9;

MatX3i triangles(const SurfaceMesh& mesh) {
  MatX3i faces(mesh.n_faces(), 3);
  for (int f = 0; f < mesh.n_faces(); ++f)
    for (int k = 0; k < 3; ++k) faces(f, k) = mesh.face(f)[k];
  return faces;
}

std::string label(const SpaceCurve& curve) {
  return curve.origin.empty() ? "a space curve" : "the space curve at " + curve.origin;
}

/// The curve's nodes with points added so that no step exceeds `step` (any step if 0).
std::vector<Vec3> resample(const SpaceCurve& curve, double step) {
  const Eigen::Index n = curve.points.rows();
  auto node = [&](Eigen::Index i) { return Vec3(curve.points.row(i)); };
  auto pieces = [&](Eigen::Index i) {
    const double length = (node(i + 1) - node(i)).stableNorm();
    return step > 0 ? std::max(1.0, std::ceil(length / step)) : 1.0;
  };
  double total = 1;
  for (Eigen::Index i = 0; i + 1 < n; ++i) total += pieces(i);
  if (!(total <= most_samples))
    throw InputError(label(curve) + " is " + rounded_text(total * step, 3) +
                         " long, more than a million mean edge lengths (" +
                         rounded_text(2 * step, 3) +
                         ") of the mesh: check that both use the same unit",
                     "too-large");
  std::vector<Vec3> samples{node(0)};
  samples.reserve(total);
  for (Eigen::Index i = 0; i + 1 < n; ++i) {
    const int count = static_cast<int>(pieces(i));
    for (int k = 1; k < count; ++k) {
      const double t = static_cast<double>(k) / count;
      samples.emplace_back((1 - t) * node(i) + t * node(i + 1));
    }
    samples.push_back(node(i + 1));
  }
  return samples;
}

SurfacePoint snapped(const SurfaceMesh& mesh, const NearestPoint& hit) {
  std::array<double, 3> b = hit.barycentric;
  double sum = 0;
  for (double& x : b) {
    if (x < corner_snap) x = 0;
    sum += x;
  }
  return simplest(mesh, SurfacePoint::in_face(hit.face, b[0] / sum, b[1] / sum, b[2] / sum));
}

bool same(const SurfacePoint& p, const SurfacePoint& q) {
  return p.on == q.on && p.element == q.element && p.b == q.b;
}

}  // namespace

CurveProjector::CurveProjector(const SurfaceMesh& mesh)
    : mesh_(mesh), tracer_(mesh), bvh_(mesh.points(), triangles(mesh)) {
  Vec3 low = mesh.point(mesh.face(0)[0]), high = low;
  for (int v : mesh.soup().corners) {
    low = low.cwiseMin(mesh.point(v));
    high = high.cwiseMax(mesh.point(v));
  }
  diagonal_ = (high - low).stableNorm();
  for (int e = 0; e < mesh.n_edges(); ++e)
    mean_edge_ += (mesh.point(mesh.edges()(e, 1)) - mesh.point(mesh.edges()(e, 0))).stableNorm() /
                  mesh.n_edges();
}

ProjectedCurve CurveProjector::project(const SpaceCurve& curve, Report& report,
                                       const Task& task) const {
  if (curve.points.rows() == 0) throw InputError(label(curve) + " has no points", "empty-input");
  for (Eigen::Index i = 0; i < curve.points.rows(); ++i)
    if (!curve.points.row(i).allFinite())
      throw InputError("node " + std::to_string(i + 1) + " of " + label(curve) + " is not finite",
                       "not-finite");

  const std::vector<Vec3> samples = resample(curve, 0.5 * mean_edge_);
  ProjectedCurve projected;
  projected.n_samples = samples.size();
  auto start = [&](const SurfacePoint& p) {
    projected.curves.push_back({{p}, curve.is_signed, curve.origin});
  };
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (i % 64 == 0) task.checkpoint(static_cast<double>(i) / static_cast<double>(samples.size()));
    const NearestPoint hit = bvh_.closest_point(samples[i]);
    projected.largest_move = std::max(projected.largest_move, hit.distance);
    const SurfacePoint p = snapped(mesh_, hit);
    if (projected.curves.empty()) {
      start(p);
      continue;
    }
    std::vector<SurfacePoint>& nodes = projected.curves.back().nodes;
    if (same(nodes.back(), p)) continue;
    if (tracer_.component(nodes.back()) != tracer_.component(p)) {
      start(p);
      continue;
    }
    const std::vector<SurfacePoint> way = tracer_.trace(nodes.back(), p, task);
    nodes.insert(nodes.end(), way.begin() + 1, way.end());
  }

  if (projected.largest_move > 0.05 * diagonal_)
    report.warn("source-moved", label(curve) + " was moved by up to " +
                                    rounded_text(projected.largest_move, 3) + " (" +
                                    rounded_text(100 * projected.largest_move / diagonal_, 3) +
                                    " % of the bounding box diagonal) to lie on the surface");
  if (projected.curves.size() > 1)
    report.warn("curve-split",
                label(curve) + " was split into " + std::to_string(projected.curves.size()) +
                    " curves where its closest points jump between components of the mesh");
  return projected;
}

}  // namespace littoral
