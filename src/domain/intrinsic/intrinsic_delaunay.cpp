#include "domain/intrinsic/intrinsic_delaunay.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <string>

#include "base/index.h"
#include "base/parallel.h"
#include "domain/intrinsic/intrinsic_mesh_editor.h"

namespace littoral {

namespace {

const double degree = std::acos(-1.0) / 180;
constexpr double delaunay_margin = -1e-9;  // a sum of cotangents below this is not Delaunay

class Improvement {
 public:
  Improvement(IntrinsicMeshEditor& M, const RefineOptions& options, const Task& task)
      : M_(M),
        task_(task),
        cot_(1 / std::tan(std::max(options.smallest_angle, 1e-3) * degree)),
        angle_(M.n_vertices(), 0.0),
        least_angle_(3 * options.smallest_angle * degree),
        most_flips_(50 * static_cast<long long>(M.edges.size()) + 10000),
        most_vertices_(M.n_vertices() + 1000 +
                       static_cast<long long>(options.growth * M.n_vertices())) {
    if (!(options.smallest_angle > 0)) return;  // what follows is for refinement
    double sum = 0;
    for (std::size_t f = 0; f < M_.faces.size(); ++f) {
      const auto cot = M_.shape(f).cot;
      for (int k = 0; k < 3; ++k) {
        angle_[M_.faces[f].v[k]] += std::atan2(1, cot[k]);
        sum += M_.edges[M_.faces[f].e[k]].length;
      }
    }
    for (std::size_t f = 0; f < M_.faces.size(); ++f) {  // wedges between fixed edges
      const auto cot = M_.shape(f).cot;
      const auto& face = M_.faces[f];
      for (int k = 0; k < 3; ++k)
        if (std::atan2(1, cot[k]) < least_angle_ && M_.fixed(face.e[k]) &&
            M_.fixed(face.e[(k + 2) % 3]))
          angle_[face.v[k]] = 0;
    }
    shortest_ = 1e-6 * sum / (3 * static_cast<double>(M_.faces.size()));
  }

  /// Flips from all edges on.
  void flip_all() {
    std::deque<int> all;
    for (std::size_t e = 0; e < M_.edges.size(); ++e) all.push_back(static_cast<int>(e));
    settled_ = are_delaunay();
    flip(std::move(all));
    settled_.clear();
  }

  /// Edges; found on all threads.
  std::vector<char> are_delaunay() const {
    std::vector<char> out(M_.edges.size());
    parallel_for(out.size(), 1 << 14, [&](std::size_t begin, std::size_t end) {
      for (std::size_t e = begin; e < end; ++e) {
        for (int step = 0; step < IntrinsicMeshEditor::n_fetch_steps; ++step)
          if (const std::size_t next = e + ahead_of(step); next < end)
            M_.fetch(static_cast<int>(next), step);
        out[e] = !(M_.delaunay_sum(static_cast<int>(e)) < delaunay_margin);
      }
    });
    return out;
  }

  /// Flips from the edges in the queue on.
  void flip(std::deque<int> queue) {
    std::vector<char> waiting(M_.edges.size(), 0);
    for (int e : queue) waiting[e] = 1;
    while (!queue.empty() && flips < most_flips_) {
      if (flips % 256 == 0) task_.checkpoint();
      for (int step = 0; step < IntrinsicMeshEditor::n_fetch_steps; ++step)
        if (const std::size_t next = ahead_of(step); next < queue.size()) {
          const int s = queue[next];
          if (settled_.empty() || !settled_[s]) M_.fetch(s, step);
        }
      const int e = queue.front();
      queue.pop_front();
      waiting[e] = 0;
      if (!settled_.empty() && settled_[e]) continue;
      if (!(M_.delaunay_sum(e) < delaunay_margin) || !M_.flip(e)) continue;
      ++flips;
      for (int f : M_.edges[e].faces) {
        touched.push_back(f);
        for (int s : M_.faces[f].e) {
          if (!settled_.empty()) settled_[s] = 0;
          if (s != e && !waiting[s]) {
            waiting[s] = 1;
            queue.push_back(s);
          }
        }
      }
    }
  }

  void refine() {
    std::deque<int> first, later;  // faces: those beside edges that are not Delaunay come first
    const auto add = [&](int f) {
      if (obtuse(f))
        first.push_back(f);
      else if (sharp(f))
        later.push_back(f);
    };
    for (std::size_t f = 0; f < M_.faces.size(); ++f) add(f);
    while (M_.n_vertices() < most_vertices_ && flips < most_flips_) {
      task_.checkpoint();
      auto& queue = first.empty() ? later : first;
      if (queue.empty()) break;
      const int f = queue.front();
      queue.pop_front();
      if (!obtuse(f) && !sharp(f)) continue;
      const int e = terminal_edge(f);
      if (!(M_.edges[e].length > shortest_)) continue;
      touched.clear();
      const std::size_t before = M_.faces.size();
      for (int g : M_.edges[e].faces) touched.push_back(g);
      if (!M_.split(e)) continue;
      ++added;
      for (std::size_t g = before; g < M_.faces.size(); ++g) touched.push_back(g);
      std::deque<int> edges;
      for (int g : touched)
        for (int s : M_.faces[g].e) edges.push_back(s);
      std::sort(edges.begin(), edges.end());
      edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
      flip(edges);
      for (int g : touched) add(g);
      add(f);
    }
  }

