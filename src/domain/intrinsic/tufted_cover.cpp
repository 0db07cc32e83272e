#include "domain/intrinsic/tufted_cover.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <deque>
#include <tuple>

#include "base/index.h"
#include "base/triangle.h"

namespace littoral {

namespace {

constexpr double margin = 1e-10;  // how far from collinear triangles stay, of their longest side
constexpr double flip_margin = -1e-9;

double flip_slack(const std::array<double, 3>& l) {
  const double longest = std::max({l[0], l[1], l[2]});
  return l[0] + l[1] + l[2] - 2 * longest - margin * longest;
}

/// A triangle at an edge i -> j with i < j.
struct Wing {
  int i, j, triangle;
  int ahead, behind;  // sides of its two faces: that which runs i -> j, and the other
  double angle = 0;   // about i -> j
};

}  // namespace

TuftedCover::TuftedCover(const MatX3& points, const MatX3i& triangles) {
  double lift = 0;
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    Face front{};
    for (int k = 0; k < 3; ++k) {
      front.v[k] = triangles(t, k);
      front.length[k] =
          (points.row(triangles(t, (k + 1) % 3)) - points.row(triangles(t, k))).norm();
    }
    lift = std::max(lift, -flip_slack(front.length));
    faces_.push_back(front);
    faces_.push_back({{front.v[0], front.v[2], front.v[1]},
                      {front.length[2], front.length[1], front.length[0]},
                      {}});
  }
  if (lift > 0)
    for (Face& f : faces_)
      for (double& l : f.length) l += lift;
  glue(points, triangles);
}

void TuftedCover::glue(const MatX3& points, const MatX3i& triangles) {
  std::vector<Wing> wings;
  for (int t = 0; t < triangles.rows(); ++t)
    for (int k = 0; k < 3; ++k) {
      const int a = triangles(t, k), b = triangles(t, (k + 1) % 3);
      const int front = 6 * t + k, back = 6 * t + 3 + 2 - k;
      wings.push_back(a < b ? Wing{a, b, t, front, back} : Wing{b, a, t, back, front});
    }
  const auto by_edge = [](const Wing& a, const Wing& b) {
    return std::tie(a.i, a.j, a.triangle) < std::tie(b.i, b.j, b.triangle);
  };
  std::sort(wings.begin(), wings.end(), by_edge);
  for (std::size_t first = 0, last = 0; first < wings.size(); first = last) {
    while (last < wings.size() && wings[last].i == wings[first].i &&
           wings[last].j == wings[first].j)
      ++last;
    if (last - first > 2) {
      const Vec3 origin = points.row(wings[first].i);
      const Vec3 axis = (points.row(wings[first].j).transpose() - origin).stableNormalized();
      const Vec3 x = axis.unitOrthogonal(), y = axis.cross(x);
      for (std::size_t w = first; w < last; ++w) {
        const auto c = triangles.row(wings[w].triangle);
        const int apex = c[0] + c[1] + c[2] - wings[w].i - wings[w].j;
        const Vec3 d = points.row(apex).transpose() - origin;
        wings[w].angle = std::atan2(y.dot(d), x.dot(d));
      }
      std::sort(wings.begin() + first, wings.begin() + last, [](const Wing& a, const Wing& b) {
        return std::tie(a.angle, a.triangle) < std::tie(b.angle, b.triangle);
      });
    }
    // The face that runs i -> j looks along growing angles: at the back of the next triangle.
    for (std::size_t w = first; w < last; ++w) {
      const int s = wings[w].ahead, t = wings[w + 1 < last ? w + 1 : first].behind;
      faces_[s / 3].twin[s % 3] = t;
      faces_[t / 3].twin[t % 3] = s;
    }
  }
}

double TuftedCover::delaunay_sum(int side) const {
  double sum = 0;
  for (int s : {side, faces_[side / 3].twin[side % 3]}) {
    const auto& l = faces_[s / 3].length;
    sum += triangle_shape(l[0], l[1], l[2], false).cot[(s % 3 + 2) % 3];
  }
  return sum;
}

bool TuftedCover::flip(int side) {
  const int twin = faces_[side / 3].twin[side % 3];
  const int f = side / 3, i = side % 3, g = twin / 3, j = twin % 3;
  if (f == g) return false;
  const Face F = faces_[f], G = faces_[g];
  const int a = F.v[i], b = F.v[(i + 1) % 3], c = F.v[(i + 2) % 3], d = G.v[(j + 2) % 3];
  if (c == d) return false;
  // Both in the plane: a at 0, b on the real axis, c above, d below.
  const double ab = F.length[i], bc = F.length[(i + 1) % 3], ca = F.length[(i + 2) % 3],
               ad = G.length[(j + 1) % 3], db = G.length[(j + 2) % 3];
  const Complex C = triangle_shape(ab, bc, ca, false).p[2],
                D = triangle_shape(ab, db, ad, true).p[2];
  const Complex DC = C - D;
  if (!((std::conj(DC) * -D).imag() > 0) || !((std::conj(DC) * (ab - D)).imag() < 0)) return false;
  const double cd = std::abs(DC);
  const std::array<double, 3> at_f{ca, ad, cd}, at_g{db, bc, cd};
  if (!(flip_slack(at_f) > 0) || !(flip_slack(at_g) > 0)) return false;

  const std::array<int, 4> before{3 * f + (i + 2) % 3, 3 * g + (j + 1) % 3, 3 * g + (j + 2) % 3,
                                  3 * f + (i + 1) % 3},
      after{3 * f, 3 * f + 1, 3 * g, 3 * g + 1};
  std::array<int, 4> outside;
  for (int q = 0; q < 4; ++q) {
    const int s = before[q], t = faces_[s / 3].twin[s % 3];
    const auto own = std::find(before.begin(), before.end(), t);  // the two may meet again
    outside[q] = own == before.end() ? t : after[own - before.begin()];
  }
  faces_[f] = {{c, a, d}, at_f, {outside[0], outside[1], 3 * g + 2}};
  faces_[g] = {{d, b, c}, at_g, {outside[2], outside[3], 3 * f + 2}};
  for (int q = 0; q < 4; ++q) faces_[outside[q] / 3].twin[outside[q] % 3] = after[q];
  return true;
}

long long TuftedCover::flip_to_delaunay(const Task& task) {
  std::deque<int> queue;
  const int n_sides = 3 * int_size(faces_);
  std::vector<char> waiting(n_sides, 0);
  auto push = [&](int side) {
    const int s = std::min(side, faces_[side / 3].twin[side % 3]);  // once for both
    if (waiting[s]) return;
    waiting[s] = 1;
    queue.push_back(s);
  };
  for (int s = 0; s < n_sides; ++s) push(s);
  const long long most = 25LL * n_sides;
  long long flips = 0;
  for (long long step = 0; !queue.empty() && flips < most; ++step) {
    if (step % 1024 == 0) task.checkpoint();
    const int s = queue.front();
    queue.pop_front();
    waiting[s] = 0;
    const int f = s / 3, g = faces_[f].twin[s % 3] / 3;
    if (!(delaunay_sum(s) < flip_margin) || !flip(s)) continue;
    ++flips;
    for (int face : {f, g})
      for (int k = 0; k < 2; ++k) push(3 * face + k);
  }
  return flips;
}

}  // namespace littoral
