#include "methods/implicit/orient_soup.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "base/index.h"
#include "base/parallel.h"
#include "spatial/boundary_edges.h"
#include "spatial/covered_triangles.h"
#include "spatial/finite_box.h"

namespace littoral {

namespace {

constexpr int directions = 13;
constexpr int places_in_all = 4096, places_at_least = 4;  // on parts
constexpr double least_valid = 0.1;     // share of lines that pass an odd number on one side alone
constexpr double least_agreeing = 0.4;  // of these, for less against
constexpr double sure_valid = 0.3, sure_agreeing = 0.8;

/// Triangles by where lines of one direction meet them: in bins of the plane across it, and crowded
/// bins in bins of their own.
class LineCaster {
 public:
  LineCaster(const MatX3& points, const MatX3i& faces, const Vec3& direction) : faces_(faces) {
    const Vec3 u = direction.unitOrthogonal(), v = direction.cross(u);
    Eigen::Matrix3d turn;
    turn << u.transpose(), v.transpose(), direction.transpose();
    turn_ = turn;
    points_ = points * turn.transpose();
    std::vector<int> all(faces.rows());
    std::iota(all.begin(), all.end(), 0);
    Box2 box = box_of(0);
    for (const int f : all) {
      const Box2 one = box_of(f);
      box.low = box.low.cwiseMin(one.low);
      box.high = box.high.cwiseMax(one.high);
    }
    add_bins(all, box, 0);
  }

  /// How many faces but `own` the line through x passes on the side of the direction, and before.
  std::pair<int, int> passed(const Vec3& x, int own) const {
    const Vec3 q = turn_ * x;
    const Bins* bins = bins_.data();
    std::size_t bin = bins->at(q.head<2>());
    while (bins->finer[bin] >= 0) {
      bins = &bins_[bins->finer[bin]];
      bin = bins->at(q.head<2>());
    }
    int after = 0, before = 0;
    for (std::size_t k = bins->begin[bin]; k < bins->begin[bin + 1]; ++k) {
      const int f = bins->faces[k];
      if (f == own) continue;
      std::array<Vec3, 3> p;
      for (int c = 0; c < 3; ++c) p[c] = points_.row(faces_(f, c)).transpose() - q;
      const auto cross = [](const Vec3& a, const Vec3& b) { return a[0] * b[1] - a[1] * b[0]; };
      const double a = cross(p[1], p[2]), b = cross(p[2], p[0]), c = cross(p[0], p[1]);
      if ((a >= 0) != (b >= 0) || (b >= 0) != (c >= 0)) continue;
      const double area = a + b + c;
      if (area == 0) continue;
      const double height = (a * p[0][2] + b * p[1][2] + c * p[2][2]) / area;
      ++(height > 0 ? after : before);
    }
    return {after, before};
  }

 private:
  static constexpr std::size_t crowded = 256;  // faces of a bin
  static constexpr int deepest = 12;
  static constexpr double faces_a_finer_bin = 16;  // on average
  static constexpr double most_copies = 2;         // of a face in finer bins, on average
  static constexpr double most_in_all = 20;        // of all faces

  struct Box2 {
    Vec2 low, high;
  };
  struct Bins {
    Vec2 low;
    double cell = 1;
    int n = 1;                       // a side
    std::vector<std::size_t> begin;  // of each bin's faces
    std::vector<int> faces, finer;   // bins of a bin, or -1

    Eigen::Array2i place(const Vec2& p) const {
      return (((p - low) / cell).array().floor().max(0).min(n - 1)).cast<int>();
    }
    std::size_t at(const Vec2& p) const {
      const Eigen::Array2i i = place(p);
      return std::size_t(i[1]) * n + i[0];
    }
  };

