#include "domain/tet/tet_lattice.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <deque>
#include <unordered_map>
#include <unordered_set>

#include "base/index.h"
#include "littoral/error.h"

namespace littoral {

namespace {

using Place = std::array<int, 3>;  // in halves of the smallest cube's side

constexpr std::size_t max_tets = std::size_t{1} << 26;

std::uint64_t key(const Place& p) {
  return static_cast<std::uint64_t>(p[0]) << 42 | static_cast<std::uint64_t>(p[1]) << 21 |
         static_cast<std::uint64_t>(p[2]);
}

struct Cube {
  Place low;  // its lowest corner
  int size;   // side
};

/// The octree: nodes with their cubes, children eight in a row.
struct Octree {
  std::vector<Cube> cubes;
  std::vector<int> child;  // first of eight, or -1

  explicit Octree(int size) : cubes{{{0, 0, 0}, size}}, child{-1} {}

  int leaf(const Place& p) const {
    int at = 0;
    while (child[at] >= 0) {
      const Cube& c = cubes[at];
      const int half = c.size / 2;
      at = child[at] + (p[0] >= c.low[0] + half ? 1 : 0) + (p[1] >= c.low[1] + half ? 2 : 0) +
           (p[2] >= c.low[2] + half ? 4 : 0);
    }
    return at;
  }
  void split(int at) {
    const Cube c = cubes[at];
    child[at] = cubes.size();
    const int half = c.size / 2;
    for (int w = 0; w < 8; ++w) {
      cubes.push_back({{c.low[0] + (w & 1 ? half : 0), c.low[1] + (w & 2 ? half : 0),
                        c.low[2] + (w & 4 ? half : 0)},
                       half});
      child.push_back(-1);
    }
  }
};

/// Halves cubes until none has a neighbour across a face or an edge less than half its size.
void balance(Octree& tree) {
  const int whole = tree.cubes[0].size;
  std::deque<int> queue;
  for (std::size_t at = 0; at < tree.cubes.size(); ++at)
    if (tree.child[at] < 0) queue.push_back(at);
  while (!queue.empty()) {
    const int at = queue.front();
    queue.pop_front();
    if (tree.child[at] >= 0) continue;
    const Cube c = tree.cubes[at];
    for (int dz = -1; dz <= 1; ++dz)
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
          if (std::abs(dx) + std::abs(dy) + std::abs(dz) > 2) continue;
          const Place p{c.low[0] + dx * c.size, c.low[1] + dy * c.size, c.low[2] + dz * c.size};
          if (std::any_of(p.begin(), p.end(), [&](int x) { return x < 0 || x >= whole; })) continue;
          const int other = tree.leaf(p);
          if (tree.cubes[other].size <= 2 * c.size) continue;
          tree.split(other);
          const int first = tree.child[other];
          for (int w = 0; w < 8; ++w) queue.push_back(first + w);
          queue.push_back(at);
        }
  }
}

/// Writes the tets of all leaves.
class Filler {
 public:
  Filler(const Octree& tree, const Vec3& origin, double unit, TetMesh& mesh)
      : origin_(origin), unit_(unit), mesh_(mesh) {
    for (std::size_t at = 0; at < tree.cubes.size(); ++at) {
      if (tree.child[at] >= 0) continue;
      const Cube& c = tree.cubes[at];
      for (int w = 0; w < 8; ++w)
        corners_.insert(key({c.low[0] + (w & 1 ? c.size : 0), c.low[1] + (w & 2 ? c.size : 0),
                             c.low[2] + (w & 4 ? c.size : 0)}));
    }
  }

  void fill(const Cube& c) {
    const int half = c.size / 2;
    centre_ = vertex({c.low[0] + half, c.low[1] + half, c.low[2] + half});
    for (int axis = 0; axis < 3; ++axis)
      for (int side = 0; side < 2; ++side) {
        Place low = c.low;
        low[axis] += side * c.size;
        face(low, (axis + 1) % 3, (axis + 2) % 3, c.size, side == 0);
      }
  }

  void finish() {
    mesh_.points.resize(points_.size(), 3);
    for (std::size_t v = 0; v < points_.size(); ++v) mesh_.points.row(v) = points_[v];
    mesh_.tets = Eigen::Map<const Rows<int, 4>>(tets_.data(), tets_.size() / 4, 4);
  }
  std::size_t n_tets() const { return tets_.size() / 4; }

 private:
  static Place moved(Place p, int u, int du, int v, int dv) {
    p[u] += du;
    p[v] += dv;
    return p;
  }
  bool is_corner(const Place& p) const { return corners_.count(key(p)) != 0; }
  int vertex(const Place& p) {
    const auto [at, is_new] = vertices_.try_emplace(key(p), points_.size());
    if (is_new) points_.emplace_back(origin_ + unit_ * Vec3(p[0], p[1], p[2]));
    return at->second;
  }
  void tet(int a, int b, int c, bool inward) {
    if (inward) std::swap(b, c);
    // The triangle's normal points out of the cube; the centre lies behind it.
    tets_.insert(tets_.end(), {a, c, b, centre_});
  }

