#include "methods/quadratic/quadratic_program.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <queue>

#include "base/index.h"
#include "base/parallel.h"

namespace littoral {

namespace {

/// Squared length of a vector given by differences of barycentrics, from the edge lengths.
template <int D>
double squared_length(const P2Elements<D>& E, int element,
                      const typename P2Shape<D>::Point& difference) {
  using Shape = P2Shape<D>;
  double sum = 0;
  for (int k = 0; k < Shape::edges; ++k) {
    const auto [i, j] = Shape::edge(k);
    const double l = E.side[element][k];
    sum -= difference[i] * difference[j] * l * l;
  }
  return std::max(0.0, sum);
}

/// A source in one of the elements that contain it, by the part's number.
template <int D>
struct Touched {
  int element;
  P2Point<D> point;
  double distance;  // there, at most
};

/// Distance from the sources to the part's nodes along edges (Dijkstra); a middle node takes the
/// mean of its ends.
template <int D>
VecX distance_along_edges(const P2Elements<D>& E, const QuadraticPart<D>& part,
                          const std::vector<Touched<D>>& sources) {
  using Shape = P2Shape<D>;
  const auto n = part.nodes.size();
  std::vector<int> first(n + 1, 0);
  std::vector<std::pair<int, double>> neighbour;
  auto each_edge = [&](auto&& visit) {
    for (std::size_t e = 0; e < part.elements.size(); ++e)
      for (int k = 0; k < Shape::edges; ++k) {
        const auto [i, j] = Shape::edge(k);
        visit(part.local_node[e][i], part.local_node[e][j], E.side[part.elements[e]][k]);
      }
  };
  each_edge([&](int a, int b, double) { ++first[a + 1], ++first[b + 1]; });
  for (std::size_t v = 0; v < n; ++v) first[v + 1] += first[v];
  neighbour.resize(first[n]);
  std::vector<int> next(first.begin(), first.end() - 1);
  each_edge([&](int a, int b, double length) {
    neighbour[next[a]++] = {b, length};
    neighbour[next[b]++] = {a, length};
  });

  VecX d = VecX::Constant(n, infinity);
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  auto reach = [&](int v, double distance) {
    if (distance >= d[v]) return;
    d[v] = distance;
    queue.emplace(distance, v);
  };
  for (const auto& [e, point, before] : sources)
    for (int i = 0; i < Shape::corners; ++i)
      reach(part.local_node[e][i],
            before + std::sqrt(squared_length(E, point.element, Shape::corner(i) - point.b)));
  while (!queue.empty()) {
    const auto [distance, v] = queue.top();
    queue.pop();
    if (distance > d[v]) continue;
    for (int k = first[v]; k < first[v + 1]; ++k)
      reach(neighbour[k].first, distance + neighbour[k].second);
  }
  for (const auto& node : part.local_node)
    for (int k = 0; k < Shape::edges; ++k) {
      const auto [i, j] = Shape::edge(k);
      d[node[Shape::corners + k]] = 0.5 * (d[node[i]] + d[node[j]]);
    }
  if (d.maxCoeff() > 0) return d;
  // Every vertex is a source: all that is left lies between them.
  for (std::size_t e = 0; e < part.elements.size(); ++e)
    for (int k = 0; k < Shape::edges; ++k)
      d[part.local_node[e][Shape::corners + k]] = 0.5 * E.side[part.elements[e]][k];
  return d;
}

/// Points whose barycentrics are quarters, without the nodes.
template <int D>
std::vector<typename P2Shape<D>::Point> quarter_points() {
  std::vector<typename P2Shape<D>::Point> points;
  int codes = 1;
  for (int d = 0; d < D; ++d) codes *= 5;
  for (int code = 0; code < codes; ++code) {
    std::array<int, D + 1> quarters{4};
    bool node = true;
    for (int d = 1, rest = code; d <= D; ++d, rest /= 5) {
      quarters[d] = rest % 5;
      quarters[0] -= quarters[d];
      node = node && quarters[d] % 2 == 0;
    }
    if (node || quarters[0] < 0) continue;
    points.emplace_back();
    for (int i = 0; i <= D; ++i) points.back()[i] = 0.25 * quarters[i];
  }
  return points;
}

/// Whether a quadratic has no negative coefficient as a form in barycentrics, so that it is nowhere
/// negative.
template <int D>
bool is_positive_form(const typename P2Shape<D>::Values& s) {
  using Shape = P2Shape<D>;
  for (int i = 0; i < Shape::corners; ++i)
    if (!(s[i] >= 0)) return false;
  for (int k = 0; k < Shape::edges; ++k) {
    const auto [i, j] = Shape::edge(k);
    if (!(4 * s[Shape::corners + k] >= s[i] + s[j])) return false;
  }
  return true;
}

/// Value and slopes on the element whose corners are 0 and the unit vectors.
template <int D>
typename QuadraticProgram<D>::Program::Point reference_rows(const typename P2Shape<D>::Point& b) {
  typename P2Shape<D>::Gradients grad;
  grad << -Eigen::Matrix<double, D, 1>::Ones(), Eigen::Matrix<double, D, D>::Identity();
  return {P2Shape<D>::values(b), P2Shape<D>::slopes(b, grad)};
}

}  // namespace

template <int D>
std::vector<QuadraticPart<D>> quadratic_parts(const P2Elements<D>& E) {
  std::vector<QuadraticPart<D>> parts(E.n_components);
  std::vector<double> measure(parts.size(), 0);
  std::vector<int> number(E.n_nodes(), -1);
  for (int e = 0; e < E.n_elements(); ++e) {
    const int c = E.component[E.node[e][0]];
    QuadraticPart<D>& part = parts[c];
    measure[c] += E.measure[e];
    std::array<int, P2Shape<D>::nodes> local{};
    for (int i = 0; i < P2Shape<D>::nodes; ++i) {
      int& k = number[E.node[e][i]];
      if (k < 0) {
        k = part.nodes.size();
        part.nodes.push_back(E.node[e][i]);
      }
      local[i] = k;
    }
    part.elements.push_back(e);
    part.local_node.push_back(local);
  }
  for (std::size_t c = 0; c < parts.size(); ++c) {
    parts[c].scale = std::pow(measure[c], 1.0 / D);
    parts[c].h = E.component_h[c];
  }
  return parts;
}

template <int D>
std::pair<double, typename P2Shape<D>::Point> p2_minimum(const typename P2Shape<D>::Values& s) {
  // As a form b^T H b in barycentrics (which sum to 1); on the face of the simplex spanned by
  // corners S its stationary point is H_S^{-1} 1 over its sum, with the value 1 / sum.
  using Shape = P2Shape<D>;
  Eigen::Matrix<double, D + 1, D + 1> H = s.template head<D + 1>().asDiagonal();
  for (int k = 0; k < Shape::edges; ++k) {
    const auto [i, j] = Shape::edge(k);
    H(i, j) = H(j, i) = 2 * s[Shape::corners + k] - 0.5 * (s[i] + s[j]);
  }
  std::pair<double, typename Shape::Point> best{infinity, Shape::centre()};
  for (int i = 0; i < Shape::corners; ++i)
    if (s[i] < best.first) best = {s[i], Shape::corner(i)};
  for (int set = 1; set < 1 << Shape::corners; ++set) {
    std::array<int, D + 1> corner{};
    int n = 0;
    for (int i = 0; i < Shape::corners; ++i)
      if (set >> i & 1) corner[n++] = i;
    if (n < 2) continue;
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, D + 1, D + 1> A(n, n);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) A(i, j) = H(corner[i], corner[j]);
    const Eigen::Matrix<double, Eigen::Dynamic, 1, 0, D + 1, 1> x =
        A.partialPivLu().solve(decltype(x)::Ones(n));
    const double sum = x.sum();
    typename Shape::Point b = Shape::Point::Zero();
    bool inside = std::isfinite(sum) && sum != 0;
    for (int i = 0; i < n && inside; ++i) {
      b[corner[i]] = x[i] / sum;
      inside = b[corner[i]] > 0;
    }
    if (inside && 1 / sum < best.first) best = {b.dot(H * b), b};
  }
  return best;
}