  Box2 box_of(int f) const {
    Box2 box{points_.row(faces_(f, 0)).head<2>(), points_.row(faces_(f, 0)).head<2>()};
    for (int c = 1; c < 3; ++c) {
      box.low = box.low.cwiseMin(points_.row(faces_(f, c)).head<2>().transpose());
      box.high = box.high.cwiseMax(points_.row(faces_(f, c)).head<2>().transpose());
    }
    return box;
  }

  /// Bins of the faces that reach a part of the plane. Returns their number, or -1 where finer bins
  /// would each have most of the faces again.
  int add_bins(std::span<const int> faces, const Box2& part, int depth) {
    Bins bins;
    bins.low = part.low;
    const double share = depth == 0 ? 1 : faces_a_finer_bin;
    bins.n = std::clamp(static_cast<int>(std::sqrt(double(faces.size()) / share)), 1, 512);
    bins.cell = std::max((part.high - part.low).maxCoeff() / bins.n, 1e-300);
    const auto range = [&](int f) {
      const Box2 one = box_of(f);
      return std::pair(bins.place(one.low), bins.place(one.high));
    };
    if (depth > 0) {
      const double most = std::min(most_copies * static_cast<double>(faces.size()),
                                   most_in_all * static_cast<double>(faces_.rows()) - stored_);
      double copies = 0;
      for (const int f : faces) {
        const auto [from, to] = range(f);
        copies += (to - from + 1).prod();
        if (copies > most) return -1;
      }
      stored_ += copies;
    }
    bins.begin.assign(std::size_t(bins.n) * bins.n + 1, 0);
    bins.finer.assign(bins.begin.size() - 1, -1);
    const auto for_bins = [&](int f, const auto& visit) {
      const auto [from, to] = range(f);
      for (int j = from[1]; j <= to[1]; ++j)
        for (int i = from[0]; i <= to[0]; ++i) visit(std::size_t(j) * bins.n + i);
    };
    for (const int f : faces) for_bins(f, [&](std::size_t bin) { ++bins.begin[bin + 1]; });
    std::partial_sum(bins.begin.begin(), bins.begin.end(), bins.begin.begin());
    bins.faces.resize(bins.begin.back());
    std::vector<std::size_t> end(bins.begin.begin(), bins.begin.end() - 1);
    for (const int f : faces) for_bins(f, [&](std::size_t bin) { bins.faces[end[bin]++] = f; });

    const int at = int_size(bins_);
    bins_.push_back(std::move(bins));
    for (std::size_t bin = 0; bin < end.size() && depth < deepest; ++bin) {
      const Bins& these = bins_[at];
      const std::size_t count = these.begin[bin + 1] - these.begin[bin];
      if (count <= crowded) continue;
      const std::span<const int> inside(these.faces.data() + these.begin[bin], count);
      const Vec2 low = these.low + these.cell * Vec2(static_cast<double>(bin % these.n),
                                                     static_cast<double>(bin / these.n));
      const Box2 square{low, low.array() + these.cell};
      const int finer = add_bins(inside, square, depth + 1);
      bins_[at].finer[bin] = finer;
    }
    return at;
  }

