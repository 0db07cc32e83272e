// Repeated solves through the public header beside the same steps built by hand: what the front
// door costs. Answers are compared first; rounds are interleaved; medians.
//
// usage: littoral_front_door MESH [ROUNDS]    prints Markdown

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <memory>

#include "domain/intrinsic/intrinsic_triangulation.h"
#include "domain/mesh/surface_mesh.h"
#include "littoral/littoral.h"
#include "methods/geodesic/exact_polyhedral.h"
#include "methods/heat/signed_heat.h"
#include "methods/heat/unsigned_heat.h"
#include "operators/triangles.h"
#include "sources/surface/triangle_sources.h"
#include "sources/systems/triangle_source_system.h"

using namespace littoral;

namespace {

double seconds_of(const std::function<void()>& run) {
  const auto start = std::chrono::steady_clock::now();
  run();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<long>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

using Solve = std::function<VecX(const Sources&)>;

struct Case {
  std::string name;
  Solve by_hand, through_the_door;
};

void compare(const Case& c, const std::vector<Sources>& sources, int rounds) {
  double difference = 0, largest = 0;
  for (const Sources& s : sources) {
    const VecX a = c.by_hand(s), b = c.through_the_door(s);
    difference = std::max(difference, (a - b).cwiseAbs().maxCoeff());
    largest = std::max(largest, a.cwiseAbs().maxCoeff());
  }
  std::vector<double> hand, door;
  for (int i = 0; i < rounds; ++i)
    for (const Sources& s : sources) {
      hand.push_back(seconds_of([&] { c.by_hand(s); }));
      door.push_back(seconds_of([&] { c.through_the_door(s); }));
    }
  std::cout << "| " << c.name << " | " << difference / largest << " | " << median(hand) << " | "
            << median(door) << " | " << median(door) / median(hand) << " |\n";
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return std::cerr << "usage: littoral_front_door MESH [ROUNDS]\n", 2;
  const int rounds = argc > 2 ? std::atoi(argv[2]) : 7;
  const Mesh mesh = read_mesh(argv[1]);
  const SurfaceMesh by_hand(mesh.soup());
  Report report;
  const auto T =
      std::make_shared<const IntrinsicTriangulation>(intrinsic_triangulation(by_hand, report));
  const auto ops = std::make_shared<const Operators>(triangle_operators(T));
  const auto placed = [&](const Sources& s) { return place_sources(by_hand, s, report); };

  const SignedHeat curve_options{.time_scale = 1};
  const SignedHeatSolver heat(ops, 1, {}, {true, false});
  const DistanceSolver curve_solver(mesh, curve_options);
  const UnsignedHeat point_options{.time_scale = 1};
  const UnsignedHeatSolver points(ops, point_options);
  const DistanceSolver point_solver(mesh, point_options);
  const DistanceSolver exact_solver(mesh, Exact{});

  std::vector<Sources> point_sources, curve_sources;
  const int n = mesh.n_vertices();
  for (int i = 0; i < 3; ++i) {
    point_sources.emplace_back(SurfacePoint::at_vertex(i * (n / 3)));
    curve_sources.push_back(Sources().add(
        Curve::along_vertices({i * (n / 4), i * (n / 4) + n / 5, i * (n / 4) + n / 7})));
  }
  std::cout << "| method, " << mesh.n_faces()
            << " faces | difference / largest | by hand [s] | public header [s] | ratio |\n"
            << "|---|---|---|---|---|\n";
  compare({"signed heat, a curve",
           [&](const Sources& s) {
             return heat.solve(source_system(by_hand, *T, placed(s)), curve_options, {}, report);
           },
           [&](const Sources& s) { return curve_solver.solve(s).values; }},
          curve_sources, rounds);
  compare({"unsigned heat, a point",
           [&](const Sources& s) {
             return points.solve(source_system(by_hand, *T, placed(s)), {}, report);
           },
           [&](const Sources& s) { return point_solver.solve(s).values; }},
          point_sources, rounds);
  compare(
      {"exact, a point",
       [&](const Sources& s) {
         return exact_polyhedral(*T, triangle_sources(by_hand, *T, placed(s)), {}, report).distance;
       },
       [&](const Sources& s) { return exact_solver.solve(s).values; }},
      point_sources, rounds);
}