template <int D>
int QuadraticProgram<D>::local(int element) const {
  const auto at = std::lower_bound(part_.elements.begin(), part_.elements.end(), element);
  const bool found = at != part_.elements.end() && *at == element;
  return found ? static_cast<int>(at - part_.elements.begin()) : -1;
}

template <int D>
double QuadraticProgram<D>::cap(double distance, double radius) const {
  return (radius * radius + distance * distance) / (part_.scale * part_.scale);
}

template <int D>
QuadraticProgram<D>::QuadraticProgram(const P2Elements<D>& E, const QuadraticPart<D>& part,
                                      const std::vector<P2Source<D>>& sources, double radius)
    : E_(E),
      part_(part),
      curve_inside_(part.elements.size(), 0),
      crowded_(part.elements.size(), 0) {
  using Shape = P2Shape<D>;
  std::vector<Touched<D>> touched;
  PointsInside inside;
  int count = 0;
  for (const P2Source<D>& source : sources) {
    const std::size_t before = touched.size();
    for (const P2Point<D>& point : source.where) {
      const int e = local(point.element);
      if (e < 0) continue;
      touched.push_back({e, point, source.distance});
      if (source.on_curve)
        curve_inside_[e] = 1;
      else
        inside[e].push_back(point.b);
    }
    if (touched.size() > before) ++count;
  }
  if (touched.empty()) return;
  alone_ = count == 1;
  d_ = distance_along_edges(E, part, touched) / part.scale;

  // Objective: the integral of u, over the part's measure.
  const VecX integral = E.integral();
  program_.c.resize(part.nodes.size());
  for (std::size_t i = 0; i < part.nodes.size(); ++i)
    program_.c[i] = integral[part.nodes[i]] / std::pow(part.scale, D);

  if (D == 2) find_crowded(inside, radius);
  for (const P2Source<D>& source : sources)
    for (const P2Point<D>& point : source.where) {
      const int e = local(point.element);
      if (e < 0 || (crowded_[e] && !source.on_curve)) continue;
      program_.caps.push_back({e, cap(source.distance, radius), Shape::values(point.b)});
      break;
    }
  add_samples(sources, inside);
}

