// Signed distance in space against closed forms.
// usage: littoral_space_accuracy exact [WORD]... error against spacing, with observed orders, as
//                                              Markdown; of the shapes and methods named only
//        littoral_space_accuracy landscapes N  error of clouds under noise, outliers, flips and
//                                              sparsity on N^3 nodes, .csv for space_landscapes.py

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "api/space/sdf.h"
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
  AnyMethod method;
  bool tets = false;
};

VecX distance(const PolygonSoup& input, const Grid& grid, const Way& way) {
  Report report;
  if (way.tets) return tet_distance(input, grid, {}, {way.method}, Task(), report).at_nodes;
  return grid_distance(input, grid, {way.method}, Task(), report);
}

void exact(const std::vector<std::string>& wanted) {
  const std::vector<Way> ways = {
      {"grid, soft", SpaceSignedHeat{}},
      {"grid, zero-set", SpaceSignedHeat{.constraint = SpaceConstraint::zero_set}},
      {"grid, none", SpaceSignedHeat{.constraint = SpaceConstraint::none}},
      {"tets, soft", SpaceSignedHeat{}, true},
      {"winding", WindingSign{}},
      {"tori", Tori{}},
      {"hopf-cole", HopfCole{}},
      {"planar", Planar{}}};
  const std::array<int, 3> sizes{17, 33, 65};
  // Named, or none of the kind is.
  const auto chosen = [&wanted](const std::string& name, const auto& all) {
    const auto is_wanted = [&wanted](const std::string& word) {
      return std::find(wanted.begin(), wanted.end(), word) != wanted.end();
    };
    return is_wanted(name) || std::none_of(all.begin(), all.end(), [&](const auto& other) {
             return is_wanted(other.name);
           });
  };
  std::printf("| shape | method | 17^3 | 33^3 | 65^3 | order |\n|---|---|---|---|---|---|\n");
  for (const Shape& shape : shapes())
    for (const Way& way : ways) {
      if (!chosen(shape.name, shapes()) || !chosen(way.name, ways)) continue;
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

/// n points evenly by area, with exact normals: a sphere, or a closed cylinder of height 1 about z.
PolygonSoup cloud_of(bool cylinder, double radius, int n, std::mt19937& random) {
  std::uniform_real_distribution<double> u(-1, 1);
  std::normal_distribution<double> normal;
  PolygonSoup cloud;
  cloud.points.resize(n, 3);
  cloud.normals.resize(n, 3);
  for (int i = 0; i < n; ++i) {
    Vec3 out = Vec3(normal(random), normal(random), cylinder ? 0 : normal(random)).normalized();
    Vec3 p = radius * out;
    if (cylinder) {
      p[2] = u(random) / 2;
      // The two caps have `radius` times the area of the side, which is 1 high.
      if ((1 + u(random)) / 2 * (1 + radius) < radius) {
        const double side = u(random) < 0 ? -1 : 1;
        p *= std::sqrt((1 + u(random)) / 2);
        p[2] = side / 2;
        out = Vec3(0, 0, side);
      }
    }
    cloud.points.row(i) = p;
    cloud.normals.row(i) = out;
  }
  return cloud;
}

struct Damage {
  std::string name;
  std::vector<double> amounts;
  std::function<void(PolygonSoup&, double, std::mt19937&)> apply;
};

/// The four kinds of the thesis, section 7.2.
std::vector<Damage> damages() {
  const auto share = [](const PolygonSoup& c, double amount) {
    return static_cast<Eigen::Index>(amount * c.n_vertices());
  };
  const auto shorten = [](PolygonSoup& c, Eigen::Index n) {
    c.points.conservativeResize(n, 3);
    c.normals.conservativeResize(n, 3);
  };
  return {{"noise",
           {0, 0.01, 0.03, 0.1},
           [](PolygonSoup& c, double amount, std::mt19937& random) {
             if (amount == 0) return;
             std::normal_distribution<double> normal(0, amount);
             for (double& x : c.points.reshaped()) x += normal(random);
             for (double& x : c.normals.reshaped()) x += normal(random);
             c.normals.rowwise().normalize();
           }},
          {"outliers",
           {0, 0.03, 0.1, 0.3},
           [share, shorten](PolygonSoup& c, double amount, std::mt19937& random) {
             std::uniform_real_distribution<double> u(-1, 1);
             std::normal_distribution<double> normal;
             const Eigen::Index old = c.points.rows();
             shorten(c, old + share(c, amount));
             for (Eigen::Index i = old; i < c.points.rows(); ++i) {
               c.points.row(i) << u(random), u(random), u(random);
               c.normals.row(i) = Vec3(normal(random), normal(random), normal(random)).normalized();
             }
           }},
          {"flips",
           {0, 0.05, 0.15, 0.3},
           [share](PolygonSoup& c, double amount, std::mt19937&) {
             c.normals.topRows(share(c, amount)) *= -1;
           }},
          {"points", {2048, 768, 256, 96}, [shorten](PolygonSoup& c, double amount, std::mt19937&) {
             shorten(c, static_cast<Eigen::Index>(amount));
           }}};
}

/// Figures 7.7 and 7.8 of the thesis, on another grid: a line for each place of the landscapes.
void landscapes(int nodes) {
  const std::vector<Way> ways = {{"signed-heat, grid", SpaceSignedHeat{}},
                                 {"signed-heat, tets", SpaceSignedHeat{}, true},
                                 {"winding", WindingSign{}},
                                 {"hopf-cole", HopfCole{}},
                                 {"planar", Planar{}},
                                 {"tori", Tori{}},
                                 {"tori, noisy", Tori{.noisy = true}}};
  const Grid grid = test::cube_grid(nodes, 1);
  std::printf("shape,damage,method,radius,amount,error\n");
  for (const bool cylinder : {true, false})
    for (const Damage& damage : damages())
      for (const double radius : {0.15, 0.3, 0.6})
        for (const double amount : damage.amounts) {
          std::mt19937 random(7);
          PolygonSoup cloud = cloud_of(cylinder, radius, 2048, random);
          damage.apply(cloud, amount, random);
          for (const Way& way : ways) {
            const double error = test::mean_error(
                grid, distance(cloud, grid, way), [cylinder, radius](const Vec3& x) {
                  return cylinder ? test::cylinder_distance(x, radius, 0.5) : x.norm() - radius;
                });
            std::printf("%s,%s,\"%s\",%g,%g,%.5f\n", cylinder ? "cylinder" : "sphere",
                        damage.name.c_str(), way.name.c_str(), radius, amount, error);
            std::fflush(stdout);
          }
        }
}

}  // namespace

int main(int count, char** words) {
  const std::string verb = count > 1 ? words[1] : "";
  if (verb == "exact") {
    exact({words + 2, words + count});
  } else if (count == 3 && verb == "landscapes" && std::atoi(words[2]) > 1) {
    landscapes(std::atoi(words[2]));
  } else {
    std::fprintf(stderr, "usage: littoral_space_accuracy exact [WORD]... | landscapes N\n");
    return 2;
  }
}
