// Signed distance in space against closed forms. Prints Markdown.
// usage: littoral_space_accuracy exact      error against spacing, with observed orders
//        littoral_space_accuracy corrupt    error of clouds under noise, outliers, flips, sparsity

#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "littoral/api/sdf.h"
#include "space_helpers.h"

namespace {

using namespace littoral;

struct Shape {
  std::string name;
  std::function<PolygonSoup(double h)> mesh;  // sides of about h where it is curved
  std::function<double(const Vec3&)> distance;
};

int around(double length, double h) { return std::max(12, static_cast<int>(length / h)); }

const std::vector<Shape>& shapes() {
  static const double turn = 2 * std::acos(-1.0);
  static const std::vector<Shape> all = {
      {"sphere",
       [](double h) {
         int level = 2;
         while (1.6 / (1 << level) > h) ++level;
         return test::octasphere_soup(level);
       },
       [](const Vec3& x) { return x.norm() - 1; }},
      {"box", [](double) { return test::box_soup(Vec3(0.9, 0.7, 0.5)); },
       [](const Vec3& x) { return test::box_distance(x, Vec3(0.9, 0.7, 0.5)); }},
      {"torus",
       [](double h) {
         return test::torus_soup(around(turn * 1.1, h), around(turn * 0.35, h), 0.75, 0.35);
       },
       [](const Vec3& x) { return test::torus_distance(x, 0.75, 0.35); }},
      {"cylinder", [](double h) { return test::cylinder_soup(around(turn * 0.6, h), 0.6, 0.8); },
       [](const Vec3& x) { return test::cylinder_distance(x, 0.6, 0.8); }},
  };
  return all;
}

struct Way {
  std::string name;
  std::string method;
  OptionTexts options;
  bool tets = false;
};

VecX distance(const PolygonSoup& input, const Grid& grid, const Way& way) {
  SpaceRequest request;
  request.method = way.method;
  request.options = way.options;
  Report report;
  VecX values;
  if (way.tets)
    tet_distance(input, grid, request, &values, Task(), report);
  else
    values = grid_distance(input, grid, request, Task(), report);
  return values;
}

void exact() {
  const std::vector<Way> ways = {{"grid, soft", "signed-heat", {}},
                                 {"grid, zero-set", "signed-heat", {{"constraint", "zero-set"}}},
                                 {"grid, none", "signed-heat", {{"constraint", "none"}}},
                                 {"tets, soft", "signed-heat", {}, true},
                                 {"winding", "winding", {}},
                                 {"tori", "tori", {}},
                                 {"hopf-cole", "hopf-cole", {}},
                                 {"planar", "planar", {}}};
  const std::array<int, 3> sizes{17, 33, 65};
  std::printf("| shape | method | 17^3 | 33^3 | 65^3 | order |\n|---|---|---|---|---|---|\n");
  for (const Shape& shape : shapes())
    for (const Way& way : ways) {
      std::printf("| %s | %s |", shape.name.c_str(), way.name.c_str());
      std::array<double, 3> error{};
      for (std::size_t s = 0; s < sizes.size(); ++s) {
        const Grid grid = test::cube_grid(sizes[s], 1.5);
        const VecX values = distance(shape.mesh(grid.spacing[0]), grid, way);
        error[s] = test::mean_error(grid, values, shape.distance);
        std::printf(" %.2e |", error[s]);
        std::fflush(stdout);
      }
      std::printf(" %.1f |\n", std::log2(error[0] / error[2]) / 2);
    }
}

/// n points on a shape, evenly by area, with the normals of the exact distance.
PolygonSoup cloud_of(const Shape& shape, int n, std::mt19937& random) {
  Report report;
  const OrientedPoints fine = sample_faces(shape.mesh(0.02), 0.03, report);
  std::vector<double> weights(fine.areas.begin(), fine.areas.end());
  std::discrete_distribution<int> pick(weights.begin(), weights.end());
  PolygonSoup cloud;
  cloud.points.resize(n, 3);
  cloud.normals.resize(n, 3);
  for (int i = 0; i < n; ++i) {
    const int s = pick(random);
    cloud.points.row(i) = fine.points.row(s);
    cloud.normals.row(i) = fine.normals.row(s);
    // Off the lattice of the mesh: anywhere within its triangle.
    std::uniform_real_distribution<double> u(-0.01, 0.01);
    const Vec3 p = cloud.points.row(i).transpose() + Vec3(u(random), u(random), u(random));
    cloud.points.row(i) = p - shape.distance(p) * Vec3(fine.normals.row(s));
  }
  return cloud;
}

struct Damage {
  std::string name;
  std::vector<double> amounts;
  std::function<void(PolygonSoup&, double, std::mt19937&)> apply;
};

void corrupt() {
  const auto share = [](const PolygonSoup& c, double amount) {
    return static_cast<int>(std::lround(amount * c.n_vertices()));
  };
  const std::vector<Damage> damages = {
      {"noise, in % of the box",
       {0, 0.5, 1, 2, 4},
       [](PolygonSoup& c, double amount, std::mt19937& random) {
         std::normal_distribution<double> normal(0, amount / 100 * 2);
         for (double& x : c.points.reshaped()) x += normal(random);
       }},
      {"outliers, in %",
       {0, 2, 5, 10, 20},
       [share](PolygonSoup& c, double amount, std::mt19937& random) {
         std::uniform_real_distribution<double> u(-1.3, 1.3);
         for (int i = 0; i < share(c, amount / 100); ++i) {
           for (int a = 0; a < 3; ++a) c.points(i, a) = u(random);
           Vec3 n(u(random), u(random), u(random));
           c.normals.row(i) = n.normalized();
         }
       }},
      {"flipped normals, in %",
       {0, 2, 5, 10, 20},
       [share](PolygonSoup& c, double amount, std::mt19937&) {
         c.normals.topRows(share(c, amount / 100)) *= -1;
       }},
      {"points",
       {4096, 1024, 512, 256, 128},
       [](PolygonSoup& c, double amount, std::mt19937&) {
         const auto n = static_cast<Eigen::Index>(amount);
         c.points.conservativeResize(n, 3);
         c.normals.conservativeResize(n, 3);
       }},
  };
  const std::vector<Way> ways = {{"grid", "signed-heat", {}},
                                 {"tets", "signed-heat", {}, true},
                                 {"winding", "winding", {}},
                                 {"hopf-cole", "hopf-cole", {}},
                                 {"planar", "planar", {}},
                                 {"tori", "tori", {}},
                                 {"tori, noisy", "tori", {{"noisy", "on"}}}};
  const Grid grid = test::cube_grid(41, 1.5);
  for (const std::size_t s : {std::size_t(0), std::size_t(3)}) {
    const Shape& shape = shapes()[s];
    for (const Damage& damage : damages) {
      std::printf("\n| %s: %s |", shape.name.c_str(), damage.name.c_str());
      for (const double amount : damage.amounts) std::printf(" %g |", amount);
      std::printf("\n|---|");
      for (std::size_t i = 0; i < damage.amounts.size(); ++i) std::printf("---|");
      std::printf("\n");
      for (const Way& way : ways) {
        std::printf("| %s |", way.name.c_str());
        for (const double amount : damage.amounts) {
          std::mt19937 random(7);
          PolygonSoup cloud = cloud_of(shape, damage.name == "points" ? 4096 : 2048, random);
          damage.apply(cloud, amount, random);
          const VecX values = distance(cloud, grid, way);
          std::printf(" %.4f |", test::mean_error(grid, values, shape.distance));
          std::fflush(stdout);
        }
        std::printf("\n");
      }
    }
  }
}

}  // namespace

int main(int count, char** words) {
  if (count == 2 && std::strcmp(words[1], "exact") == 0) {
    exact();
  } else if (count == 2 && std::strcmp(words[1], "corrupt") == 0) {
    corrupt();
  } else {
    std::fprintf(stderr, "usage: littoral_space_accuracy exact|corrupt\n");
    return 2;
  }
}