template <int D>
void QuadraticProgram<D>::find_crowded(const PointsInside& inside, double radius) {
  using Shape = P2Shape<D>;
  for (const auto& [e, points] : inside) {
    if (points.size() == 1 && !curve_inside_[e]) continue;
    crowded_[e] = 1;
    const auto& node = part_.local_node[e];
    for (int i = 0; i < Shape::nodes; ++i) {
      const bool corner = i < Shape::corners;
      const typename Shape::Point b = corner ? Shape::corner(i) : Shape::middle(i - Shape::corners);
      const auto to = [&, element = part_.elements[e]](const typename Shape::Point& other) {
        return std::sqrt(squared_length(E_, element, other - b));
      };
      double distance = infinity;
      for (const auto& point : points) distance = std::min(distance, to(point));
      for (int k = 0; k < Shape::corners; ++k)
        distance = std::min(distance, d_[node[k]] * part_.scale + to(Shape::corner(k)));
      if (!corner) d_[node[i]] = distance / part_.scale;
      program_.caps.push_back({e, cap(distance, radius), Shape::values(b)});
    }
  }
  // The integral of a quadratic over a triangle does not depend on its corners: without a weight of
  // their own they give way to other nodes.
  constexpr double urgent = 30;
  for (const auto& [e, points] : inside)
    for (int i = 0; i < Shape::corners && crowded_[e]; ++i)
      program_.c[part_.local_node[e][i]] +=
          urgent * E_.measure[part_.elements[e]] / std::pow(part_.scale, D);
}

