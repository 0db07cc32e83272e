#include "methods/geodesic/tet_paths_taut.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

namespace littoral {

namespace {

constexpr double no_gain = 1 - 1e-12;  // what gains less is no gain
constexpr double near_end = 1e-10;     // of an edge: a turn there is at its end
constexpr double on_side = 1e-9;       // of a triangle's height: what is nearer lies on its side
constexpr double downhill = 1e-9;      // the cosine of a direction worth going
constexpr double a_bit = 1e-2;         // of a part of a way: what is so near a turn
constexpr int rounds = 100;
constexpr int quarterings = 5;

double from_to(const Vec3& a, const Vec3& b) { return (a - b).norm(); }

EdgeTurn turn_at(int a, int b, double t) {
  return {a, b, t < near_end ? 0 : t > 1 - near_end ? 1 : t};
}

/// A triangle and the directions in which tets are told from it.
class Swept {
 public:
  Swept(const Vec3& p, const Vec3& c, const Vec3& q) : corners_{p, c, q} {
    const Vec3 normal = (c - p).cross(q - p);
    area_ = normal.norm();
    axes_[0] = normal / area_;
    for (std::size_t k = 0; k < 3; ++k)
      axes_[k + 1] = axes_[0].cross(corners_[(k + 1) % 3] - corners_[k]).normalized();
    size_ = std::max({from_to(p, c), from_to(c, q), from_to(p, q)});
    const Vec3 u = c - p, v = q - p;
    to_c_ = v.cross(axes_[0]) / u.dot(v.cross(axes_[0]));
    to_q_ = u.cross(axes_[0]) / v.dot(u.cross(axes_[0]));
  }

  bool is_flat() const { return !(area_ > on_side * size_ * size_); }

  /// How far x is above its plane, and its barycentric coordinates at c and q.
  double above(const Vec3& x) const { return axes_[0].dot(x - corners_[0]); }
  double at_c(const Vec3& x) const { return to_c_.dot(x - corners_[0]); }
  double at_q(const Vec3& x) const { return to_q_.dot(x - corners_[0]); }
  double size() const { return size_; }

  /// Whether it may meet a tet: surely not, where a direction tells them apart.
  bool meets(const std::array<Vec3, 4>& tet) const {
    for (const Vec3& axis : axes_)
      if (tells_apart(axis, tet)) return false;
    for (std::size_t k = 0; k < 4; ++k) {
      const Vec3 &a = tet[k], &b = tet[(k + 1) % 4], &c = tet[(k + 2) % 4];
      if (tells_apart((b - a).cross(c - a), tet)) return false;
    }
    return true;
  }

 private:
  bool tells_apart(const Vec3& axis, const std::array<Vec3, 4>& tet) const {
    const auto range = [&](const auto& of) {
      std::pair<double, double> out{axis.dot(of[0]), axis.dot(of[0])};
      for (const Vec3& x : of) {
        out.first = std::min(out.first, axis.dot(x));
        out.second = std::max(out.second, axis.dot(x));
      }
      return out;
    };
    const auto [low, high] = range(corners_);
    const auto [from, to] = range(tet);
    const double slack = on_side * size_ * axis.norm();
    return low > to + slack || from > high + slack;
  }

