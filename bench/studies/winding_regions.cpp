// How much area surface winding numbers mislabel: regions on surfaces of genus 0 to 5 whose
// boundaries have gaps and follow jagged edges, with broken loops that bound nothing added. Prints
// Markdown. usage: littoral_winding_regions [CASES_PER_GENUS [SEED]]

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <memory>
#include <numeric>
#include <queue>
#include <random>
#include <set>

#include "domain/intrinsic/intrinsic_triangulation.h"
#include "methods/winding/surface_winding.h"

namespace {

using namespace littoral;
using Random = std::mt19937;

double uniform(Random& random, double a, double b) {
  return std::uniform_real_distribution<double>(a, b)(random);
}
int below(Random& random, int n) { return std::uniform_int_distribution<int>(0, n - 1)(random); }

/// The boundary of a plate with `genus` holes, of cubes cut `fine` times, smoothed and jittered.
SurfaceMesh plate(int genus, int fine, Random& random) {
  const int width = genus == 0 ? 3 : 2 * genus + 1;
  const int nx = width * fine, ny = 3 * fine, nz = fine;
  const auto filled = [&](int x, int y, int z) {
    if (x < 0 || y < 0 || z < 0 || x >= nx || y >= ny || z >= nz) return false;
    return genus == 0 || !(y / fine == 1 && (x / fine) % 2 == 1);
  };
  PolygonSoup soup;
  std::map<std::array<int, 3>, int> number;
  std::vector<Vec3> points;
  const auto vertex = [&](std::array<int, 3> p) {
    const auto [it, added] = number.try_emplace(p, static_cast<int>(points.size()));
    if (added) points.emplace_back(p[0], p[1], p[2]);
    return it->second;
  };
  for (int x = 0; x < nx; ++x)
    for (int y = 0; y < ny; ++y)
      for (int z = 0; z < nz; ++z)
        for (int axis = 0; axis < 3 && filled(x, y, z); ++axis)
          for (const int side : {0, 1}) {
            std::array<int, 3> next{x, y, z};
            next[axis] += side ? 1 : -1;
            if (filled(next[0], next[1], next[2])) continue;
            std::array<int, 4> quad;
            const int u = (axis + 1) % 3, v = (axis + 2) % 3;
            for (int c = 0; c < 4; ++c) {
              std::array<int, 3> p{x, y, z};
              p[axis] += side;
              p[u] += c == 1 || c == 2;
              p[v] += c >= 2;
              quad[c] = vertex(p);
            }
            if (!side) std::swap(quad[1], quad[3]);
            const int turn = below(random, 2);
            for (const int c : {0, 2}) {
              const int face[3] = {quad[turn], quad[(turn + 1 + c / 2) % 4],
                                   quad[(turn + 2 + c / 2) % 4]};
              soup.add_face(face);
            }
          }
  std::vector<std::set<int>> ring(points.size());
  for (int f = 0; f < soup.n_faces(); ++f)
    for (int a : soup.face(f))
      for (int b : soup.face(f))
        if (a != b) ring[a].insert(b);
  for (int pass = 0; pass < 2 * fine; ++pass) {
    std::vector<Vec3> old = points;
    for (std::size_t v = 0; v < points.size(); ++v) {
      Vec3 mean = Vec3::Zero();
      for (int w : ring[v]) mean += old[w];
      points[v] = 0.5 * old[v] + 0.5 * mean / static_cast<double>(ring[v].size());
    }
  }
  soup.points.resize(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t v = 0; v < points.size(); ++v)
    for (int k = 0; k < 3; ++k)
      soup.points(static_cast<Eigen::Index>(v), k) = points[v][k] + uniform(random, -0.15, 0.15);
  return SurfaceMesh(std::move(soup));
}

/// Directed edges, each as (edge, +1 or -1).
using Chain = std::vector<std::pair<int, int>>;

/// Faces nearest to a random one, up to a random share of all.
std::vector<char> blob(const JumpCalculus& J, const SurfaceMesh& mesh, Random& random) {
  const auto centre = [&](int f) {
    const auto c = mesh.face(f);
    return Vec3((mesh.point(c[0]) + mesh.point(c[1]) + mesh.point(c[2])) / 3);
  };
  std::vector<char> inside(J.n_faces, 0);
  std::priority_queue<std::pair<double, int>, std::vector<std::pair<double, int>>, std::greater<>>
      queue;
  queue.emplace(0, below(random, J.n_faces));
  int left = static_cast<int>(J.n_faces * uniform(random, 0.02, 0.1));
  while (!queue.empty() && left > 0) {
    const auto [d, f] = queue.top();
    queue.pop();
    if (inside[f]) continue;
    inside[f] = 1;
    --left;
    for (int k = 0; k < 3; ++k)
      if (const int g = J.across(f, k).face; g >= 0 && !inside[g])
        queue.emplace(d + (centre(g) - centre(f)).norm() * uniform(random, 0.8, 1.2), g);
  }
  return inside;
}

/// The boundary of a set of faces, the set on its left, in order along each loop.
std::vector<Chain> boundary_loops(const JumpCalculus& J, const SurfaceMesh& mesh,
                                  const std::vector<char>& inside) {
  std::multimap<int, std::pair<int, int>> out;  // tail vertex -> edge, direction
  for (int e = 0; e < J.n_edges; ++e) {
    const auto& [l, r] = J.sides[e];
    if (inside[l.face] == inside[r.face]) continue;
    const int sign = inside[l.face] ? 1 : -1;
    out.emplace(mesh.edges()(e, sign > 0 ? 0 : 1), std::pair(e, sign));
  }
  std::vector<Chain> loops;
  while (!out.empty()) {
    Chain& loop = loops.emplace_back();
    for (auto it = out.begin(); it != out.end();) {
      const auto [e, sign] = it->second;
      loop.emplace_back(e, sign);
      out.erase(it);
      it = out.find(mesh.edges()(e, sign > 0 ? 1 : 0));
    }
  }
  return loops;
}

/// Loops of independent classes, none of which bounds anything, alone or together: from a tree of
/// vertices and a tree of faces beside it.
std::vector<Chain> handle_loops(const JumpCalculus& J, const SurfaceMesh& mesh, int count,
                                Random& random) {
  std::vector<std::vector<int>> at(mesh.n_vertices());
  for (int e = 0; e < J.n_edges; ++e)
    for (const int end : {0, 1}) at[mesh.edges()(e, end)].push_back(e);
  std::vector<int> up(mesh.n_vertices(), -2);
  std::vector<char> used(J.n_edges, 0);
  std::vector<int> queue{below(random, mesh.n_vertices())};
  up[queue[0]] = -1;
  for (std::size_t i = 0; i < queue.size(); ++i)
    for (int e : at[queue[i]]) {
      const int w = mesh.edges()(e, mesh.edges()(e, 0) == queue[i] ? 1 : 0);
      if (up[w] != -2) continue;
      up[w] = e;
      used[e] = 1;
      queue.push_back(w);
    }
  std::vector<char> seen(J.n_faces, 0);
  std::vector<int> faces{0};
  seen[0] = 1;
  for (std::size_t i = 0; i < faces.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      const int e = J.edge(faces[i], k), g = J.across(faces[i], k).face;
      if (used[e] || g < 0 || seen[g]) continue;
      seen[g] = 1;
      used[e] = 1;
      faces.push_back(g);
    }
  std::vector<int> closing;
  for (int e = 0; e < J.n_edges; ++e)
    if (!used[e]) closing.push_back(e);
  std::shuffle(closing.begin(), closing.end(), random);
  const auto way_up = [&](int v) {
    Chain chain;
    while (up[v] >= 0) {
      const int a = up[v];
      const int sign = mesh.edges()(a, 0) == v ? 1 : -1;
      chain.emplace_back(a, sign);
      v = mesh.edges()(a, sign > 0 ? 1 : 0);
    }
    return chain;
  };
  std::vector<Chain> loops;
  for (int e : closing) {
    if (static_cast<int>(loops.size()) == count) break;
    Chain first = way_up(mesh.edges()(e, 0)), second = way_up(mesh.edges()(e, 1));
    while (!first.empty() && !second.empty() && first.back() == second.back()) {
      first.pop_back();
      second.pop_back();
    }
    Chain& loop = loops.emplace_back(Chain{{e, 1}});
    loop.insert(loop.end(), second.begin(), second.end());
    for (auto it = first.rbegin(); it != first.rend(); ++it)
      loop.emplace_back(it->first, -it->second);
  }
  return loops;
}

/// Adds a loop to a curve, without about `missing` of it in gaps of one to six edges.
void add_broken(const Chain& loop, double missing, Random& random, VecX& curve) {
  std::vector<char> gone(loop.size(), 0);
  double left = missing * static_cast<double>(loop.size());
  while (left >= 1) {
    const int length = std::min(static_cast<int>(left), 1 + below(random, 6));
    const int from = below(random, static_cast<int>(loop.size()));
    for (int i = 0; i < length; ++i) gone[(from + i) % loop.size()] = 1;
    left -= length;
  }
  for (std::size_t i = 0; i < loop.size(); ++i)
    if (!gone[i]) curve[loop[i].first] += loop[i].second;
}

/// Share of area labelled otherwise than in truth, up to one integer for all.
double wrong_share(const JumpCalculus& J, const VecXi& region, const VecXi& truth) {
  double best = 1;
  for (int shift = -3; shift <= 3; ++shift) {
    double wrong = 0;
    for (int f = 0; f < J.n_faces; ++f)
      if (region[f] + shift != truth[f]) wrong += J.area[f];
    best = std::min(best, wrong / J.area.sum());
  }
  return best;
}

struct Column {
  std::vector<double> share;
  void print() const {
    double sum = 0, most = 0, good = 0;
    for (double s : share) {
      sum += s;
      most = std::max(most, s);
      good += s < 0.005;
    }
    const double n = static_cast<double>(share.size());
    std::printf(" %.2f / %.1f / %.0f |", 100 * sum / n, 100 * most, 100 * good / n);
  }
};

}  // namespace