  const MatX3i& faces_;
  Eigen::Matrix3d turn_;
  MatX3 points_;  // the direction is the third axis
  std::vector<Bins> bins_;
  double stored_ = 0;  // in finer bins
};

/// Each set of corners once, as the first face has them, without those of fewer than three.
/// Vertices are the lowest ones of their positions.
MatX3i distinct_faces(const MatX3& points, const MatX3i& faces) {
  const std::vector<int> first = same_positions(points);
  std::vector<std::pair<std::array<int, 3>, int>> keys;
  for (int f = 0; f < faces.rows(); ++f) {
    std::array<int, 3> key;
    for (int k = 0; k < 3; ++k) key[k] = first[faces(f, k)];
    std::sort(key.begin(), key.end());
    if (key[0] != key[1] && key[1] != key[2]) keys.emplace_back(key, f);
  }
  std::sort(keys.begin(), keys.end());
  std::vector<int> kept;
  for (std::size_t i = 0; i < keys.size(); ++i)
    if (i == 0 || keys[i].first != keys[i - 1].first) kept.push_back(keys[i].second);
  std::sort(kept.begin(), kept.end());
  MatX3i out(kept.size(), 3);
  for (std::size_t i = 0; i < kept.size(); ++i)
    for (int k = 0; k < 3; ++k) out(index(i), k) = first[faces(kept[i], k)];
  return out;
}

/// Numbers of the parts; faces are turned to agree with the first one of theirs.
std::vector<int> agreeing_parts(MatX3i& faces, std::vector<char>& turned) {
  struct Side {
    std::pair<int, int> ends;
    int face;
    bool forward;
  };
  std::vector<Side> sides;
  for (int f = 0; f < faces.rows(); ++f)
    for (int k = 0; k < 3; ++k) {
      const int a = faces(f, k), b = faces(f, (k + 1) % 3);
      sides.push_back({std::minmax({a, b}), f, a < b});
    }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return a.ends < b.ends || (a.ends == b.ends && a.face < b.face);
  });
  struct Neighbour {
    int face;
    bool agrees;
  };
  std::vector<std::vector<Neighbour>> next(faces.rows());
  for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    while (end < sides.size() && sides[end].ends == sides[begin].ends) ++end;
    if (end - begin != 2) continue;
    const Side &a = sides[begin], &b = sides[begin + 1];
    next[a.face].push_back({b.face, a.forward != b.forward});
    next[b.face].push_back({a.face, a.forward != b.forward});
  }
  std::vector<int> part(faces.rows(), -1), stack;
  turned.assign(faces.rows(), 0);
  int parts = 0;
  for (int start = 0; start < faces.rows(); ++start) {
    if (part[start] >= 0) continue;
    part[start] = parts;
    stack.push_back(start);
    while (!stack.empty()) {
      const int f = stack.back();
      stack.pop_back();
      for (const Neighbour& n : next[f]) {
        if (part[n.face] >= 0) continue;
        part[n.face] = parts;
        turned[n.face] = static_cast<char>((turned[f] != 0) == n.agrees);
        stack.push_back(n.face);
      }
    }
    ++parts;
  }
  for (int f = 0; f < faces.rows(); ++f)
    if (turned[f] != 0) std::swap(faces(f, 1), faces(f, 2));
  return part;
}

struct Place {
  int face;
  Vec3 x;
};

/// Places spread evenly over each part, more on large ones.
std::vector<Place> places_on(const MatX3& points, const MatX3i& faces, const VecX& areas,
                             const std::vector<int>& part) {
  std::map<int, std::vector<int>> members;
  for (int f = 0; f < faces.rows(); ++f) members[part[f]].push_back(f);
  std::vector<Place> out;
  const double total = areas.sum();
  for (const auto& [number, all] : members) {
    double area = 0;
    for (const int f : all) area += areas[f];
    if (!(area > 0)) continue;
    const int n =
        std::max(places_at_least, static_cast<int>(std::lround(places_in_all * area / total)));
    std::size_t at = 0;
    double sum = areas[all[0]];
    for (int i = 0; i < n; ++i) {
      while (sum < (i + 0.5) / n * area && at + 1 < all.size()) sum += areas[all[++at]];
      double u = std::fmod(0.5 + 0.7548776662466927 * i, 1.0),
             v = std::fmod(0.5 + 0.5698402909980532 * i, 1.0);
      if (u + v > 1) u = 1 - u, v = 1 - v;
      const auto face = faces.row(all[at]);
      out.push_back({all[at], (1 - u - v) * points.row(face[0]) + u * points.row(face[1]) +
                                  v * points.row(face[2])});
    }
  }
  return out;
}