  std::array<Vec3, 3> corners_;
  std::array<Vec3, 4> axes_;
  Vec3 to_c_, to_q_;
  double area_ = 0, size_ = 0;
};

}  // namespace

TautInTets::TautInTets(const TetMesh& mesh, const TetSight& sight,
                       const std::vector<std::vector<int>>& reentrant, const SourceFoot& foot)
    : mesh_(mesh),
      sight_(sight),
      reentrant_(reentrant),
      foot_(foot),
      seen_(std::size_t(mesh.n_tets()), 0) {}

void TautInTets::pull(WayInTets& way, int vertex) {
  const auto length_of = [](const Nodes& nodes) {
    double length = 0;
    for (std::size_t i = 1; i < nodes.size(); ++i) length += from_to(nodes[i - 1].at, nodes[i].at);
    return length;
  };
  Nodes nodes{{way.start, {way.from, way.from}}};
  for (const EdgeTurn& turn : way.turns) nodes.push_back(node(turn));
  nodes.push_back(node({vertex, vertex}));
  way.length = length_of(nodes);
  for (int i = 0; i < rounds; ++i) {
    for (std::size_t k = 1; k + 1 < nodes.size();)
      k = drop(nodes, k) ? std::max<std::size_t>(1, k - 1) : k + 1;
    if (way.from < 0) start_nearer(way, nodes);
    turn_onto_edges(nodes);
    const double before = length_of(nodes);
    const Nodes taut = taut_places(way.face, nodes);
    double share = length_of(taut) < no_gain * before ? 1 : 0;
    for (int k = 0; k < quarterings && share > 0; ++k, share /= 4)
      if (Nodes nearer = moved(nodes, taut, share); length_of(nearer) < no_gain * before) {
        nodes = std::move(nearer);
        break;
      }
    if (!(length_of(nodes) < no_gain * way.length)) pass_corners(nodes);
    const double length = length_of(nodes);
    const bool is_last = !(length < no_gain * way.length);
    way.length = length;
    if (is_last) break;
  }
  way.start = nodes.front().at;
  way.turns.clear();
  for (std::size_t k = 1; k + 1 < nodes.size(); ++k) way.turns.push_back(nodes[k].turn);
}

bool TautInTets::sees(const Node& from, const Node& to) {
  if (from.turn.a < 0 && to.turn.a < 0) return true;  // within a face of the source
  if (from.turn.a < 0) return sees(to, from);
  TetSight::Aim aim{to.turn.a, to.turn.b};
  if (to.turn.a >= 0 && to.turn.at_end()) aim = {to.turn.end(), -1};
  if (from.turn.at_end()) return sight_.sees(from.turn.end(), to.at, walk_, aim);
  return sight_.sees(from.turn.a, from.turn.b, from.at, to.at, walk_, aim);
}

/// What lies between p and q on the shortest way in the triangle p, c, q, where the way by c is
/// free; none if it cannot be found.
std::optional<TautInTets::Nodes> TautInTets::round(const Node& p, const Node& c, const Node& q) {
  if (sees(p, q)) return Nodes{};
  Nodes between = edges_in(p, c, q);
  if (between.empty()) return {};
  for (std::size_t i = 0; i <= between.size(); ++i)
    if (!sees(i > 0 ? between[i - 1] : p, i < between.size() ? between[i] : q)) return {};
  return between;
}

void TautInTets::open_tets(const Node& at) {
  const EdgeTurn& turn = at.turn;
  if (turn.a < 0) return;
  for (const int t : sight_.tets_at(turn.at_end() ? turn.end() : turn.a)) {
    unsigned& seen = seen_[t];
    if (seen == stamp_ || (!turn.at_end() && !(mesh_.tets.row(t).array() == turn.b).any()))
      continue;
    seen = stamp_;
    open_.push_back(t);
  }
}

/// Where the way from p to q turns that is pulled taut in the triangle from its corner c.
TautInTets::Nodes TautInTets::edges_in(const Node& p, const Node& c, const Node& q) {
  const Swept triangle(p.at, c.at, q.at);
  if (triangle.is_flat()) return {};
  struct Crossing {
    double along, height;
    EdgeTurn turn;
  };
  std::vector<Crossing> found;
  const auto add = [&](int a, int b, double t) {
    const EdgeTurn turn = turn_at(a, b, t);
    const Vec3 x = place_of(mesh_.points, turn);
    const double at_c = triangle.at_c(x), at_q = triangle.at_q(x);
    if (at_c < on_side || at_c > 1 - on_side || at_q < -on_side || at_c + at_q > 1 + on_side)
      return;
    found.push_back({at_q + at_c / 2, at_c, turn});
  };
  if (++stamp_ == 0) {
    std::fill(seen_.begin(), seen_.end(), 0);
    stamp_ = 1;
  }
  open_.clear();
  for (const Node* at : {&p, &c, &q}) open_tets(*at);
  while (!open_.empty()) {
    const int t = open_.back();
    open_.pop_back();
    std::array<Vec3, 4> corners;
    for (std::size_t k = 0; k < 4; ++k) corners[k] = point(mesh_.tets(t, static_cast<int>(k)));
    if (!triangle.meets(corners)) continue;
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) {
        const int a = mesh_.tets(t, i), b = mesh_.tets(t, j);
        const std::vector<int>& ends = reentrant_[a];
        if (a >= b || !std::binary_search(ends.begin(), ends.end(), b)) continue;
        const double nothing = on_side * triangle.size();
        double above_a = triangle.above(point(a)), above_b = triangle.above(point(b));
        if (std::abs(above_a) < nothing) add(a, b, 0);
        if (std::abs(above_b) < nothing) add(a, b, 1);
        if ((above_a < -nothing && above_b > nothing) || (above_a > nothing && above_b < -nothing))
          add(a, b, above_a / (above_a - above_b));
      }
    for (int k = 0; k < 4; ++k)
      for (const int next : sight_.tets_of_face(t, k))
        if (unsigned& seen = seen_[next]; seen != stamp_) {
          seen = stamp_;
          open_.push_back(next);
        }
  }
  // The convex hull of p, q and the crossings, above the side from p to q.
  std::sort(found.begin(), found.end(), [](const Crossing& a, const Crossing& b) {
    return std::pair(a.along, a.height) < std::pair(b.along, b.height);
  });
  std::vector<Crossing> hull{{0, 0, {-1, -1}}};
  found.push_back({1, 0, {-1, -1}});
  for (const Crossing& x : found) {
    while (hull.size() > 1) {
      const Crossing &a = hull[hull.size() - 2], &b = hull.back();
      if ((b.along - a.along) * (x.height - a.height) -
              (x.along - a.along) * (b.height - a.height) <
          0)
        break;
      hull.pop_back();
    }
    hull.push_back(x);
  }
  Nodes out;
  for (std::size_t i = 1; i + 1 < hull.size(); ++i) out.push_back(node(hull[i].turn));
  return out;
}

