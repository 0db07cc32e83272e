#include "api/space/beside_automatic.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>

#include "base/index.h"
#include "base/option_table.h"
#include "littoral/error.h"

namespace littoral {

namespace {

constexpr int most_faces = 200'000;  // preparing the comparison takes longer than many methods
constexpr int most_nodes_beside = 512;
// On closed and on damaged meshes methods that were right differed by up to 0.13 of the mean
// distance, those that were wrong by 0.5 to 1 or in a third of what is inside.
constexpr double largest_difference = 0.25, largest_share = 0.25;
constexpr int fewest_nodes = 5;
// Of thin parts all of the inside lies next to the surface: nodes count by a quarter of the spacing
// there, if nearly all are inside by one alone.
constexpr double next_to = 0.25, almost_all_alone = 0.75;

}  // namespace

MatX3 positions(const Grid& grid, const std::vector<Eigen::Index>& nodes) {
  MatX3 at(index(nodes.size()), 3);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const Eigen::Index x = nodes[i] % grid.n[0], yz = nodes[i] / grid.n[0];
    at.row(index(i)) = grid.point(static_cast<int>(x), static_cast<int>(yz % grid.n[1]),
                                  static_cast<int>(yz / grid.n[1]));
  }
  return at;
}

std::vector<Eigen::Index> compared_nodes(const Grid& grid) {
  const auto n = index(grid.n_nodes());
  std::vector<Eigen::Index> nodes;
  if (n <= most_nodes_beside) {
    nodes.resize(std::size_t(n));
    std::iota(nodes.begin(), nodes.end(), 0);
  } else {  // multiples of the golden ratio lie in no pattern of the axes
    for (int i = 0; i < most_nodes_beside; ++i)
      nodes.push_back(index(std::fmod(i * 0.6180339887498949, 1) * static_cast<double>(n)));
  }
  return nodes;
}

bool has_automatic(const PolygonSoup& input, const SpaceRequest& request) {
  const std::string& method = request.method.name();
  return !method.empty() && method != SpaceAutomatic::method && input.n_faces() > 0 &&
         input.n_faces() <= most_faces;
}

void check_beside_automatic(const PolygonSoup& input, const Grid& grid,
                            const std::vector<Eigen::Index>& nodes, const VecX& values,
                            const SpaceRequest& request, Task task, Report& report) {
  VecX expected;
  try {
    Report spare;
    const SpaceRequest automatic{AnyMethod(SpaceAutomatic{}), request.flip,
                                 request.estimate_normals, request.values};
    expected =
        query_distance(input, positions(grid, nodes), automatic, nullptr, std::move(task), spare);
  } catch (const InputError&) {
    return;  // nothing to compare with
  } catch (const UnsupportedError&) {
    return;
  }
  double difference = 0, size = 0;
  int compared = 0, inside = 0, one_alone = 0, thin = 0, thin_alone = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const auto row = index(i);
    const double here = values[row], there = expected[row];
    const bool alone = (here < 0) != (there < 0), either = here < 0 || there < 0;
    if (!std::isfinite(here) || !(std::abs(there) > next_to * grid.spacing.maxCoeff())) continue;
    thin += either;
    thin_alone += alone;
    // Next to the surface methods differ by what they smooth.
    if (!(std::abs(there) > grid.spacing.maxCoeff())) continue;
    ++compared;
    difference += std::abs(here - there);
    size += std::abs(there);
    inside += either;
    one_alone += alone;
  }
  if (compared < fewest_nodes) return;
  report.residuals.emplace_back("mean difference from method auto", difference / size);
  bool sides = one_alone >= fewest_nodes && one_alone > largest_share * inside;
  if (!sides && thin_alone >= fewest_nodes && thin_alone > almost_all_alone * thin) {
    sides = true;
    one_alone = thin_alone;
    inside = thin;
  }
  if (!sides && !(difference > largest_difference * size)) return;
  report.warn("sign-uncertain",
              "at " + std::to_string(compared) +
                  " nodes, values differ from those of method auto by " +
                  percent_text(difference / size) + " of the distance on average" +
                  (one_alone > 0 ? ", and " + percent_text(double(one_alone) / inside) +
                                       " of the nodes inside by either are inside by one alone"
                                 : "") +
                  ". Take method auto, or orient faces consistently, leave out double ones and "
                  "close holes");
}

}  // namespace littoral
