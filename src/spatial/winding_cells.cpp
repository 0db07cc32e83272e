// Winding numbers at many points: they are sorted into cells of space, down to cells of a few. The
// field of all that is far from a cell is harmonic there: it is expanded about the cell's centre in
// the harmonic polynomials of which fields of clusters are made (dipole_moments.h), fitted to
// values on the cell's surface, and handed down to the cells within. The rest is summed over
// clusters, eight points at a time.

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <span>
#include <vector>

#include "base/index.h"
#include "base/now_and_then.h"
#include "base/parallel.h"
#include "spatial/morton_order.h"
#include "spatial/winding_number.h"

namespace littoral {

namespace {

// Clusters are far from a cell where they are far from each of its points, and where the cell is so
// many of its radii away from all that is in them.
constexpr double cell_accuracy = WindingNumber::usual_accuracy, cell_distance = 2.2;
constexpr double half_root_cell = 1;  // in units; queries beyond are summed one by one
constexpr int most_deep = 20;
constexpr std::size_t worth_a_cell = 64;   // queries
constexpr std::size_t most_a_part = 1024;  // queries that one thread takes

// Where a field in a cell is taken to find its polynomials: on the faces and edges of the cell.
constexpr int n_groups = 6, n_samples = n_groups * winding_lanes;
constexpr int n_terms = dipole_coefficients + 1;

/// Places in a cell of radius 1, and the matrix that takes values there to polynomials.
struct Samples {
  std::array<PointLanes, n_groups> at;
  Eigen::Matrix<float, n_terms, n_samples> fit;

  Samples() {
    int n = 0;
    const auto add = [&](double x, double y, double z) {
      PointLanes& group = at[n / winding_lanes];
      const int l = n++ % winding_lanes;
      const double half = 1 / std::sqrt(3.0);
      group.x[l] = float(half * x), group.y[l] = float(half * y), group.z[l] = float(half * z);
      group.sum[l] = 0;
    };
    constexpr double on_face = 0.45, on_edge = 0.75;
    for (const double a : {-1.0, 1.0})
      for (const double b : {-1.0, 1.0})
        for (const double c : {-1.0, 1.0}) {
          add(a, on_face * b, on_face * c), add(on_face * b, a, on_face * c);
          add(on_face * b, on_face * c, a);
          add(a, b, on_edge * c), add(on_edge * c, a, b), add(b, on_edge * c, a);
        }
    Eigen::MatrixXd values(n_samples, n_terms);
    for (int k = 0; k < n_terms; ++k) {
      LocalField field;
      (k + 1 < n_terms ? field.moments[k] : field.constant) = 1;
      for (int g = 0; g < n_groups; ++g) {
        PointLanes lanes = at[g];
        winding_kernels().add_local(field, lanes);
        for (int l = 0; l < winding_lanes; ++l) values(winding_lanes * g + l, k) = lanes.sum[l];
      }
    }
    fit = values.completeOrthogonalDecomposition().pseudoInverse().cast<float>();
  }
};

const Samples& samples() {
  static const Samples all;
  return all;
}

}  // namespace

/// Cells of space, each with the field of what is far from it.
class WindingCells {
 public:
  WindingCells(const WindingNumber& of, const MatX3& queries, VecX& values)
      : of_(of), values_(values), local_(queries.rows(), 3) {
    for (Eigen::Index i = 0; i < queries.rows(); ++i)
      local_.row(i) = (queries.row(i) - of.origin_.transpose()) / of.unit_;
  }

  struct Cell {
    Vec3 centre = Vec3::Zero();
    double radius = 0;  // of its corners
    LocalField field;
    std::vector<int> near;  // clusters, whole or parts of which are near
  };

  bool holds(int query) const { return local_.row(query).cwiseAbs().maxCoeff() <= half_root_cell; }

  Cell root() const { return cell(Vec3::Zero(), std::sqrt(3.0) * half_root_cell, nullptr); }

