#include <algorithm>
#include <numeric>
#include <string>
#include <vector>

#include "base/counted.h"
#include "base/index.h"
#include "littoral/error.h"
#include "sources/space/oriented_points.h"

namespace littoral {

OrientedPoints distinct_points(const OrientedPoints& cloud, Report& report) {
  const int n = cloud.size();
  if (n == 0) throw InputError("the point cloud is empty", "empty-input");
  if (cloud.normals.rows() != n)
    throw InputError("the point cloud has " + std::to_string(n) + " points but " +
                     std::to_string(cloud.normals.rows()) + " normals");
  for (int i = 0; i < n; ++i) {
    if (!cloud.points.row(i).allFinite() || !cloud.normals.row(i).allFinite())
      throw InputError("point " + std::to_string(i) + " has a coordinate that is not finite",
                       "not-finite");
    if (!(cloud.normals.row(i).stableNorm() > 0))
      throw InputError("point " + std::to_string(i) + " has no normal", "no-normals");
  }
  std::vector<int> order(n);
  std::iota(order.begin(), order.end(), 0);
  auto before = [&](int a, int b) {
    for (int d = 0; d < 3; ++d)
      if (cloud.points(a, d) != cloud.points(b, d)) return cloud.points(a, d) < cloud.points(b, d);
    return false;
  };
  std::stable_sort(order.begin(), order.end(), before);
  std::vector<std::pair<int, Vec3>> kept;  // first point of its place, sum of normals
  int cancelled = 0;
  for (int i = 0; i < n;) {
    int end = i + 1;
    Vec3 sum = cloud.normals.row(order[i]).stableNormalized();
    const int members = i;
    for (; end < n && !before(order[i], order[end]); ++end)
      sum += cloud.normals.row(order[end]).stableNormalized();
    if (sum.norm() > 1e-9 * (end - members))
      kept.emplace_back(order[i], sum.normalized());
    else
      ++cancelled;
    i = end;
  }
  if (kept.empty())
    throw InputError(
        "the normals of coincident points cancel everywhere: each point has another at its place "
        "with the reverse normal; leave one of the two out");
  if (cancelled)
    report.warn("normals-unusable",
                counted(cancelled, "place where normals of coincident points cancel was",
                        "places where normals of coincident points cancel were") +
                    " left out");
  std::sort(kept.begin(), kept.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  if (int_size(kept) < n - cancelled)
    report.warn("points-coincide",
                counted(n - cancelled - int_size(kept), "point coincides with another",
                        "points coincide with others") +
                    "; each place was used once");
  OrientedPoints out;
  out.points.resize(kept.size(), 3);
  out.normals.resize(out.points.rows(), 3);
  for (std::size_t i = 0; i < kept.size(); ++i) {
    out.points.row(i) = cloud.points.row(kept[i].first);
    out.normals.row(i) = kept[i].second;
  }
  return out;
}

}  // namespace littoral
