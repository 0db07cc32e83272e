#include "methods/implicit/orient_soup.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "base/index.h"
#include "base/same_rows.h"
#include "methods/implicit/places_on_parts.h"
#include "spatial/boundary_edges.h"
#include "spatial/covered_triangles.h"
#include "spatial/finite_box.h"
#include "spatial/morton_order.h"

namespace littoral {

namespace {

constexpr int directions = 13;
constexpr double least_valid = 0.1;     // share of lines that pass an odd number on one side alone
constexpr double least_agreeing = 0.4;  // of these, for less against
constexpr double sure_valid = 0.3, sure_agreeing = 0.8;

/// Each set of corners once, as the first face has them, without those of fewer than three.
/// Vertices are the lowest ones of their positions.
MatX3i distinct_faces(const MatX3& points, const MatX3i& faces) {
  const std::vector<int> first = same_positions(points);
  std::vector<std::array<int, 3>> keys(faces.rows());
  for (int f = 0; f < index(keys.size()); ++f) {
    for (int k = 0; k < 3; ++k) keys[f][k] = first[faces(f, k)];
    std::sort(keys[f].begin(), keys[f].end());
  }
  std::vector<int> kept = first_of_each(keys);
  std::erase_if(kept, [&](int f) { return keys[f][0] == keys[f][1] || keys[f][1] == keys[f][2]; });
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
  std::vector<int> with_area;
  const double size = points_size(points);
  for (int f = 0; f < int(all.rows()); ++f) {
    const Vec3 a = points.row(all(f, 0)), b = points.row(all(f, 1)), c = points.row(all(f, 2));
    areas[f] = is_flat(a, b, c, size) ? 0 : (b - a).cross(c - a).norm() / 2;
    if (areas[f] > 0) with_area.push_back(f);
  }
  const double total = areas.sum();
  if (!(total > 0)) return out;
  const std::vector<Place> places = places_on_parts(points, all, areas, part);

  // Triangles one after the other lie beside each other: a few go down the tree together.
  MatX3 middles(with_area.size(), 3);
  for (Eigen::Index i = 0; i < middles.rows(); ++i) {
    const auto corners = all.row(with_area[i]);
    middles.row(i) = (points.row(corners[0]) + points.row(corners[1]) + points.row(corners[2])) / 3;
  }
  MatX3i solid(middles.rows(), 3);
  std::vector<int> solid_of(all.rows(), -1);
  int n_solid = 0;
  for (const int i : morton_order(middles)) {
    const int f = with_area[i];
    solid.row(n_solid) = all.row(f);
    solid_of[f] = n_solid++;
  }

  std::vector<Place> on_solid = places;
  for (Place& place : on_solid) place.face = solid_of[place.face];
  const PlaceTree tree(on_solid);
  // +1 behind the face is inside, -1 before it, 0 no telling.
  std::vector<std::array<signed char, directions>> votes(places.size());
  for (int d = 0; d < directions; ++d) {
    const Vec3 direction = direction_number(d);
    const std::vector<unsigned char> odd = tree.parities(points, solid, direction, task);
    for (std::size_t i = 0; i < places.size(); ++i) {
      const auto corners = all.row(places[i].face);
      const Vec3 a = points.row(corners[0]), b = points.row(corners[1]), c = points.row(corners[2]);
      const bool along = (b - a).cross(c - a).dot(direction) > 0;
      const bool one_side = odd[i] == odd_after || odd[i] == odd_before;
      const unsigned char behind = along ? odd_before : odd_after;
      votes[i][d] = static_cast<signed char>(!one_side ? 0 : odd[i] == behind ? 1 : -1);
    }
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
