#include <algorithm>
#include <cmath>
#include <utility>

#include "contour/cell_surface.h"

namespace littoral::cell {

namespace {

constexpr int none = -1;

// Corners of a face counter-clockwise seen from outside, and its edges: side k joins corners k and
// k + 1.
struct Face {
  std::array<int, 4> corner, edge;
};

int edge_between(int a, int b) {
  for (int e = 0; e < 12; ++e) {
    const Edge& edge = edges()[e];
    if (edge.tail == std::min(a, b) && edge.head == std::max(a, b)) return e;
  }
  return none;
}

std::array<Face, 6> make_faces() {
  std::array<Face, 6> faces;
  for (int axis = 0; axis < 3; ++axis) {
    for (int side = 0; side < 2; ++side) {
      const int u = 1 << (axis + 1) % 3, v = 1 << (axis + 2) % 3, base = side << axis;
      Face& face = faces[2 * axis + side];
      face.corner = {base, base + u, base + u + v, base + v};
      if (side == 0) std::swap(face.corner[1], face.corner[3]);
      for (int k = 0; k < 4; ++k) {
        face.edge[k] = edge_between(face.corner[k], face.corner[(k + 1) % 4]);
      }
    }
  }
  return faces;
}

const std::array<Face, 6>& faces() {
  static const std::array<Face, 6> all = make_faces();
  return all;
}

bool is_set(unsigned bits, int k) { return (bits >> k & 1) != 0; }

// a c > b d, for numbers of any size: are the corners a and c of a square joined across b and d?
bool joined(double a, double b, double c, double d) {
  const double scale = std::max({std::abs(a), std::abs(b), std::abs(c), std::abs(d)});
  if (!(scale > 0)) return false;
  return (a / scale) * (c / scale) > (b / scale) * (d / scale);
}

void merge(std::array<int, 8>& region, int a, int b) {
  const int from = region[b], to = region[a];
  for (int& r : region) {
    if (r == from) r = to;
  }
}

// The part of [0, 1] where the line from p to q has the given sign, intersected with [low, high].
void restrict_to_sign(double p, double q, bool wants_positive, double& low, double& high) {
  const bool start = (p > 0) == wants_positive, end = (q > 0) == wants_positive;
  if (start && end) return;
  if (!start && !end) {
    high = low - 1;
    return;
  }
  const double t = p / (p - q);
  if (start) {
    high = std::min(high, t);
  } else {
    low = std::max(low, t);
  }
}

}  // namespace

const std::array<Edge, 12>& edges() {
  static const std::array<Edge, 12> all = [] {
    std::array<Edge, 12> made;
    for (int e = 0; e < 12; ++e) {
      const int axis = e / 4, u = (axis + 1) % 3, v = (axis + 2) % 3;
      const int at_u = e & 1, at_v = e >> 1 & 1;
      const int tail = at_u << u | at_v << v;
      made[e] = {tail, tail | 1 << axis, axis, 1u << (2 * u + at_u) | 1u << (2 * v + at_v)};
    }
    return made;
  }();
  return all;
}

Loops trace_loops(const std::array<double, 8>& value, unsigned positive) {
  Loops loops;
  for (int c = 0; c < 8; ++c) loops.region[c] = c;
  for (const Edge& e : edges()) {
    if (is_set(positive, e.tail) == is_set(positive, e.head)) merge(loops.region, e.tail, e.head);
  }
  std::array<int, 12> next;
  next.fill(none);
  for (const Face& face : faces()) {
    std::array<int, 4> crossed;
    int crossings = 0;
    for (int k = 0; k < 4; ++k) {
      if (is_set(positive, face.corner[k]) != is_set(positive, face.corner[(k + 1) % 4])) {
        crossed[crossings++] = k;
      }
    }
    if (crossings == 0) continue;
    // Sides alternate between leaving and entering the positive part. From a leaving side the
    // chain goes to the entering side before it (its own run of positive corners is cut off) or,
    // where positive corners are joined across the face, to the one after it.
    int step = crossings - 1;
    if (crossings == 4) {
      const auto v = [&](int k) { return value[face.corner[k]]; };
      const int p = is_set(positive, face.corner[0]) ? 0 : 1;  // a positive corner
      const bool across = joined(v(p), v(p + 1), v(p + 2), v((p + 3) % 4));
      const int from = across ? p : p + 1;
      merge(loops.region, face.corner[from], face.corner[(from + 2) % 4]);
      if (across) step = 1;
    }
    for (int i = 0; i < crossings; ++i) {
      if (!is_set(positive, face.corner[crossed[i]])) continue;
      next[face.edge[crossed[i]]] = face.edge[crossed[(i + step) % crossings]];
    }
  }
  int used = 0;
  for (int seed = 0; seed < 12; ++seed) {
    if (next[seed] == none) continue;
    for (int e = seed; next[e] != none;) {
      loops.edge[used++] = e;
      e = std::exchange(next[e], none);
    }
    loops.begin[++loops.count] = used;
  }
  return loops;
}

// The sign regions of a trilinear function, slice by slice in z: a slice is bilinear, each of its
// sign regions holds a corner of the slice, and corners a, c across from each other meet in it
// where b, d have the other sign and a c > b d. All four are linear in z, so a c - b d is quadratic
// and its greatest value on an interval is at an end or at its vertex. At an end of the interval
// where b or d vanishes the join is made on the faces; what is left is the vertex (and rounding).
std::optional<std::pair<int, int>> find_tunnel(const std::array<double, 8>& value,
                                               unsigned positive, const Loops& loops) {
  if (loops.count < 2) return std::nullopt;
  double scale = 0;
  for (double v : value) scale = std::max(scale, std::abs(v));
  if (!(scale > 0)) return std::nullopt;
  for (int diagonal = 0; diagonal < 2; ++diagonal) {
    const int a = diagonal, c = 3 - diagonal, b = 1 - diagonal, d = 2 + diagonal;
    const auto low = [&](int k) { return value[k] / scale; };
    const auto rise = [&](int k) { return value[k + 4] / scale - value[k] / scale; };
    // Q(z) = a c - b d = q0 + q1 z + q2 z^2
    const double q2 = rise(a) * rise(c) - rise(b) * rise(d);
    const double q1 = low(a) * rise(c) + rise(a) * low(c) - low(b) * rise(d) - rise(b) * low(d);
    const double q0 = low(a) * low(c) - low(b) * low(d);
    if (!(q2 < 0)) continue;
    const double z = -0.5 * q1 / q2;
    if (!(q0 + z * (q1 + z * q2) > 0)) continue;
    for (const bool sign : {false, true}) {
      double from = 0, to = 1;
      for (int k : {a, c}) restrict_to_sign(low(k), low(k) + rise(k), sign, from, to);
      for (int k : {b, d}) restrict_to_sign(low(k), low(k) + rise(k), !sign, from, to);
      if (!(from < z && z < to)) continue;
      const int end_a = is_set(positive, a) == sign ? a : a + 4;
      const int end_c = is_set(positive, c) == sign ? c : c + 4;
      const int region_a = loops.region[end_a], region_c = loops.region[end_c];
      if (region_a == region_c) continue;
      // The loops around the two regions that face a common third one.
      for (int first = 0; first < loops.count; ++first) {
        for (int second = 0; second < loops.count; ++second) {
          const Edge& e = edges()[loops.edge[loops.begin[first]]];
          const Edge& f = edges()[loops.edge[loops.begin[second]]];
          const auto ends = [&](const Edge& g) {
            const bool tail_inside = is_set(positive, g.tail) == sign;
            return std::pair(loops.region[tail_inside ? g.tail : g.head],
                             loops.region[tail_inside ? g.head : g.tail]);
          };
          if (ends(e).first == region_a && ends(f).first == region_c &&
              ends(e).second == ends(f).second) {
            return std::pair(first, second);
          }
        }
      }
    }
  }
  return std::nullopt;
}

}  // namespace littoral::cell
