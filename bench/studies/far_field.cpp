// Is signed heat as good far from the source as near it, on any size of mesh? Errors in fifths of
// the distance: octaspheres against the sphere, subdivided meshes against exact polyhedral distance
// on the mesh before it was subdivided, which is the same surface.
// usage: littoral_far_field [--time-scale S] FIRST_LEVEL LAST_LEVEL [MESH SUBDIVISIONS]...
// prints Markdown rows, at the automatic time scale where none is given.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "api/surface/surface_domain.h"
#include "io/read.h"
#include "subdivided_meshes.h"
#include "test_meshes.h"

namespace littoral {
namespace {

constexpr int fifths = 5;
double given_scale = 0;  // 0: automatic

VecX signed_heat(const SurfaceMesh& mesh, const Sources& sources, double& scale) {
  Report report;
  VecX phi = solve_once(AnyMethod(SignedHeat{.time_scale = given_scale}), domain_of(mesh), sources,
                        {}, report)
                 .values;
  for (const auto& [name, value] : report.options)
    if (name == "time-scale") scale = std::atof(value.c_str());
  return phi;
}

VecX exact(const SurfaceMesh& mesh, const Sources& sources) {
  Report report;
  return solve_once(AnyMethod(Exact{}), domain_of(mesh), sources, {}, report).values;
}

/// Mean error in each fifth of the distance and the largest, in % of the largest distance.
void print_row(const std::string& name, int faces, const char* source, double scale,
               const VecX& phi, const VecX& truth) {
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
  std::printf("| %s | %d | %s | %g |", name.c_str(), faces, source, scale);
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
  Sources around, pole;
  constexpr int n = 720;
  SpaceCurve circle{MatX3(n + 1, 3), true, "circle"};
  for (int k = 0; k <= n; ++k) {
    const double a = 360 * degree * (k % n) / n;
    circle.points.row(k) << std::sin(cap) * std::cos(a), std::sin(cap) * std::sin(a), std::cos(cap);
  }
  around.space_curves.push_back(circle);
  pole.points.push_back(SurfacePoint::at_vertex(4));
  const std::string name = "octasphere " + std::to_string(level);
  double scale = 0;
  const VecX from_circle = signed_heat(mesh, around, scale);
  print_row(name, mesh.n_faces(), "circle of 3°", scale, from_circle,
            (angle.array() - cap).matrix());
  const VecX from_pole = signed_heat(mesh, pole, scale);
  print_row(name, mesh.n_faces(), "point", scale, from_pole, angle);
}

Sources curve_through(const std::vector<int>& nodes) {
  Sources sources;
  Curve curve;
  for (int v : nodes) curve.nodes.push_back(SurfacePoint::at_vertex(v));
  sources.curves.push_back(std::move(curve));
  return sources;
}

void real_mesh(const char* path, int times) {
  PolygonSoup soup = io::read_surface(path);
  const SurfaceMesh coarse(soup);
  Sources point;
  point.points.push_back(SurfacePoint::at_vertex(soup.corners.front()));
  const VecX from_point = exact(coarse, point);
  double most = 0;
  for (double d : from_point)
    if (std::isfinite(d)) most = std::max(most, d);
  std::vector<int> curve = test::loop_at(soup, from_point, 0.25 * most);
  const VecX from_curve = exact(coarse, curve_through(curve));
  for (int k = 0; k < times; ++k) soup = test::quartered(soup, &curve);
  const SurfaceMesh mesh(soup);
  const std::string name = std::filesystem::path(path).stem().string();
  double scale = 0;
  const VecX phi = signed_heat(mesh, curve_through(curve), scale);
  print_row(name, mesh.n_faces(), "curve", scale, phi.head(from_curve.size()), from_curve);
  const VecX psi = signed_heat(mesh, point, scale);
  print_row(name, mesh.n_faces(), "point", scale, psi.head(from_point.size()), from_point);
}

}  // namespace
}  // namespace littoral

int main(int argc, char** argv) {
  if (argc > 2 && std::strcmp(argv[1], "--time-scale") == 0) {
    littoral::given_scale = std::atof(argv[2]);
    argc -= 2;
    argv += 2;
  }
  if (argc < 3 || argc % 2 == 0) {
    std::fprintf(stderr,
                 "usage: littoral_far_field [--time-scale S] FIRST_LEVEL LAST_LEVEL [MESH "
                 "SUBDIVISIONS]...\n");
    return 2;
  }
  std::printf(
      "| mesh | faces | source | time scale | to 20 %% | to 40 %% | to 60 %% | to 80 %% | to 100 "
      "%% | mean | "
      "largest |\n|---|---|---|---|---|---|---|---|---|---|---|\n");
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