/// Even over the half sphere and along no axis (a spiral of golden angles).
Vec3 direction_number(int d) {
  const double z = (d + 0.5) / directions, turn = 2.399963229728653 * d + 0.7;
  const double r = std::sqrt(1 - z * z);
  return {r * std::cos(turn), r * std::sin(turn), z};
}

}  // namespace

OrientedSoup orient_soup(const MatX3& points, const MatX3i& faces, const Task& task) {
  MatX3i all = distinct_faces(points, faces);
  OrientedSoup out;
  std::vector<char> turned;
  const std::vector<int> part = agreeing_parts(all, turned);
  // Faces without area but for rounding join others, and lines do not tell their sides.
  VecX areas(all.rows());
  MatX3i solid(all.rows(), 3);
  std::vector<int> solid_of(all.rows(), -1);
  int n_solid = 0;
  const double size = points_size(points);
  for (int f = 0; f < int_size(solid_of); ++f) {
    const Vec3 a = points.row(all(f, 0)), b = points.row(all(f, 1)), c = points.row(all(f, 2));
    areas[f] = is_flat(a, b, c, size) ? 0 : (b - a).cross(c - a).norm() / 2;
    if (!(areas[f] > 0)) continue;
    solid.row(n_solid) = all.row(f);
    solid_of[f] = n_solid++;
  }
  solid.conservativeResize(n_solid, 3);
  const double total = areas.sum();
  if (!(total > 0)) return out;
  const std::vector<Place> places = places_on(points, all, areas, part);

  // +1 behind the face is inside, -1 before it, 0 no telling.
  std::vector<std::array<signed char, directions>> votes(places.size());
  for (int d = 0; d < directions; ++d) {
    const Vec3 direction = direction_number(d);
    const LineCaster lines(points, solid, direction);
    parallel_for(places.size(), 256, [&](std::size_t begin, std::size_t end) {
      task.checkpoint();
      for (std::size_t i = begin; i < end; ++i) {
        const auto corners = all.row(places[i].face);
        const Vec3 a = points.row(corners[0]), b = points.row(corners[1]),
                   c = points.row(corners[2]);
        const bool along = (b - a).cross(c - a).dot(direction) > 0;
        auto [front, behind] = lines.passed(places[i].x, solid_of[places[i].face]);
        if (!along) std::swap(front, behind);
        votes[i][d] = static_cast<signed char>((front + behind) % 2 == 0 ? 0 : behind % 2 * 2 - 1);
      }
    });
  }
  struct Count {
    double plus = 0, minus = 0, none = 0;
  };
  std::vector<Count> counts(1 + *std::max_element(part.begin(), part.end()));
  for (std::size_t i = 0; i < places.size(); ++i)
    for (const signed char vote : votes[i]) {
      Count& count = counts[part[places[i].face]];
      ++(vote > 0 ? count.plus : vote < 0 ? count.minus : count.none);
    }

  MatX3i kept(all.rows(), 3);
  Eigen::Index n = 0;
  double bounding = 0;
  for (Eigen::Index f = 0; f < all.rows(); ++f) {
    const Count& count = counts[part[f]];
    const double valid = count.plus + count.minus, lines = valid + count.none;
    const double agreement = valid > 0 ? std::abs(count.plus - count.minus) / valid : 0;
    if (valid < least_valid * lines || agreement < least_agreeing || !(lines > 0)) {
      out.left_out += areas[f] / total;
      continue;
    }
    kept.row(n) = all.row(f);
    const bool turn = count.minus > count.plus;
    if (turn) std::swap(kept(n, 1), kept(n, 2));
    if (turn != (turned[f] != 0)) {
      out.turned += areas[f] / total;
      if (valid > sure_valid * lines && agreement > sure_agreeing)
        out.surely_turned += areas[f] / total;
    }
    ++n;
    bounding += areas[f];
    out.certainty += agreement * areas[f];
  }
  if (bounding > 0) out.certainty /= bounding;
  out.faces = kept.topRows(n);
  return out;
}

}  // namespace littoral
