// Is signed heat as good far from the source as near it, on any size of mesh? Errors in fifths of
// the distance: octaspheres against the sphere, subdivided meshes against exact polyhedral distance
// on the mesh before it was subdivided, which is the same surface.
// usage: littoral_far_field FIRST_LEVEL LAST_LEVEL [MESH SUBDIVISIONS]...   prints Markdown rows.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "littoral/domain/intrinsic_triangulation.h"
#include "littoral/io/read.h"
#include "littoral/methods/exact_polyhedral.h"
#include "littoral/methods/signed_heat.h"
#include "littoral/operators/triangles.h"
#include "littoral/sources/pieces.h"
#include "littoral/sources/triangle_source_terms.h"
#include "littoral/sources/triangle_sources.h"
#include "test_meshes.h"

namespace littoral {
namespace {

constexpr int fifths = 5;

VecX signed_heat(const SurfaceMesh& mesh, const SurfaceSources& sources, Report& report) {
  const IntrinsicTriangulation T = intrinsic_triangulation(mesh, report);
  const auto ops = std::make_shared<const Operators>(triangle_operators(T));
  const SourceTerms terms = source_terms(mesh, T, prepare(mesh, sources, false, report));
  SignedHeatOptions options;
  options.time_scale = automatic_time_scale(terms);
  return SignedHeat(ops, options.time_scale, {}, needed_diffusions(terms, options),
                    Expect::one_solve)
      .solve(terms, options, {}, report);
}

VecX exact(const SurfaceMesh& mesh, const SurfaceSources& sources) {
  Report report;
  const IntrinsicTriangulation T = intrinsic_triangulation(mesh, report);
  return exact_polyhedral(T, triangle_sources(mesh, T, prepare(mesh, sources, false, report)), {},
                          report);
}

/// Mean error in each fifth of the distance and the largest, in % of the largest distance.
void print_row(const std::string& name, int faces, const char* source, const VecX& phi,
               const VecX& truth) {
  double most = 0, worst = 0, all = 0, n = 0;
  for (double d : truth)
    if (std::isfinite(d)) most = std::max(most, std::abs(d));
  double sum[fifths] = {}, count[fifths] = {};
  for (Eigen::Index i = 0; i < truth.size(); ++i) {
    const double d = std::abs(truth[i]);
    if (!std::isfinite(d)) continue;
    const double error = 100 * std::abs(std::abs(phi[i]) - d) / most;
    const int k = std::min(fifths - 1, static_cast<int>(fifths * d / most));
    sum[k] += error;
    ++count[k];
    all += error;
    ++n;
    worst = std::max(worst, error);
  }
  std::printf("| %s | %d | %s |", name.c_str(), faces, source);
  for (int k = 0; k < fifths; ++k) std::printf(" %.3f |", count[k] > 0 ? sum[k] / count[k] : 0.0);
  std::printf(" %.3f | %.2f |\n", all / n, worst);
  std::fflush(stdout);
}

void octasphere(int level) {
  const double degree = std::acos(-1.0) / 180, cap = 3 * degree;
  const SurfaceMesh mesh(test::octasphere_soup(level));
  const MatX3& x = mesh.points();
  VecX angle(x.rows());  // from vertex 4, the pole
  for (Eigen::Index i = 0; i < x.rows(); ++i)
    angle[i] = std::atan2(std::hypot(x(i, 0), x(i, 1)), x(i, 2));
  SurfaceSources around, pole;
  constexpr int n = 720;
  SpaceCurve circle{MatX3(n + 1, 3), true, "circle"};
  for (int k = 0; k <= n; ++k) {
    const double a = 360 * degree * (k % n) / n;
    circle.points.row(k) << std::sin(cap) * std::cos(a), std::sin(cap) * std::sin(a), std::cos(cap);
  }
  around.space_curves.push_back(circle);
  pole.points.push_back(SurfacePoint::at_vertex(4));
  const std::string name = "octasphere " + std::to_string(level);
  Report report;
  print_row(name, mesh.n_faces(), "circle of 3°", signed_heat(mesh, around, report),
            (angle.array() - cap).matrix());
  print_row(name, mesh.n_faces(), "point", signed_heat(mesh, pole, report), angle);
}

using Middles = std::map<std::pair<int, int>, int>;

/// Every triangle becomes four; curves of vertices take in the middles of their edges.
PolygonSoup subdivided(const PolygonSoup& soup, std::vector<int>& curve) {
  PolygonSoup fine;
  Middles middles;
  std::vector<Vec3> points;
  for (int i = 0; i < soup.n_vertices(); ++i) points.emplace_back(soup.points.row(i));
  auto middle = [&](int i, int j) {
    const auto [at, fresh] =
        middles.try_emplace({std::min(i, j), std::max(i, j)}, static_cast<int>(points.size()));
    if (fresh) points.emplace_back(0.5 * (points[i] + points[j]));
    return at->second;
  };
  for (int f = 0; f < soup.n_faces(); ++f) {
    const auto c = soup.face(f);
    const int a = middle(c[0], c[1]), b = middle(c[1], c[2]), d = middle(c[2], c[0]);
    test::add_triangle(fine, c[0], a, d);
    test::add_triangle(fine, a, c[1], b);
    test::add_triangle(fine, d, b, c[2]);
    test::add_triangle(fine, a, b, d);
  }
  std::vector<int> longer;
  for (std::size_t k = 0; k < curve.size(); ++k) {
    longer.push_back(curve[k]);
    if (k + 1 < curve.size()) longer.push_back(middle(curve[k], curve[k + 1]));
  }
  curve = std::move(longer);
  fine.points.resize(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i)
    fine.points.row(static_cast<Eigen::Index>(i)) = points[i];
  return fine;
}

/// The longest closed loop of edges around the faces within a distance.
std::vector<int> loop_at(const PolygonSoup& soup, const VecX& d, double radius) {
  std::map<int, int> after;
  std::map<std::pair<int, int>, int> half;
  for (int f = 0; f < soup.n_faces(); ++f) {
    const auto c = soup.face(f);
    if (!(d[c[0]] <= radius && d[c[1]] <= radius && d[c[2]] <= radius)) continue;
    for (int k = 0; k < 3; ++k) half[{c[k], c[(k + 1) % 3]}] = 1;
  }
  for (const auto& [e, unused] : half)
    if (!half.contains({e.second, e.first})) after[e.first] = e.second;
  std::vector<int> best;
  while (!after.empty()) {
    std::vector<int> loop{after.begin()->first};
    while (after.contains(loop.back())) {
      const int i = loop.back();
      loop.push_back(after[i]);
      after.erase(i);
    }
    if (loop.front() == loop.back() && loop.size() > best.size()) best = loop;
  }
  return best;
}

SurfaceSources curve_through(const std::vector<int>& nodes) {
  SurfaceSources sources;
  SurfaceCurve curve;
  for (int v : nodes) curve.nodes.push_back(SurfacePoint::at_vertex(v));
  sources.curves.push_back(std::move(curve));
  return sources;
}

void real_mesh(const char* path, int times) {
  PolygonSoup soup = io::read_surface(path);
  const SurfaceMesh coarse(soup);
  SurfaceSources point;
  point.points.push_back(SurfacePoint::at_vertex(soup.corners.front()));
  const VecX from_point = exact(coarse, point);
  double most = 0;
  for (double d : from_point)
    if (std::isfinite(d)) most = std::max(most, d);
  std::vector<int> curve = loop_at(soup, from_point, 0.25 * most);
  const VecX from_curve = exact(coarse, curve_through(curve));
  for (int k = 0; k < times; ++k) soup = subdivided(soup, curve);
  const SurfaceMesh mesh(soup);
  const std::string name = std::filesystem::path(path).stem().string();
  Report report;
  print_row(name, mesh.n_faces(), "curve",
            signed_heat(mesh, curve_through(curve), report).head(from_curve.size()), from_curve);
  print_row(name, mesh.n_faces(), "point", signed_heat(mesh, point, report).head(from_point.size()),
            from_point);
}

}  // namespace
}  // namespace littoral

int main(int argc, char** argv) {
  if (argc < 3 || argc % 2 == 0) {
    std::fprintf(stderr,
                 "usage: littoral_far_field FIRST_LEVEL LAST_LEVEL [MESH SUBDIVISIONS]...\n");
    return 2;
  }
  std::printf(
      "| mesh | faces | source | to 20 %% | to 40 %% | to 60 %% | to 80 %% | to 100 %% | mean | "
      "largest |\n|---|---|---|---|---|---|---|---|---|---|\n");
  try {
    for (int level = std::atoi(argv[1]); level <= std::atoi(argv[2]); ++level)
      littoral::octasphere(level);
    for (int k = 3; k < argc; k += 2) littoral::real_mesh(argv[k], std::atoi(argv[k + 1]));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "littoral_far_field: %s\n", error.what());
    return 1;
  }
  return 0;
}
