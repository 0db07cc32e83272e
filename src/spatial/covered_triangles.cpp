#include "spatial/covered_triangles.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <tuple>
#include <unordered_map>

#include "base/index.h"
#include "base/numbers_hash.h"

namespace littoral {

namespace {

constexpr double rounding = 2 * std::numeric_limits<double>::epsilon();

using Triangle = std::array<Vec3, 3>;
using Place = std::array<double, 3>;

Place place_of(const Vec3& p) { return {p[0], p[1], p[2]}; }

/// The same number for the same three corners, whichever comes first. Zeros of both signs are one.
std::uint64_t hash_of(const Triangle& t) {
  std::uint64_t sum = 0;
  for (const Vec3& p : t) {
    std::uint64_t h = 0;
    for (int d = 0; d < 3; ++d) {
      h = (h ^ std::bit_cast<std::uint64_t>(p[d] + 0.0)) * 0x9e3779b97f4a7c15u;
      h ^= h >> 29;
    }
    sum += h * 0xbf58476d1ce4e5b9u;
  }
  return sum ^ sum >> 32;
}

bool same_corners(const Triangle& a, const Triangle& b) {
  const auto sorted = [](const Triangle& t) {
    std::array<Place, 3> out{place_of(t[0]), place_of(t[1]), place_of(t[2])};
    std::sort(out.begin(), out.end());
    return out;
  };
  return sorted(a) == sorted(b);
}

void find_copies(const std::vector<Triangle>& corners, std::vector<bool>& covered) {
  const std::size_t slots = std::bit_ceil(2 * corners.size());
  struct Slot {
    std::uint32_t hash = 0;
    int first = -1;
  };
  std::vector<Slot> table(slots);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const std::uint64_t hash = hash_of(corners[i]);
    const auto mark = static_cast<std::uint32_t>(hash >> 32);
    for (std::size_t at = hash & (slots - 1);; at = (at + 1) & (slots - 1)) {
      Slot& slot = table[at];
      if (slot.first < 0) {
        slot = {mark, static_cast<int>(i)};
        break;
      }
      if (slot.hash != mark || !same_corners(corners[slot.first], corners[i])) continue;
      covered[i] = true;
      break;
    }
  }
}

struct Side {
  Vec3 from, to;
};

Side longest_side(const Triangle& t) {
  Side longest;
  double most = -1;
  for (int k = 0; k < 3; ++k) {
    const Side side{t[k], t[(k + 1) % 3]};
    const double length2 = (side.to - side.from).squaredNorm();
    if (!(length2 > most)) continue;
    most = length2;
    longest = side;
  }
  return longest;
}

/// A line, to a millionth: its direction and its nearest point to the centre. What is one line but
/// for rounding nearly always gets the same numbers.
using Line = std::array<std::int64_t, 6>;

Line line_of(const Side& s, const Vec3& centre, double size) {
  constexpr double fine = 1e6, no_component = 1e-3;
  Vec3 d = (s.to - s.from).normalized();
  for (int a = 0; a < 3; ++a) {
    if (std::abs(d[a]) < no_component) continue;
    if (d[a] < 0) d = -d;
    break;
  }
  const Vec3 p = (s.from - centre) / size, foot = p - p.dot(d) * d;
  Line line;
  for (std::size_t a = 0; a < 3; ++a) {
    line[a] = std::llround(fine * d[index(a)]);
    line[a + 3] = std::llround(fine * foot[index(a)]);
  }
  return line;
}

double distance_to(const Side& s, const Vec3& p) {
  const Vec3 d = s.to - s.from;
  const double t = std::clamp((p - s.from).dot(d) / d.squaredNorm(), 0.0, 1.0);
  return std::min({(p - s.from).norm(), (p - s.to).norm(), (p - (s.from + t * d)).norm()});
}

/// A side of a triangle on a line.
struct Stretch {
  Stretch(int t, const Side& s, bool area) : triangle(t), side(s), has_area(area) {}
  int triangle;
  Side side;
  bool has_area;  // stays, whatever covers the side
  double low = 0, high = 0;
};

/// In the order of their lower ends each is within the one that reached farthest so far or within
/// none.
void cover_along(const Line& line, std::vector<Stretch>& stretches, double most_apart,
                 std::vector<bool>& covered) {
  // The same for all of the line: equal ends have equal places along it.
  const Vec3 d(static_cast<double>(line[0]), static_cast<double>(line[1]),
               static_cast<double>(line[2]));
  for (Stretch& s : stretches)
    std::tie(s.low, s.high) = std::minmax({d.dot(s.side.from), d.dot(s.side.to)});
  std::sort(stretches.begin(), stretches.end(), [](const Stretch& a, const Stretch& b) {
    return std::tuple(a.low, -a.high, !a.has_area, a.triangle) <
           std::tuple(b.low, -b.high, !b.has_area, b.triangle);
  });
  const Stretch* farthest = nullptr;
  for (const Stretch& s : stretches) {
    if (farthest != nullptr && s.high <= farthest->high) {
      if (!s.has_area && distance_to(farthest->side, s.side.from) <= most_apart &&
          distance_to(farthest->side, s.side.to) <= most_apart)
        covered[s.triangle] = true;
    } else {
      farthest = &s;
    }
  }
}

}  // namespace

bool is_flat(const Vec3& a, const Vec3& b, const Vec3& c, double size) {
  if (!(size > 0)) return true;
  const Vec3 u = (b - a) / size, v = (c - a) / size;
  const double longest2 = std::max({u.squaredNorm(), v.squaredNorm(), (u - v).squaredNorm()});
  return u.cross(v).squaredNorm() <= rounding * rounding * longest2;
}

std::vector<bool> covered_triangles(const std::vector<Triangle>& corners) {
  std::vector<bool> covered(corners.size());
  find_copies(corners, covered);

  Vec3 low = Vec3::Constant(infinity), high = -low;
  for (const Triangle& t : corners)
    for (const Vec3& p : t) low = low.cwiseMin(p), high = high.cwiseMax(p);
  const double size = (high - low).maxCoeff();
  const Vec3 centre = (low + high) / 2;

  std::unordered_map<Line, std::vector<Stretch>, NumbersHash> lines;
  std::map<Place, int> at_point;  // the first triangle that is this point
  std::vector<int> with_area, sides;
  for (int i = 0; i < int_size(corners); ++i) {
    if (covered[i]) continue;
    const auto& [a, b, c] = corners[i];
    if (!is_flat(a, b, c, size)) {
      with_area.push_back(i);
      continue;
    }
    const Side longest = longest_side(corners[i]);
    if (longest.from == longest.to) {
      covered[i] = !at_point.emplace(place_of(a), i).second;
    } else {
      sides.push_back(i);
      lines[line_of(longest, centre, size)].emplace_back(i, longest, false);
    }
  }
  if (!lines.empty())
    for (const int i : with_area)
      for (int k = 0; k < 3; ++k) {
        const Side side{corners[i][k], corners[i][(k + 1) % 3]};
        const auto line = lines.find(line_of(side, centre, size));
        if (line != lines.end()) line->second.emplace_back(i, side, true);
      }
  for (auto& [line, stretches] : lines) cover_along(line, stretches, rounding * size, covered);
  if (!at_point.empty())
    for (const auto* some : {&with_area, &sides})
      for (const int i : *some)
        for (const Vec3& p : corners[i])
          if (const auto point = at_point.find(place_of(p)); point != at_point.end())
            covered[point->second] = true;
  return covered;
}

}  // namespace littoral
