// The clearance between two parts: how near they come, where, and whether they overlap.
// Takes two mesh files. Distances are taken at points at most a hundredth of the larger part's size
// apart, so the answer is at most that much too large.

#include <littoral/littoral.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <vector>

using namespace littoral;

// Points on all faces of a part, its vertices among them, at most `spacing` apart.
MatX3 spread(const PolygonSoup& part, double spacing) {
  std::vector<Vec3> points;
  for (int f = 0; f < part.n_faces(); ++f) {
    const auto corners = part.face(f);
    for (std::size_t k = 1; k + 1 < corners.size(); ++k) {
      const Vec3 a = part.points.row(corners[0]), b = part.points.row(corners[k]),
                 c = part.points.row(corners[k + 1]);
      const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
      const int n = std::max(1, static_cast<int>(std::ceil(longest / spacing)));
      for (int i = 0; i <= n; ++i)
        for (int j = 0; i + j <= n; ++j)
          points.push_back(a + (double(i) / n) * (b - a) + (double(j) / n) * (c - a));
    }
  }
  MatX3 rows(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i)
    rows.row(static_cast<Eigen::Index>(i)) = points[i];
  return rows;
}

int main(int argc, char** argv) {
  if (argc < 3) return std::cerr << "usage: clearance PART PART\n", 2;
  const PolygonSoup parts[] = {read_soup(argv[1]), read_soup(argv[2])};
  double size = 0;
  for (const PolygonSoup& part : parts)
    size = std::max(
        size, (part.points.colwise().maxCoeff() - part.points.colwise().minCoeff()).maxCoeff());

  // From points of each part to the other: negative where a point is inside.
  double least = std::numeric_limits<double>::infinity();
  Vec3 here, there;
  for (const int one : {0, 1}) {
    const Sdf other = signed_distance(parts[1 - one]);
    const MatX3 points = spread(parts[one], size / 100);
    const VecX distance = other.at(points);
    Eigen::Index nearest;
    if (distance.minCoeff(&nearest) >= least) continue;
    least = distance[nearest];
    here = points.row(nearest);
    there = other.closest(here.transpose()).points.row(0);
  }
  std::cout << (least > 0 ? "clearance " : "overlap ") << std::abs(least) << ", from "
            << here.transpose() << " to " << there.transpose() << "\n";
}
