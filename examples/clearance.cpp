// The clearance between two parts: how near they come, where, and whether they overlap.
// Takes two mesh files.

#include <littoral/littoral.h>

#include <cmath>
#include <iostream>
#include <limits>

using namespace littoral;

int main(int argc, char** argv) {
  if (argc < 3) return std::cerr << "usage: clearance PART PART\n", 2;
  const PolygonSoup parts[] = {read_soup(argv[1]), read_soup(argv[2])};

  // From the vertices of each part to the other: negative where a vertex is inside.
  double least = std::numeric_limits<double>::infinity();
  Vec3 here, there;
  for (const int one : {0, 1}) {
    const Sdf other = signed_distance(parts[1 - one]);
    const VecX distance = other.at(parts[one].points);
    Eigen::Index nearest;
    if (distance.minCoeff(&nearest) >= least) continue;
    least = distance[nearest];
    here = parts[one].points.row(nearest);
    there = other.closest(here.transpose()).points.row(0);
  }
  std::cout << (least > 0 ? "clearance " : "overlap ") << std::abs(least) << ", from "
            << here.transpose() << " to " << there.transpose() << "\n";
}
