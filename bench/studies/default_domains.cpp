// What is answered without options on clouds and voxels: distance from one point.
// usage: littoral_default_domains MESH...    prints Markdown tables
// Clouds: random points of the unit sphere, moved along its normals by noise, with great circles as
// truth; and the vertices of the meshes, with exact polyhedral distance on the meshes as truth.
// Voxels: spheres and tilted cylinders, with closed forms.

#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "api/surface/surface_domain.h"
#include "domain/volume/voxels.h"
#include "io/read.h"

namespace littoral {
namespace {

constexpr double pi = 3.14159265358979323846;

/// Mean and largest error in % of the largest distance, where the truth is not negative.
void print_row(const std::string& name, const SurfaceDomain& domain, const Sources& sources,
               const VecX& truth) {
  std::printf("| %s | %d |", name.c_str(), domain.mesh->n_vertices());
  for (const char* method : {"auto", "signed-heat", "unsigned-heat"}) {
    Report report;
    const auto begin = std::chrono::steady_clock::now();
    const VecX d =
        solve_once<SurfaceDomain>(AnyMethod::named(method), domain, sources, {}, report).values;
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
    double sum = 0, worst = 0;
    int n = 0;
    for (Eigen::Index v = 0; v < d.size(); ++v) {
      if (!(truth[v] >= 0 && std::isfinite(truth[v]) && std::isfinite(d[v]))) continue;
      const double e = std::abs(d[v] - truth[v]);
      sum += e;
      worst = std::max(worst, e);
      ++n;
    }
    const double range = truth.array().isFinite().select(truth, 0).maxCoeff();
    std::printf(" %.2f / %.2f, %.2f s |", 100 * sum / n / range, 100 * worst / range,
                seconds.count());
    std::fflush(stdout);
  }
  std::printf("\n");
}

Sources from_vertex(int v) {
  Sources sources;
  sources.points = {SurfacePoint::at_vertex(v)};
  return sources;
}

void random_sphere(int n, double noise) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  PolygonSoup cloud;
  cloud.points.resize(n, 3);
  cloud.normals.resize(n, 3);
  VecX truth(n);
  for (int i = 0; i < n; ++i) {
    const Vec3 x = Vec3(normal(random), normal(random), normal(random)).normalized();
    cloud.normals.row(i) = x;
    cloud.points.row(i) = x * (1 + noise * normal(random));
    truth[i] = std::acos(std::clamp(double(x.dot(cloud.normals.row(0))), -1.0, 1.0));
  }
  const SurfaceMesh mesh(cloud);
  char name[40];
  std::snprintf(name, sizeof name, "sphere, noise %g", noise);
  print_row(name, domain_of(mesh), from_vertex(0), truth);
}

void vertices_of(const char* file) {
  const PolygonSoup soup = io::read_surface(file);
  const SurfaceMesh mesh(soup);
  const Sources sources = from_vertex(soup.face(0)[0]);
  Report report;
  const VecX truth =
      solve_once<SurfaceDomain>(Automatic{}, domain_of(mesh), sources, {}, report).values;
  PolygonSoup cloud;
  cloud.points = soup.points;
  cloud.normals = MatX3::Zero(soup.points.rows(), 3);
  for (int f = 0; f < mesh.n_faces(); ++f) {
    const auto c = mesh.face(f);
    const Vec3 n = (mesh.point(c[1]) - mesh.point(c[0])).cross(mesh.point(c[2]) - mesh.point(c[0]));
    for (const int v : c) cloud.normals.row(v) += n;
  }
  for (auto n : cloud.normals.rowwise()) n.stableNormalize();
  const SurfaceMesh points(cloud);
  print_row(std::filesystem::path(file).stem(), domain_of(points), sources, truth);
}

void voxels(bool cylinder, double r) {
  const int n = 2 * static_cast<int>(cylinder ? 1.5 * r : r) + 5;
  const Grid grid{{n, n, n}, Vec3::Zero(), Vec3::Ones()};
  const Vec3 middle = Vec3::Constant((n - 1) / 2.0 + 0.13), axis = Vec3(1, 0.4, 0.7).normalized();
  std::vector<unsigned char> inside(grid.n_nodes());
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const Vec3 x = grid.point(i, j, k) - middle;
        const double h = x.dot(axis);
        inside[grid.node(i, j, k)] =
            cylinder ? (x - h * axis).norm() <= r / 2 && std::abs(h) <= 1.2 * r : x.norm() <= r;
      }
  const VoxelSurface surface = boundary_of_voxels(grid, inside);
  int source = 0;
  while (cylinder && std::abs((surface.mesh.point(source) - middle).dot(axis)) > 0.1 * r) ++source;
  const Vec3 from = surface.mesh.point(source) - middle, u = axis.unitOrthogonal(),
             w = axis.cross(u);
  VecX truth(surface.mesh.n_vertices());
  for (int v = 0; v < truth.size(); ++v) {
    const Vec3 x = surface.mesh.point(v) - middle;
    const double h = x.dot(axis);
    const double turn = std::remainder(
        std::atan2(x.dot(u), x.dot(w)) - std::atan2(from.dot(u), from.dot(w)), 2 * pi);
    if (cylinder)
      truth[v] = std::abs(h) > r ? -1 : std::hypot(r / 2 * turn, h - from.dot(axis));
    else
      truth[v] = r * std::acos(std::clamp(x.normalized().dot(from.normalized()), -1.0, 1.0));
  }
  char name[40];
  std::snprintf(name, sizeof name, "%s, radius %g", cylinder ? "cylinder" : "sphere",
                cylinder ? r / 2 : r);
  print_row(name, domain_of(surface.mesh, &surface.face_normals), from_vertex(source), truth);
}

void run(int n_meshes, char** meshes) {
  constexpr const char* head =
      "| points | auto: mean / largest [%], time | signed-heat | unsigned-heat |\n"
      "|---|---|---|---|---|\n";
  std::printf("| cloud %s", head);
  for (const int n : {1000, 5000, 20000})
    for (const double noise : {0.0, 0.01, 0.03}) random_sphere(n, noise);
  for (int i = 0; i < n_meshes; ++i) vertices_of(meshes[i]);
  std::printf("\n| voxels %s", head);
  for (const bool cylinder : {false, true})
    for (const double r : {8.0, 16.0, 32.0}) voxels(cylinder, r);
}

}  // namespace
}  // namespace littoral

int main(int argc, char** argv) {
  try {
    littoral::run(argc - 1, argv + 1);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "littoral_default_domains: %s\n", error.what());
    return 1;
  }
}