template <int D>
void QuadraticProgram<D>::add_samples(const std::vector<P2Source<D>>& sources,
                                      const PointsInside& inside) {
  using Shape = P2Shape<D>;
  // The nodes and the centre of each element (section 5), and a source that is alone in its
  // elements: without a sample there, its elements are not exact in the plane.
  std::vector<typename Shape::Point> points;
  for (int i = 0; i < Shape::corners; ++i) points.push_back(Shape::corner(i));
  for (int k = 0; k < Shape::edges; ++k) points.push_back(Shape::middle(k));
  points.push_back(Shape::centre());
  const int usual = int_size(points);
  for (const auto& b : points) program_.points.push_back(reference_rows<D>(b));
  // Where several points are inside, u >= 0 at the nodes alone.
  for (int i = 0; i < Shape::nodes; ++i) {
    program_.points.push_back({Shape::values(points[i]), {}});
    program_.points.back().g.fill(Program::Row::Zero());
  }
  for (std::size_t e = 0; e < part_.elements.size(); ++e) {
    program_.transform.push_back(E_.grad[part_.elements[e]].template rightCols<D>() * part_.scale);
    program_.weight.push_back(E_.measure[part_.elements[e]]);
    const int element = e;
    for (int i = 0; i < (crowded_[e] ? Shape::nodes : usual); ++i)
      program_.samples.push_back({element, crowded_[e] ? usual + i : i, size(element, points[i])});
  }
  for (const P2Source<D>& source : sources) {
    if (source.on_curve) continue;
    for (const P2Point<D>& point : source.where) {
      const int e = local(point.element);
      const bool lone = e >= 0 && !crowded_[e] && !curve_inside_[e] && inside.at(e).size() == 1;
      if (!lone || point.b.maxCoeff() >= 1) continue;
      program_.samples.push_back({e, int_size(program_.points), size(e, point.b)});
      program_.points.push_back(reference_rows<D>(point.b));
    }
  }
}

template <int D>
double QuadraticProgram<D>::size(int local, const typename P2Shape<D>::Point& b) const {
  double d = 0;
  for (int i = 0; i < P2Shape<D>::corners; ++i) d += b[i] * d_[part_.local_node[local][i]];
  return std::pow(std::max(d, 0.5 * part_.h / part_.scale), 2);
}

template <int D>
VecX QuadraticProgram<D>::start() const {
  return 0.6 * d_.cwiseAbs2();
}

template <int D>
std::vector<typename QuadraticProgram<D>::Program::Inserted> QuadraticProgram<D>::violated(
    const VecX& u, double allowed) const {
  using Shape = P2Shape<D>;
  using Found = std::vector<typename Program::Inserted>;
  const double h2 = std::pow(part_.h / part_.scale, 2);
  const auto look_at = [&](std::size_t e, Found& found) {
    const auto insert = [&, element = static_cast<int>(e)](const typename Shape::Point& b) {
      found.push_back({element, reference_rows<D>(b), size(element, b)});
    };
    if (curve_inside_[e] || crowded_[e]) return;
    typename Shape::Values local;
    for (int i = 0; i < Shape::nodes; ++i) local[i] = u[part_.local_node[e][i]];
    const typename Shape::Gradients grad = E_.grad[part_.elements[e]] * part_.scale;
    typename Shape::Values slack;
    const auto slack_at = [&](const typename Shape::Point& b) {
      double squared = 0;
      for (const auto& g : Shape::slopes(b, grad)) squared += std::pow(g.dot(local), 2);
      return Shape::values(b).dot(local) - 0.25 * squared;
    };
    for (int i = 0; i < Shape::corners; ++i) slack[i] = slack_at(Shape::corner(i));
    for (int k = 0; k < Shape::edges; ++k) slack[Shape::corners + k] = slack_at(Shape::middle(k));
    if (is_positive_form<D>(slack)) return;
    const auto [least, b] = p2_minimum<D>(slack);
    // Next to a lone source, where u is small, a dip of v moves the source by sqrt(v).
    const double least_u = (alone_ ? 1e-3 : 1) * h2;
    if (least >= -allowed * (std::abs(Shape::values(b).dot(local)) + least_u)) return;
    insert(b);
    for (const auto& point : quarter_points<D>()) insert(point);
  };
  constexpr std::size_t grain = 1024;
  const std::size_t n = part_.elements.size();
  std::vector<Found> pieces((n + grain - 1) / grain);
  parallel_for(n, grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) look_at(e, pieces[begin / grain]);
  });
  Found all;
  for (const Found& piece : pieces) all.insert(all.end(), piece.begin(), piece.end());
  return all;
}

template std::vector<QuadraticPart<2>> quadratic_parts(const P2Elements<2>&);
template std::vector<QuadraticPart<3>> quadratic_parts(const P2Elements<3>&);
template std::pair<double, P2Shape<2>::Point> p2_minimum<2>(const P2Shape<2>::Values&);
template std::pair<double, P2Shape<3>::Point> p2_minimum<3>(const P2Shape<3>::Values&);
template class QuadraticProgram<2>;
template class QuadraticProgram<3>;

}  // namespace littoral
