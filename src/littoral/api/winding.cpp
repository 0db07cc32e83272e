#include "littoral/api/winding.h"

#include <cmath>
#include <map>
#include <memory>
#include <tuple>

#include "littoral/base/error.h"
#include "littoral/domain/intrinsic_triangulation.h"
#include "littoral/operators/jump_calculus.h"
#include "littoral/sources/conform.h"

namespace littoral {

namespace {

/// Joins directed edges, each as often as it counts, head to tail into polylines.
Polylines polylines(const SurfaceMesh& mesh, const VecX& times) {
  std::multimap<int, int> out;  // vertex -> next
  std::map<int, int> surplus;
  for (int e = 0; e < mesh.n_edges(); ++e) {
    const long n = std::lround(std::abs(times[e]));
    for (long i = 0; i < n; ++i) {
      const int a = mesh.edges()(e, times[e] > 0 ? 0 : 1);
      const int b = mesh.edges()(e, times[e] > 0 ? 1 : 0);
      out.emplace(a, b);
      ++surplus[a];
      --surplus[b];
    }
  }
  Polylines lines;
  const auto follow = [&](int v) {
    std::vector<Vec3> points{mesh.point(v)};
    for (auto it = out.find(v); it != out.end(); it = out.find(v)) {
      v = it->second;
      out.erase(it);
      points.push_back(mesh.point(v));
    }
    MatX3 line(static_cast<Eigen::Index>(points.size()), 3);
    for (std::size_t i = 0; i < points.size(); ++i)
      line.row(static_cast<Eigen::Index>(i)) = points[i];
    lines.push_back(std::move(line));
  };
  for (const auto& [v, n] : surplus)  // ends of open curves first
    for (int i = 0; i < n; ++i) follow(v);
  while (!out.empty()) follow(out.begin()->first);
  return lines;
}

double total_length(const Polylines& lines) {
  double length = 0;
  for (const MatX3& line : lines)
    for (Eigen::Index i = 1; i < line.rows(); ++i) length += (line.row(i) - line.row(i - 1)).norm();
  return length;
}

/// The cut mesh with one vertex for every value that meets at it.
PolygonSoup tear(const SurfaceMesh& mesh, const std::vector<int>& triangle_of_face,
                 const JumpCalculus& J, const WindingNumbers& numbers) {
  PolygonSoup soup;
  std::map<std::tuple<int, int, long long>, int> vertex;  // vertex, region, value to 1e-6
  std::vector<int> source;
  std::vector<double> winding, region, weight;
  for (int f = 0; f < mesh.n_faces(); ++f) {
    const int t = triangle_of_face[f];
    int corners[3];
    for (int k = 0; k < 3; ++k) {
      const int label = t < 0 ? 0 : numbers.region[t];
      const double value = t < 0 ? 0 : numbers.w.u(t, k);
      const bool open = t >= 0 && numbers.w.open[J.node(t, k)];
      const auto key =
          std::tuple(mesh.face(f)[k], label, open ? -(1LL << 50) - f : std::llround(value * 1e6));
      const auto [it, added] = vertex.try_emplace(key, static_cast<int>(source.size()));
      if (added) {
        source.push_back(mesh.face(f)[k]);
        winding.push_back(value);
        region.push_back(label);
        weight.push_back(open ? 0 : 1);
      }
      corners[k] = it->second;
    }
    soup.add_face(corners);
  }
  soup.points.resize(static_cast<Eigen::Index>(source.size()), 3);
  for (std::size_t v = 0; v < source.size(); ++v)
    soup.points.row(static_cast<Eigen::Index>(v)) = mesh.point(source[v]);
  const auto vector = [](const std::vector<double>& values) {
    return VecX(VecX::Map(values.data(), static_cast<Eigen::Index>(values.size())));
  };
  soup.scalars = {
      {"winding", vector(winding)}, {"region", vector(region)}, {"weight", vector(weight)}};
  return soup;
}

/// The label of the largest part of every face of the input.
VecXi labels_of_input(const SurfaceMesh& mesh, const WindingAnswer& answer, const JumpCalculus& J) {
  std::vector<std::map<int, double>> area(mesh.n_faces());
  for (int f = 0; f < answer.cut.mesh.n_faces(); ++f)
    if (const int t = answer.triangle_of_face[f]; t >= 0)
      area[answer.cut.parent_face[f]][answer.numbers.region[t]] += J.area[t];
  VecXi region = VecXi::Zero(mesh.n_faces());
  for (int f = 0; f < mesh.n_faces(); ++f) {
    double largest = 0;
    for (const auto& [label, a] : area[f])
      if (a > largest) {
        largest = a;
        region[f] = label;
      }
  }
  return region;
}

void refuse_nonmanifold(const SurfaceMesh& mesh, const JumpCalculus& J) {
  int count = 0, first = -1;
  for (int e = 0; e < J.n_edges; ++e)
    if (!J.manifold[e]) {
      if (count++ == 0) first = e;
    }
  if (count == 0) return;
  throw UnsupportedError("winding numbers of curves need at most two faces at every edge; " +
                         std::to_string(count) + " edges have more, the first between vertices " +
                         std::to_string(mesh.edges()(first, 0)) + " and " +
                         std::to_string(mesh.edges()(first, 1)));
}

}  // namespace

const MethodInfo& winding_method() {
  static const MethodInfo method = {
      "surface-winding",
      "Regions that (broken) signed curves bound on a surface, and curves that bound nothing.",
      {"triangle mesh"},
      winding_options().infos(),
      "Feng, Gillespie, Crane: Winding Numbers on Discrete Surfaces (2023)"};
  return method;
}

void check_request(const WindingRequest& request) {
  parse_options(winding_method(), winding_options(), request.options);
}

WindingAnswer surface_winding(const SurfaceMesh& mesh, const SurfaceSources& sources,
                              const WindingRequest& request, Task task, Report& report) {
  const WindingOptions options =
      parse_options(winding_method(), winding_options(), request.options);
  report.method = winding_method().name;
  report.domain = "triangle mesh";
  report_options(winding_options(), options, report);
  const PreparedSources prepared = prepared_sources({mesh, sources, request.flip}, task, report);
  ConformingCurves curves = [&] {
    const Stopwatch watch(report, "cut");
    return conform(mesh, prepared, report);
  }();
  WindingAnswer answer{{}, std::move(curves.cut), {}, {}, {}, {}, {}, {}};
  const SurfaceMesh& cut = answer.cut.mesh;
  if (curves.is_cut) report.sizes.emplace_back("cut_faces", cut.n_faces());
  task.checkpoint();
  const auto J = [&] {
    const Stopwatch watch(report, "operators");
    const IntrinsicTriangulation T = intrinsic_triangulation(cut, report);
    answer.triangle_of_face = T.triangle_of_face;
    return std::make_shared<const JumpCalculus>(jump_calculus(T));
  }();
  refuse_nonmanifold(cut, *J);
  answer.numbers =
      SurfaceWinding(J).solve(curves.times, options, task.stage(0.9, "winding"), report);
  answer.region = labels_of_input(mesh, answer, *J);
  answer.shown = tear(cut, answer.triangle_of_face, *J, answer.numbers);
  answer.completed = polylines(cut, answer.numbers.completed);
  // Each edge of the curve goes to the part of which it has the larger share.
  VecX bounding = curves.times, nonbounding = VecX::Zero(cut.n_edges());
  for (int e = 0; e < cut.n_edges(); ++e)
    if (std::abs(answer.numbers.nonbounding[e]) > 0.5 * std::abs(curves.times[e]))
      std::swap(bounding[e], nonbounding[e]);
  answer.bounding = polylines(cut, bounding);
  answer.nonbounding = polylines(cut, nonbounding);
  report.sizes.emplace_back("bounding_length", total_length(answer.bounding));
  report.sizes.emplace_back("nonbounding_length", total_length(answer.nonbounding));
  report.sizes.emplace_back("completed_length", total_length(answer.completed));
  return answer;
}

}  // namespace littoral