int main(int argc, char** argv) {
  const int cases = argc > 1 ? std::atoi(argv[1]) : 60;
  const unsigned seed = argc > 2 ? static_cast<unsigned>(std::atoi(argv[2])) : 1;
  std::printf(
      "| genus | faces | cases | rounded | cut | between paths, rounded | rounded without "
      "decomposition |\n|---|---|---|---|---|---|---|\n");
  for (int genus = 0; genus <= 5; ++genus) {
    Column round, cut, paths, naive;
    int faces = 0;
    for (int i = 0; i < cases; ++i) {
      Random random(seed * 1000003u + static_cast<unsigned>(genus * 1009 + i));
      const SurfaceMesh mesh = plate(genus, genus == 0 ? 10 : 7, random);
      Report report;
      const auto J =
          std::make_shared<JumpCalculus>(jump_calculus(intrinsic_triangulation(mesh, report)));
      faces = J->n_faces;
      VecX curve = VecX::Zero(J->n_edges);
      VecXi truth = VecXi::Zero(J->n_faces);
      const double missing = uniform(random, 0.05, 0.3);
      const int regions = 1 + below(random, 3), loops = genus == 0 ? 0 : below(random, 3);
      for (int r = 0; r < regions; ++r) {
        // Disks only: where a region wraps round a handle, loops round it are its boundary's
        // equals.
        std::vector<char> inside = blob(*J, mesh, random);
        while (boundary_loops(*J, mesh, inside).size() > 1) inside = blob(*J, mesh, random);
        for (int f = 0; f < J->n_faces; ++f) truth[f] += inside[f];
        for (const Chain& loop : boundary_loops(*J, mesh, inside))
          add_broken(loop, missing, random, curve);
      }
      for (const Chain& loop : handle_loops(*J, mesh, loops, random))
        add_broken(loop, missing, random, curve);
      const WindingSolver winding(J);
      SurfaceWinding options;
      const auto share = [&] {
        return wrong_share(*J, winding.solve(curve, options, {}, report).region, truth);
      };
      round.share.push_back(share());
      options.labels = Labels::cut;
      cut.share.push_back(share());
      options.labels = Labels::round;
      options.residual = Residual::paths;
      paths.share.push_back(share());
      options.keep_nonbounding = true;
      naive.share.push_back(share());
    }
    std::printf("| %d | %d | %d |", genus, faces, cases);
    round.print();
    cut.print();
    paths.print();
    naive.print();
    std::printf("\n");
    std::fflush(stdout);
  }
}
