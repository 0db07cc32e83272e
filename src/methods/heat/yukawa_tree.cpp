#include "methods/heat/yukawa_tree.h"

#include <algorithm>
#include <cstddef>

#include "base/index.h"
#include "spatial/cluster_tree.h"

namespace littoral {

namespace {

using Second = Eigen::Matrix<double, 6, 1>;

Second square(const Vec3& d) {
  return (Second() << d[0] * d[0], d[1] * d[1], d[2] * d[2], d[0] * d[1], d[0] * d[2], d[1] * d[2])
      .finished();
}

/// a b^T + b a^T
Second twice_symmetric(const Vec3& a, const Vec3& b) {
  return square(a + b) - square(a) - square(b);
}

/// Of a cluster, about its centre: areas and normals by area, with the powers of d.
struct Moments {
  Vec3 centre = Vec3::Zero();
  double area = 0;
  Second spread = Second::Zero();  // sum A d d^T
  Vec3 normal = Vec3::Zero();
  Eigen::Matrix3d first = Eigen::Matrix3d::Zero();
  Eigen::Matrix<double, 3, 6> second = Eigen::Matrix<double, 3, 6>::Zero();

  /// Those of a part whose centre is `part.centre`, seen from this one.
  void add(const Moments& part) {
    const Vec3 d = part.centre - centre;
    const Second dd = square(d);
    area += part.area;
    spread += part.spread + part.area * dd;
    normal += part.normal;
    first += part.first + part.normal * d.transpose();
    for (int i = 0; i < 3; ++i)
      second.row(i) += part.second.row(i) +
                       (part.normal[i] * dd + twice_symmetric(part.first.row(i), d)).transpose();
  }
};

Moments of_sample(const Vec3& place, const Vec3& normal, double area) {
  Moments m;
  m.centre = place;
  m.area = area;
  m.normal = area * normal;
  return m;
}

/// Of the parts together.
Moments together(const std::vector<Moments>& parts) {
  Moments sum;
  for (const Moments& part : parts) {
    sum.area += part.area;
    sum.centre += part.area * part.centre;
  }
  sum.centre /= sum.area;
  sum.area = 0;
  for (const Moments& part : parts) sum.add(part);
  return sum;
}

YukawaMoments rounded(const Moments& m) {
  YukawaMoments c{};
  const auto copy = [](const auto& from, float* to) {
    for (Eigen::Index i = 0; i < from.size(); ++i) to[i] = static_cast<float>(from(i));
  };
  copy(m.centre, c.centre);
  c.area = static_cast<float>(m.area);
  copy(m.spread / m.area, c.spread);
  copy(m.normal, c.normal);
  for (int i = 0; i < 3; ++i) {
    copy(m.first.row(i), c.first[i]);
    copy(m.second.row(i), c.second[i]);
  }
  return c;
}

float place(const YukawaSample& s, int axis) { return axis == 0 ? s.x : axis == 1 ? s.y : s.z; }

/// From the samples of a leaf, and from its children's.
void set_box(const YukawaTree& tree, YukawaBox& box) {
  for (int a = 0; a < 3; ++a) {
    if (box.child < 0) {
      box.low[a] = box.high[a] = place(tree.samples[box.begin], a);
      for (int i = box.begin; i < box.end; ++i) {
        box.low[a] = std::min(box.low[a], place(tree.samples[i], a));
        box.high[a] = std::max(box.high[a], place(tree.samples[i], a));
      }
    } else {
      const YukawaBox &l = tree.boxes[box.child], &r = tree.boxes[box.child + 1];
      box.low[a] = std::min(l.low[a], r.low[a]);
      box.high[a] = std::max(l.high[a], r.high[a]);
    }
  }
}

}  // namespace

YukawaTree yukawa_tree(const OrientedPoints& source, int leaf) {
  const ClusterTree groups = cluster(source.points, leaf);
  YukawaTree tree;
  tree.origin = source.points.colwise().mean().transpose();
  const double unit = source.areas.mean();
  const auto moments_of = [&](int place) {
    const int i = groups.order[place];
    return of_sample(source.points.row(i).transpose() - tree.origin, source.normals.row(i),
                     source.areas[i] / unit);
  };
  tree.samples.reserve(groups.order.size());
  for (int i = 0; i < int_size(groups.order); ++i) {
    const Moments m = moments_of(i);
    const Eigen::Vector3f p = m.centre.cast<float>(), n = m.normal.cast<float>();
    tree.samples.push_back({p[0], p[1], p[2], n[0], n[1], n[2], static_cast<float>(m.area)});
  }
  const std::size_t n = groups.clusters.size();
  tree.boxes.resize(n);
  tree.moments.resize(n);
  std::vector<Moments> moments(n), parts;
  for (std::size_t at = n; at-- > 0;) {
    const Cluster& from = groups.clusters[at];
    YukawaBox& box = tree.boxes[at];
    box.child = from.child;
    box.begin = from.begin;
    box.end = from.end;
    set_box(tree, box);
    parts.clear();
    if (box.child < 0) {
      for (int i = box.begin; i < box.end; ++i) parts.push_back(moments_of(i));
    } else {
      parts = {moments[box.child], moments[box.child + 1]};
    }
    moments[at] = together(parts);
    tree.moments[at] = rounded(moments[at]);
  }
  return tree;
}

}  // namespace littoral
