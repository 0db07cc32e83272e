#include "spatial/places.h"

#include <algorithm>
#include <numeric>

namespace littoral {

Groups<int> points_by_place(const MatX3& points) {
  std::vector<int> order(std::size_t(points.rows()));
  std::iota(order.begin(), order.end(), 0);
  const auto before = [&](int a, int b) {
    for (int d = 0; d < 3; ++d)
      if (points(a, d) != points(b, d)) return points(a, d) < points(b, d);
    return false;
  };
  std::stable_sort(order.begin(), order.end(), before);
  std::vector<int> first(order.size());  // of the points at the place of each
  for (std::size_t i = 0; i < order.size(); ++i)
    first[order[i]] = i > 0 && !before(order[i - 1], order[i]) ? first[order[i - 1]] : order[i];
  std::vector<int> place(order.size());
  int n_places = 0;
  for (std::size_t i = 0; i < order.size(); ++i)
    place[i] = first[i] == static_cast<int>(i) ? n_places++ : place[first[i]];
  return groups_of<int>(std::size_t(n_places), [&](const auto& put) {
    for (std::size_t i = 0; i < place.size(); ++i) put(place[i], static_cast<int>(i));
  });
}

}  // namespace littoral