  /// visit(cell, depth, queries) for the cells that are not divided: those of few queries, and
  /// those with at most `most`.
  template <class Visit>
  void walk(const Cell& cell, int depth, std::size_t most, std::span<const int> some,
            const Visit& visit) const {
    if (some.size() <= most || some.size() < worth_a_cell || cell.near.empty() ||
        depth >= most_deep)
      return visit(cell, depth, some);
    std::array<std::size_t, 9> begin{};
    std::vector<unsigned char> octant(some.size());
    for (std::size_t i = 0; i < some.size(); ++i) {
      octant[i] = octant_of(cell, some[i]);
      ++begin[octant[i] + 1];
    }
    for (int o = 0; o < 8; ++o) begin[o + 1] += begin[o];
    std::vector<int> sorted(some.size());
    auto next = begin;
    for (std::size_t i = 0; i < some.size(); ++i) sorted[next[octant[i]]++] = some[i];
    for (unsigned o = 0; o < 8; ++o) {
      const std::size_t n = begin[o + 1] - begin[o];
      const auto part = std::span<const int>(sorted).subspan(begin[o], n);
      if (n >= worth_a_cell)
        walk(child(cell, o), depth + 1, most, part, visit);
      else if (n > 0)
        visit(cell, most_deep, part);  // too few for a cell of their own
    }
  }

  void sum(const Cell& cell, std::span<const int> some) const {
    for (std::size_t begin = 0; begin < some.size(); begin += winding_lanes)
      sum_group(cell,
                some.subspan(begin, std::min<std::size_t>(winding_lanes, some.size() - begin)));
  }

 private:
  unsigned char octant_of(const Cell& cell, int query) const {
    return (local_(query, 0) >= cell.centre[0] ? 1 : 0) |
           (local_(query, 1) >= cell.centre[1] ? 2 : 0) |
           (local_(query, 2) >= cell.centre[2] ? 4 : 0);
  }
  Cell child(const Cell& parent, unsigned octant) const {
    const double step = parent.radius / std::sqrt(3.0) / 2;
    const Vec3 to(octant & 1u ? step : -step, octant & 2u ? step : -step,
                  octant & 4u ? step : -step);
    return cell(parent.centre + to, parent.radius / 2, &parent);
  }

  void sum_group(const Cell& cell, std::span<const int> some) const {
    const WindingKernels& kernels = winding_kernels();
    const auto share = static_cast<float>(1 / (cell_accuracy * cell_accuracy));
    PointLanes lanes;
    for (std::size_t l = 0; l < winding_lanes; ++l) {
      const auto q = local_.row(some[std::min(l, some.size() - 1)]);
      lanes.x[l] = float((q[0] - cell.centre[0]) / cell.radius);
      lanes.y[l] = float((q[1] - cell.centre[1]) / cell.radius);
      lanes.z[l] = float((q[2] - cell.centre[2]) / cell.radius);
      lanes.sum[l] = 0;
    }
    kernels.add_local(cell.field, lanes);
    for (std::size_t l = 0; l < winding_lanes; ++l) {
      const auto q = local_.row(some[std::min(l, some.size() - 1)]);
      lanes.x[l] = float(q[0]), lanes.y[l] = float(q[1]), lanes.z[l] = float(q[2]);
    }
    std::array<double, winding_lanes> near_sums{};
    struct Visit {
      int cluster;
      unsigned of;
    };
    std::array<Visit, 64> stack;  // a path is at most 32 clusters deep
    for (const int first : cell.near) {
      std::size_t top = 0;
      stack[top++] = {first, (1u << some.size()) - 1};
      while (top > 0) {
        const Visit visit = stack[--top];
        const GroupCluster& cluster = of_.clusters_[visit.cluster];
        unsigned near = kernels.add_where_far(cluster, share, visit.of, lanes);
        if (near == 0) continue;
        if (cluster.child >= 0) {
          stack[top++] = {cluster.child, near};
          stack[top++] = {cluster.child + 1, near};
          continue;
        }
        for (; near != 0; near &= near - 1) {
          const int l = std::countr_zero(near);
          near_sums[l] += of_.leaf_sum(-1 - cluster.child, local_.row(some[l]).data(), false);
        }
      }
    }
    for (std::size_t l = 0; l < some.size(); ++l)
      values_[some[l]] = (lanes.sum[l] + near_sums[l]) / WindingNumber::four_pi;
  }

