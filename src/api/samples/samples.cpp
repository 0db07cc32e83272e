#include "littoral/samples.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <utility>

#include "api/front/running.h"
#include "api/samples/triangle_choice.h"
#include "api/space/input_queries.h"
#include "api/space/isosurfaces.h"
#include "api/space/sdf.h"
#include "base/index.h"
#include "base/option_table.h"
#include "base/parallel.h"
#include "base/random_numbers.h"
#include "base/stopwatch.h"
#include "littoral/error.h"

namespace littoral {

namespace {

enum Stream : std::uint32_t { on_surface = 0, in_space = 1 };

void check(const SampleOptions& options) {
  const auto is_share = [](double x) { return x >= 0 && x <= 1; };
  if (options.resolution < 8 || options.resolution > 2048)
    throw InputError(
        "option resolution must be 8 to 2048, not " + std::to_string(options.resolution),
        "option-value");
  if (options.surface < 0 || options.space < 0)
    throw InputError("options surface and space are numbers of samples and not negative, found " +
                         std::to_string(std::min(options.surface, options.space)),
                     "option-value");
  if (!is_share(options.sharp) || !is_share(options.uniform) || !is_share(options.curvature) ||
      options.uniform + options.curvature > 1)
    throw InputError(
        "options sharp, uniform and curvature are shares of samples, 0 to 1 each, and at most 1 "
        "for uniform and curvature together; found " +
            number_text(options.sharp) + ", " + number_text(options.uniform) + " and " +
            number_text(options.curvature),
        "option-value");
  if (!(options.margin >= 0 && options.margin <= 10))
    throw InputError("option margin must be 0 to 10, not " + number_text(options.margin),
                     "option-value");
  if (options.scales.empty())
    throw InputError("option scales names no scale; it takes one or several, over 0 to 10",
                     "option-value");
  for (const double scale : options.scales)
    if (!(scale > 0 && scale <= 10))
      throw InputError("option scales: " + number_text(scale) + " is not over 0 and at most 10",
                       "option-value");
}

/// As it will be stored.
double rounded(double x, SampleNumbers numbers) {
  switch (numbers) {
    case SampleNumbers::float16:
      return static_cast<double>(static_cast<Eigen::half>(static_cast<float>(x)));
    case SampleNumbers::float32:
      return static_cast<float>(x);
    case SampleNumbers::float64:
      break;
  }
  return x;
}

MatX3 rounded(const MatX3& points, SampleNumbers numbers) {
  return points.unaryExpr([&](double x) { return rounded(x, numbers); });
}

/// The first points of a share of n are of one kind, the rest of others; by index alone.
int share_of(double share, int n) { return static_cast<int>(std::floor(share * n + 0.5)); }

/// Points moved along the gradient to where the distance is 0, and its gradient there. Where there
/// is none, the normals that they had stay.
void move_to_surface(const PointwiseDistance& distance, MatX3& points, MatX3& normals,
                     const Task& task) {
  MatX3 gradients;
  const VecX values = evaluate(distance, points, &gradients, task);
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const Vec3 gradient = gradients.row(i);
    const double length = gradient.norm();
    if (!(length > 0.5) || !std::isfinite(values[i])) continue;
    points.row(i) -= values[i] * gradient / (length * length);
    // On the surface itself its direction is rounding.
    if (std::abs(values[i]) > 1e-9) normals.row(i) = gradient / length;
  }
}

/// A closed surface of a distance on a grid of the cube.
PolygonSoup zero_surface(const PointwiseDistance& distance, int resolution, Task& task,
                         Report& report) {
  Volume volume;
  volume.grid.n = {resolution, resolution, resolution};
  volume.grid.origin.setConstant(-1);
  volume.grid.spacing.setConstant(2.0 / (resolution - 1));
  check_grid(volume.grid);
  volume.values = evaluate(distance, volume.grid, task.stage(0.45, "distance"));
  if (!(volume.values.minCoeff() < 0))
    throw InputError(
        "the input encloses no node of the grid: it has no inside, or one too thin for this "
        "option resolution",
        "no-inside");
  return isosurfaces(volume, {0.0}, true, report, task.stage(0.05, "surface")).front().surface;
}

/// How far the surface is from the zero set, whether it is closed, and what it encloses.
void report_quality(const PolygonSoup& surface, const VecX& at_vertices, Report& report) {
  std::map<std::pair<int, int>, int> edges;
  double volume = 0, area = 0;
  for (int f = 0; f < surface.n_faces(); ++f) {
    const auto face = surface.face(f);
    const Vec3 a = surface.points.row(face[0]), b = surface.points.row(face[1]),
               c = surface.points.row(face[2]);
    volume += a.dot(b.cross(c)) / 6;
    area += (b - a).cross(c - a).norm() / 2;
    for (std::size_t k = 0; k < 3; ++k) {
      const int i = face[k], j = face[(k + 1) % 3];
      edges[{std::min(i, j), std::max(i, j)}] += i < j ? 1 : -1;
    }
  }
  const auto open =
      std::count_if(edges.begin(), edges.end(), [](const auto& edge) { return edge.second != 0; });
  report.sizes.emplace_back("surface vertices", surface.n_vertices());
  report.sizes.emplace_back("surface faces", surface.n_faces());
  report.sizes.emplace_back("surface open edges", static_cast<double>(open));
  report.sizes.emplace_back("surface area", area);
  report.sizes.emplace_back("surface volume", volume);
  report.residuals.emplace_back("largest distance of surface vertices",
                                at_vertices.cwiseAbs().maxCoeff());
  report.residuals.emplace_back("mean distance of surface vertices", at_vertices.cwiseAbs().mean());
}

double share_where(const VecX& values, double below) {
  if (values.size() == 0) return 0;
  return static_cast<double>((values.array() < below).count()) / static_cast<double>(values.size());
}

/// Makes the samples of one input in its cube.
class Sampler {
 public:
  Sampler(const PointwiseDistance& distance, const WindingOfInput& winding, Samples& out)
      : distance_(distance), winding_(winding), out_(out), options_(out.options) {}