  long long flips = 0;
  int added = 0;
  std::vector<int> touched;

 private:
  static std::size_t ahead_of(int fetch_step) {
    return 6 * std::size_t(IntrinsicMeshEditor::n_fetch_steps - fetch_step);
  }

  /// Has the face an angle that is too small and that splitting can mend? Not one between two edges
  /// that cannot be flipped, nor one beside a vertex that has hardly any angle to share out: the
  /// tip of a wedge would be halved for ever.
  bool sharp(int f) const {
    const auto cot = M_.shape(f).cot;
    const auto& face = M_.faces[f];
    const auto is_tip = [&](int v) { return v < int_size(angle_) && angle_[v] < least_angle_; };
    if (std::any_of(face.v.begin(), face.v.end(), is_tip)) return false;
    for (int k = 0; k < 3; ++k)
      if (cot[k] > cot_ && !(M_.fixed(face.e[k]) && M_.fixed(face.e[(k + 2) % 3]))) return true;
    return false;
  }
  /// Is an edge of the face not Delaunay that cannot be flipped, as it is opposite an obtuse angle,
  /// but can be split?
  bool obtuse(int f) const {
    const auto cot = M_.shape(f).cot;
    const auto& e = M_.faces[f].e;
    for (int k = 0; k < 3; ++k) {
      const int opposite = e[(k + 1) % 3];
      if (cot[k] < 0 && M_.fixed(opposite) && M_.delaunay_sum(opposite) < delaunay_margin &&
          !in_wedge(opposite, e[k], cot[(k + 1) % 3]) &&
          !in_wedge(opposite, e[(k + 2) % 3], cot[(k + 2) % 3]))
        return true;
    }
    return false;
  }
  /// Would halving edge e make side s, at an angle to it, too long in turn, and so on for ever?
  bool in_wedge(int e, int s, double cot) const {
    const double cosine = cot / std::sqrt(1 + cot * cot);
    return M_.fixed(s) && 2 * M_.edges[s].length * cosine > M_.edges[e].length;
  }
  int terminal_edge(int f) const {
    int e = M_.longest_edge(f);
    for (int step = 0; step < 1000; ++step) {
      int longer = e;
      for (int g : M_.edges[e].faces) {
        const int l = M_.longest_edge(g);
        if (M_.edges[l].length > M_.edges[longer].length) longer = l;
      }
      if (longer == e) break;
      e = longer;
    }
    // Beside a fixed second longest edge halving the longest one would go on for ever.
    if (!M_.fixed(e))
      for (int g : M_.edges[e].faces)
        for (int s : M_.faces[g].e)
          if (s != e && M_.fixed(s) && !is_shortest(s, g)) return s;
    return e;
  }
  bool is_shortest(int e, int f) const {
    const auto& sides = M_.faces[f].e;
    return std::all_of(sides.begin(), sides.end(),
                       [&](int s) { return M_.edges[s].length >= M_.edges[e].length; });
  }

  IntrinsicMeshEditor& M_;
  const Task& task_;
  double cot_;
  std::vector<char> settled_;  // edges known to be Delaunay; empty: none
  std::vector<double> angle_;  // around the vertices of the input; others have enough
  double least_angle_, shortest_ = 0;
  long long most_flips_, most_vertices_;
};

}  // namespace

double share_not_delaunay(const IntrinsicTriangulation& T) {
  VecX sum = VecX::Zero(T.n_edges());
  for (int f = 0; f < T.n_faces(); ++f) {
    const TriangleShape t = T.shape(f);
    for (int k = 0; k < 3; ++k) sum[T.side_edge(f, k)] += t.cot[(k + 2) % 3];
  }
  int inner = 0, found = 0;
  for (int e = 0; e < T.n_edges(); ++e) {
    if (T.edge_use[e] != 2) continue;
    ++inner;
    found += sum[e] < delaunay_margin;
  }
  return inner > 0 ? double(found) / inner : 0;
}

Retriangulation intrinsic_delaunay(const SurfaceMesh& mesh, const IntrinsicTriangulation& T,
                                   CurveNetwork curves, const RefineOptions& options,
                                   Report& report, const Task& task) {
  IntrinsicMeshEditor M(mesh, T, std::move(curves));
  if (!options.keep.empty()) M.keep = options.keep;
  Improvement improvement(M, options, task);
  improvement.flip_all();
  if (options.smallest_angle > 0) improvement.refine();
  const std::vector<char> are_delaunay = improvement.are_delaunay();
  const auto left = std::count(are_delaunay.begin(), are_delaunay.end(), 0);
  Retriangulation out = std::move(M).finish(T);
  out.flips = std::min<long long>(improvement.flips, 1 << 30);
  out.added = improvement.added;
  out.not_delaunay = static_cast<int>(left);
  report.sizes.emplace_back("intrinsic_flips", out.flips);
  report.sizes.emplace_back("intrinsic_vertices_added", out.added);
  report.sizes.emplace_back("intrinsic_edges_not_delaunay", out.not_delaunay);
  return out;
}

}  // namespace littoral