/// Whether what lies between the parts of a way at c is outside of the tets, right at c.
bool TautInTets::is_needed(const Node& p, const Node& c, const Node& q) {
  const Vec3 to_p = p.at - c.at, to_q = q.at - c.at;
  const Vec3 between = to_p.normalized() + to_q.normalized();
  if (!(between.norm() > downhill)) return false;
  const double step = a_bit * std::min(to_p.norm(), to_q.norm());
  return !sees(c, {c.at + step * between.normalized(), {-1, -1}});
}

/// Takes node i out, or puts nearer ones in its place; not where it is needed.
bool TautInTets::drop(Nodes& way, std::size_t i) {
  return !is_needed(way[i - 1], way[i], way[i + 1]) && replace(way, i, way[i]);
}

/// Where a way turns at a vertex, round the edges there on one side of it or the other.
void TautInTets::pass_corners(Nodes& way) {
  for (std::size_t i = 1; i + 1 < way.size(); ++i) {
    if (!way[i].turn.at_end()) continue;
    const Vec3 to_p = way[i - 1].at - way[i].at, to_q = way[i + 1].at - way[i].at;
    const double step = a_bit * std::min(to_p.norm(), to_q.norm());
    const Vec3 out = -(to_p.normalized() + to_q.normalized()).normalized();
    const Vec3 aside = to_p.cross(to_q).normalized();
    for (const double side : {1.0, -1.0})
      if (replace(way, i, {way[i].at + step * (out + side * aside), way[i].turn})) break;
  }
}