  void run(Task& task) {
    const VecX at_vertices =
        evaluate(distance_, out_.surface.points, nullptr, task.stage(0.1, "surface"));
    report_quality(out_.surface, at_vertices, out_.report);
    by_area_ = TriangleChoice::by_area(out_.surface);
    by_turn_ = TriangleChoice::by_turn(out_.surface);
    sample_surface(task.stage(0.3, "points on the surface"));
    sample_space(task.stage(0.6, "points in space"));
    out_.report.residuals.emplace_back("share of uncertain samples",
                                       share_where(out_.confidence, 0.5));
    out_.report.residuals.emplace_back(
        "share of uniform samples inside",
        share_where(out_.distances.head(share_of(options_.uniform, options_.space)), 0));
  }

 private:
  void sample_surface(Task task) {
    const int n = options_.surface, sharp = share_of(options_.sharp, n);
    MatX3 points(n, 3);
    out_.surface_normals.resize(n, 3);
    out_.surface_kinds.resize(std::size_t(n));
    parallel_for(std::size_t(n), 1024, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        RandomNumbers random(options_.seed, on_surface, i);
        const auto row = index(i);
        const bool is_sharp = row < sharp;
        const PointOnTriangle at = (is_sharp ? by_turn_ : by_area_).choose(random);
        points.row(row) = at.point;
        out_.surface_normals.row(row) = at.normal;
        out_.surface_kinds[i] = is_sharp ? SampleKind::sharp : SampleKind::uniform;
      }
    });
    if (n > 0) move_to_surface(distance_, points, out_.surface_normals, task);
    out_.surface_points = rounded(points, options_.numbers);
    out_.surface_confidence = winding_.confidence(out_.surface_points, task);
  }

  /// Uniform points first, then those where normals turn, then those near the surface.
  void sample_space(Task task) {
    const int n = options_.space, uniform = share_of(options_.uniform, n),
              curvature = std::min(share_of(options_.curvature, n), n - uniform);
    MatX3 points(n, 3), normals(n, 3);
    out_.kinds.resize(std::size_t(n));
    out_.deviations = VecX::Zero(n);
    MatX3 noise = MatX3::Zero(n, 3);
    const std::size_t scales = options_.scales.size();
    parallel_for(std::size_t(n), 1024, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        RandomNumbers random(options_.seed, in_space, i);
        const auto row = index(i);
        if (row < uniform) {
          for (int a = 0; a < 3; ++a) points(row, a) = 2 * random.uniform() - 1;
          normals.row(row).setZero();
          out_.kinds[i] = SampleKind::uniform;
          continue;
        }
        const bool turns = row < uniform + curvature;
        out_.kinds[i] = turns ? SampleKind::curvature : SampleKind::near;
        const PointOnTriangle at = (turns ? by_turn_ : by_area_).choose(random);
        points.row(row) = at.point;
        normals.row(row) = at.normal;
        out_.deviations[row] = options_.scales[i % scales];
        for (int a = 0; a < 3; ++a) noise(row, a) = out_.deviations[row] * random.about_normal();
      }
    });
    if (n > uniform) {
      MatX3 near = points.bottomRows(n - uniform), of_these = normals.bottomRows(n - uniform);
      move_to_surface(distance_, near, of_these, task.stage(0.5, "points in space"));
      points.bottomRows(n - uniform) = near;
    }
    out_.points = rounded(points + noise, options_.numbers);
    out_.distances = evaluate(distance_, out_.points, nullptr, task.stage(0.4, "distance"));
    out_.confidence = winding_.confidence(out_.points, task);
  }

  const PointwiseDistance& distance_;
  const WindingOfInput& winding_;
  Samples& out_;
  const SampleOptions& options_;
  TriangleChoice by_area_, by_turn_;
};

}  // namespace

Samples sample(const PolygonSoup& input, const SampleOptions& options, const AnyMethod& method,
               const Orientation& orientation, const Context& context) {
  check(options);
  return run(context, [&](Task task) {
    Samples out;
    out.options = options;
    const Box box = bounding_box(input);
    out.centre = box.low + box.size() / 2;
    out.half_side = box.size().maxCoeff() * (0.5 + options.margin);
    if (!(out.half_side > 0)) throw InputError("the input has no extent", "empty-input");
    PolygonSoup placed = input;
    placed.points = (input.points.rowwise() - out.centre.transpose()) / out.half_side;
    const Stopwatch watch(out.report, "samples");
    const auto distance =
        pointwise_distance(placed, {method, orientation.flip, orientation.estimate_normals},
                           task.stage(0.2, "preparing"), out.report);
    Report ignored;  // the distance's holds the same
    const WindingOfInput winding(placed, orientation, task, ignored);
    out.surface = zero_surface(*distance, options.resolution, task, out.report);
    Task rest = task.stage(0.3, "samples");
    Sampler(*distance, winding, out).run(rest);
    return out;
  });
}

}  // namespace littoral