  /// Triangulates a square face spanned by the axes u, v, normal u x v (reversed where `inward`).
  void face(const Place& low, int u, int v, int size, bool inward) {
    const int half = size / 2;
    const Place centre = moved(low, u, half, v, half);
    if (size > 2 && is_corner(centre)) {  // the neighbour is finer: its faces
      for (const auto& [du, dv] : {std::pair(0, 0), {half, 0}, {0, half}, {half, half}})
        face(moved(low, u, du, v, dv), u, v, half, inward);
      return;
    }
    const std::array<Place, 4> corner{low, moved(low, u, size, v, 0), moved(low, u, size, v, size),
                                      moved(low, u, 0, v, size)};
    const std::array<Place, 4> middle{moved(low, u, half, v, 0), moved(low, u, size, v, half),
                                      moved(low, u, half, v, size), moved(low, u, 0, v, half)};
    std::array<bool, 4> hanging{};
    for (std::size_t k = 0; k < 4; ++k) hanging[k] = size > 2 && is_corner(middle[k]);
    if (std::none_of(hanging.begin(), hanging.end(), [](bool h) { return h; })) {
      const int parity = (low[0] / size + low[1] / size + low[2] / size) & 1;
      std::array<int, 4> n{};
      for (std::size_t k = 0; k < 4; ++k) n[k] = vertex(corner[(k + parity) % 4]);
      tet(n[0], n[1], n[2], inward);
      tet(n[0], n[2], n[3], inward);
      return;
    }
    std::vector<int> loop;
    for (std::size_t k = 0; k < 4; ++k) {
      loop.push_back(vertex(corner[k]));
      if (hanging[k]) loop.push_back(vertex(middle[k]));
    }
    const int hub = vertex(centre);
    for (std::size_t k = 0; k < loop.size(); ++k)
      tet(hub, loop[k], loop[(k + 1) % loop.size()], inward);
  }

  Vec3 origin_;
  double unit_;
  TetMesh& mesh_;
  std::unordered_set<std::uint64_t> corners_;
  std::unordered_map<std::uint64_t, int> vertices_;
  std::vector<Vec3> points_;
  std::vector<int> tets_;
  int centre_ = 0;
};

}  // namespace

double interpolated(const TetMesh& mesh, const VecX& field, const TetPoint& p) {
  double value = 0;
  for (int c = 0; c < 4; ++c) value += p.barycentric[c] * field[mesh.tets(p.tet, c)];
  return value;
}

TetLattice::TetLattice(const Vec3& origin, double side, int depth, const MatX3& points)
    : origin_(origin), side_(side), depth_(depth) {
  const int whole = 2 << depth;  // the smallest cube has size 2, so that its centre is a place
  Octree tree(whole);
  const double unit = side / whole;
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const Vec3 at = (points.row(i).transpose() - origin) / unit;
    // The cube that holds the point and those next to it: no point sees the change of size.
    for (int w = 0; w < 8; ++w) {
      Place p;
      bool inside = true;
      for (int a = 0; a < 3; ++a) {
        const double x = at[a] + (w >> a & 1 ? 1 : -1);
        inside = inside && x >= 0 && x < whole;
        p[a] = inside ? static_cast<int>(x) : 0;
      }
      if (!inside) continue;
      int leaf = tree.leaf(p);
      while (tree.cubes[leaf].size > 2) {
        tree.split(leaf);
        leaf = tree.leaf(p);
      }
    }
    if (tree.cubes.size() * 12 > max_tets)
      throw InputError("the tet lattice would have too many tets; lower option resolution",
                       "too-large");
  }
  balance(tree);

  Filler filler(tree, origin, unit, mesh_);
  child_ = tree.child;
  for (std::size_t at = 0; at < tree.cubes.size(); ++at) {
    if (tree.child[at] >= 0) continue;
    child_[at] = -1 - int_size(first_tet_);
    first_tet_.push_back(filler.n_tets());
    filler.fill(tree.cubes[at]);
    cube_.resize(filler.n_tets(), int_size(first_tet_) - 1);
    if (filler.n_tets() > max_tets)
      throw InputError("the tet lattice would have too many tets; lower option resolution",
                       "too-large");
  }
  first_tet_.push_back(filler.n_tets());
  filler.finish();
}

double TetLattice::finest() const { return side_ / (1 << depth_); }

TetPoint TetLattice::locate(const Vec3& x) const {
  TetPoint best;
  Vec3 t = (x - origin_) / side_;
  if (!((t.array() >= 0).all() && (t.array() <= 1).all())) return best;
  int at = 0;
  while (child_[at] >= 0) {
    int which = 0;
    for (int a = 0; a < 3; ++a) {
      t[a] *= 2;
      if (t[a] >= 1) {
        which |= 1 << a;
        t[a] -= 1;
      }
    }
    at = child_[at] + which;
  }
  const std::size_t cube = -1 - child_[at];
  double least = -1e300;
  for (int e = first_tet_[cube]; e < first_tet_[cube + 1]; ++e) {
    Eigen::Matrix3d edges;
    const Vec3 a = mesh_.points.row(mesh_.tets(e, 0));
    for (int k = 0; k < 3; ++k)
      edges.col(k) = mesh_.points.row(mesh_.tets(e, k + 1)).transpose() - a;
    const Vec3 b = edges.inverse() * (x - a);
    const double inside = std::min(b.minCoeff(), 1 - b.sum());
    if (inside <= least) continue;
    least = inside;
    best.tet = e;
    best.barycentric = {1 - b.sum(), b[0], b[1], b[2]};
  }
  return best;
}

}  // namespace littoral
