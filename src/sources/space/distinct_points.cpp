#include <string>
#include <utility>
#include <vector>

#include "base/counted.h"
#include "base/index.h"
#include "littoral/error.h"
#include "sources/space/oriented_points.h"
#include "spatial/places.h"

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
  const Groups<int> places = points_by_place(cloud.points);
  std::vector<std::pair<int, Vec3>> kept;  // first point of its place, mean normal
  int cancelled = 0;
  for (std::size_t place = 0; place + 1 < places.begin.size(); ++place) {
    const auto members = places.at(static_cast<int>(place));
    Vec3 sum = Vec3::Zero();
    for (const int i : members) sum += cloud.normals.row(i).stableNormalized();
    if (sum.norm() > 1e-9 * static_cast<double>(members.size()))
      kept.emplace_back(members.front(), sum.normalized());
    else
      ++cancelled;
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