/// Puts nodes in the place of node i that make the way shorter, in the triangle with corner `over`.
bool TautInTets::replace(Nodes& way, std::size_t i, const Node& over) {
  const auto nearer = round(way[i - 1], over, way[i + 1]);
  if (!nearer) return false;
  double length = 0;
  Vec3 last = way[i - 1].at;
  for (const Node& x : *nearer) {
    length += from_to(last, x.at);
    last = x.at;
  }
  length += from_to(last, way[i + 1].at);
  const double old = from_to(way[i - 1].at, way[i].at) + from_to(way[i].at, way[i + 1].at);
  if (!nearer->empty() && !(length < no_gain * old)) return false;
  way.erase(way.begin() + static_cast<std::ptrdiff_t>(i));
  way.insert(way.begin() + static_cast<std::ptrdiff_t>(i), nearer->begin(), nearer->end());
  return true;
}

/// From the nearest point of all of the source, if that is in sight.
void TautInTets::start_nearer(WayInTets& way, Nodes& nodes) {
  const auto [face, at] = foot_(way.face, nodes[1].at, true);
  if (face == way.face ||
      !(from_to(at, nodes[1].at) < no_gain * from_to(nodes[0].at, nodes[1].at)) ||
      !sees(nodes[1], {at, {-1, -1}}))
    return;
  way.face = face;
  nodes[0].at = at;
}

/// Turns at ends of edges, onto the edge there that leads down most.
void TautInTets::turn_onto_edges(Nodes& way) const {
  for (std::size_t i = 1; i + 1 < way.size(); ++i) {
    if (!way[i].turn.at_end()) continue;
    const int v = way[i].turn.end();
    const Vec3 pull =
        (way[i].at - way[i - 1].at).normalized() + (way[i].at - way[i + 1].at).normalized();
    double least = -downhill;
    for (const int w : reentrant_[v]) {
      const double slope = (point(w) - point(v)).normalized().dot(pull);
      if (!(slope < least)) continue;
      least = slope;
      way[i].turn = {v, w, 0};
    }
  }
}

/// A way with its start and turns where it would be shortest if nothing were between.
TautInTets::Nodes TautInTets::taut_places(int face, const Nodes& way) const {
  const std::function<Vec3(const Vec3&)> start = [&](const Vec3& x) {
    return foot_(face, x, false).second;
  };
  std::vector<EdgeTurn> turns;
  for (std::size_t i = 1; i + 1 < way.size(); ++i) turns.push_back(way[i].turn);
  make_taut(mesh_.points, start, way.back().at, turns);
  Nodes out = way;
  for (std::size_t i = 0; i < turns.size(); ++i)
    out[i + 1] = node(turn_at(turns[i].a, turns[i].b, turns[i].t));
  out[0].at = start(out[1].at);
  return out;
}

/// A way whose start and turns are moved by a share of the way to those of `to`.
TautInTets::Nodes TautInTets::moved(const Nodes& way, const Nodes& to, double share) {
  Nodes out{{way[0].at + share * (to[0].at - way[0].at), way[0].turn}};
  const auto go_on = [&](const Node& over, const Node& next) {
    const Node from = out.back();
    if (const auto between = round(from, over, next))
      out.insert(out.end(), between->begin(), between->end());
    else
      out.push_back(over);
  };
  if (to[0].at != way[0].at) {
    go_on(way[0], way[1]);
    if (out.back().turn.a < 0) out = {out.back()};  // the start, which stays if it is in the way
  }
  for (std::size_t i = 1; i + 1 < way.size(); ++i) {
    const EdgeTurn &old = way[i].turn, &new_turn = to[i].turn;
    if (new_turn.t == old.t) {
      out.push_back(way[i]);
      continue;
    }
    const Node next = node(turn_at(old.a, old.b, old.t + share * (new_turn.t - old.t)));
    go_on(way[i], next);
    out.push_back(next);
    go_on(way[i], way[i + 1]);
  }
  out.push_back(way.back());
  return out;
}

}  // namespace littoral
