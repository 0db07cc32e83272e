// The same shape as triangles, polygons, points and voxels: errors of distance against exact values
// and their orders in the spacing. Prints Markdown.

#include <cmath>
#include <cstdio>
#include <functional>
#include <string>

#include "domain_shapes.h"

namespace littoral {
namespace {

using test::Domain;
const double pi = std::acos(-1.0);

/// A closed circle about the z axis, positive to its upper side where it runs counter-clockwise.
void add_circle(Sources& sources, double radius, double z, bool reversed) {
  constexpr int n = 400;
  SpaceCurve circle;
  circle.points.resize(n + 1, 3);
  for (int i = 0; i <= n; ++i) {
    const double u = (reversed ? -2 : 2) * pi * (i % n) / n;
    circle.points.row(i) << radius * std::cos(u), radius * std::sin(u), z;
  }
  sources.space_curves.push_back(circle);
}

struct Case {
  std::string name;
  std::function<test::Shape(Domain, int)> shape;
  bool point;  // at the top of the shape
  std::function<double(const Vec3&)> exact;
  double range;
};

struct Error {
  int nodes;
  double mean, largest;
};

Error error(const Case& c, Domain domain, int n) {
  const test::Shape shape = c.shape(domain, n);
  const bool sphere = c.name.front() == 's';
  Sources sources;
  Vec3 top = Vec3::UnitZ();
  if (c.point) {
    Eigen::Index v = 0;
    shape.soup.points.col(2).maxCoeff(&v);
    top = shape.soup.points.row(v).normalized();
    sources.points.push_back(SurfacePoint::at_vertex(static_cast<int>(v)));
  } else if (sphere) {
    add_circle(sources, std::sin(pi / 3), std::cos(pi / 3), false);
  } else {
    add_circle(sources, 1, 0.4, false);
    add_circle(sources, 1, -0.4, true);
  }
  const VecX phi = shape.distance(sources, "signed-heat");
  Error out{shape.soup.n_vertices(), 0, 0};
  for (int v = 0; v < out.nodes; ++v) {
    const Vec3 p = shape.soup.points.row(v);
    const double exact = c.point ? std::atan2(p.cross(top).norm(), p.dot(top)) : c.exact(p);
    const double e = std::abs(phi[v] - exact) / c.range;
    out.mean += e / out.nodes;
    out.largest = std::max(out.largest, e);
  }
  return out;
}

void print(const Case& c) {
  constexpr Domain domains[] = {Domain::triangles, Domain::polygons, Domain::points,
                                Domain::voxels};
  constexpr int levels = 4;
  Error first[4], last[4];
  for (int l = 0; l < levels; ++l) {
    std::printf("| %s |", c.name.c_str());
    for (int d = 0; d < 4; ++d) {
      const Error e = error(c, domains[d], 12 << l);
      std::printf(" %d: %.3g / %.2g |", e.nodes, 100 * e.mean, 100 * e.largest);
      std::fflush(stdout);
      if (l == 0) first[d] = e;
      last[d] = e;
    }
    std::printf("\n");
  }
  std::printf("| order, mean / largest |");
  for (int d = 0; d < 4; ++d) {
    const double halvings = 0.5 * std::log2(double(last[d].nodes) / first[d].nodes);
    std::printf(" %.1f / %.1f |", std::log2(first[d].mean / last[d].mean) / halvings,
                std::log2(first[d].largest / last[d].largest) / halvings);
  }
  std::printf("\n");
}

}  // namespace
}  // namespace littoral

int main() {
  using namespace littoral;
  std::printf(
      "| shape and source | triangles | polygons | points | voxels |\n|---|---|---|---|---|\n");
  print({"sphere, circle", test::sphere, false,
         [](const Vec3& p) { return pi / 3 - std::atan2(std::hypot(p.x(), p.y()), p.z()); }, pi});
  print({"sphere, point", test::sphere, true, nullptr, pi});
  print({"torus, two circles", test::torus, false,
         [](const Vec3& p) {
           return 0.4 * (std::abs(std::atan2(p.z(), std::hypot(p.x(), p.y()) - 1)) - pi / 2);
         },
         0.2 * pi});
  return 0;
}