  Cell cell(const Vec3& centre, double radius, const Cell* parent) const {
    const WindingKernels& kernels = winding_kernels();
    Cell out{centre, radius, {}, {}};
    std::array<PointLanes, n_groups> there = samples().at;
    if (parent) {
      for (PointLanes& lanes : there) move(lanes, (centre - parent->centre) / parent->radius, 0.5);
      for (PointLanes& lanes : there) kernels.add_local(parent->field, lanes);
    }
    for (int g = 0; g < n_groups; ++g) {
      const auto sum = there[g].sum;
      there[g] = samples().at[g];
      move(there[g], centre, radius);
      there[g].sum = sum;
    }
    std::vector<int> open = parent ? parent->near : std::vector<int>{0};
    std::reverse(open.begin(), open.end());
    while (!open.empty()) {
      const int c = open.back();
      open.pop_back();
      const GroupCluster& cluster = of_.clusters_[c];
      const double d = (Vec3(cluster.x, cluster.y, cluster.z) - centre).norm();
      const double R = cluster.radius;
      if (d >= cell_accuracy * R + radius && d >= R + cell_distance * radius) {
        for (PointLanes& lanes : there) kernels.add_field(cluster, lanes);
      } else if (cluster.child >= 0 && R > radius) {
        open.push_back(cluster.child + 1);
        open.push_back(cluster.child);
      } else {
        out.near.push_back(c);
      }
    }
    Eigen::Matrix<float, n_samples, 1> values;
    for (int g = 0; g < n_groups; ++g)
      for (int l = 0; l < winding_lanes; ++l) values[winding_lanes * g + l] = there[g].sum[l];
    const Eigen::Matrix<float, n_terms, 1> terms = samples().fit * values;
    std::copy(terms.data(), terms.data() + dipole_coefficients, out.field.moments.begin());
    out.field.constant = terms[n_terms - 1];
    return out;
  }

  static void move(PointLanes& lanes, const Vec3& to, double by) {
    const auto f = [](double x) { return static_cast<float>(x); };
    for (int l = 0; l < winding_lanes; ++l) {
      lanes.x[l] = f(to[0]) + f(by) * lanes.x[l];
      lanes.y[l] = f(to[1]) + f(by) * lanes.y[l];
      lanes.z[l] = f(to[2]) + f(by) * lanes.z[l];
    }
  }

  const WindingNumber& of_;
  VecX& values_;
  MatX3 local_;  // queries
};

VecX WindingNumber::at(const MatX3& queries, const Task& task) const {
  VecX values(queries.rows());
  const std::vector<int> order = morton_order(queries);
  const auto sum_one_by_one = [&](const std::vector<int>& some) {
    visit_in_order(some, order.size(), task, [&](int i) { values[i] = (*this)(queries.row(i)); });
  };
  if (clusters_.empty()) {
    sum_one_by_one(order);
    return values;
  }
  const WindingCells cells(*this, queries, values);
  std::vector<int> inside, beyond;
  for (const int i : order) (cells.holds(i) ? inside : beyond).push_back(i);
  sum_one_by_one(beyond);
  if (inside.empty()) return values;
  const double done = double(beyond.size()) / double(order.size());

  struct Part {
    WindingCells::Cell cell;
    int depth;
    std::vector<int> queries;
  };
  std::vector<Part> parts;
  cells.walk(cells.root(), 0, most_a_part, inside,
             [&](const WindingCells::Cell& cell, int depth, std::span<const int> some) {
               stop_if_cancelled(task);
               parts.push_back({cell, depth, {some.begin(), some.end()}});
             });
  parallel_for(parts.size(), 1, [&](std::size_t p, std::size_t) {
    task.checkpoint(done + (1 - done) * double(p) / double(parts.size()));
    cells.walk(parts[p].cell, parts[p].depth, 0, parts[p].queries,
               [&](const WindingCells::Cell& cell, int, std::span<const int> some) {
                 cells.sum(cell, some);
               });
  });
  return values;
}

}  // namespace littoral
