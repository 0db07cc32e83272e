#include "solve/direct/ordering.h"

#include <Eigen/OrderingMethods>
#include <algorithm>
#include <memory>
#include <mutex>
#include <numeric>
#include <utility>

#include "base/platform/process.h"
#include "littoral/error.h"

#if LITTORAL_METIS
#include <metis.h>

static_assert(sizeof(idx_t) == sizeof(int), "METIS with 32-bit indices");
#endif

namespace littoral {

namespace {

/// A graph in compressed rows, without loops; each edge in both directions.
struct Graph {
  std::vector<int> begin, to;
};

template <class Scalar>
Graph graph_of(const Eigen::SparseMatrix<Scalar>& lower) {
  Graph g;
  g.begin.assign(lower.cols() + 1, 0);
  auto for_edges = [&](const auto& put) {
    for (int j = 0; j < lower.outerSize(); ++j)
      for (typename Eigen::SparseMatrix<Scalar>::InnerIterator it(lower, j); it; ++it)
        if (it.row() != j) put(it.row(), j);
  };
  for_edges([&](int i, int j) {
    ++g.begin[i];
    ++g.begin[j];
  });
  int sum = 0;
  for (int& b : g.begin) sum += std::exchange(b, sum);
  g.to.resize(sum);
  std::vector<int> at = g.begin;
  for_edges([&](int i, int j) {
    g.to[at[i]++] = j;
    g.to[at[j]++] = i;
  });
  return g;
}

Ordering dissect(Graph& g) {
  Ordering order(g.begin.size() - 1);
  std::iota(order.begin(), order.end(), 0);
  if (g.to.empty()) return order;
#if LITTORAL_METIS
  static std::mutex one_at_a_time;  // METIS draws from the C library's random numbers, which it
                                    // seeds: two runs at once would draw from each other's
  const std::lock_guard lock(one_at_a_time);
  // METIS puts handlers on SIGTERM and SIGABRT that jump back into METIS from whatever thread the
  // signal meets.
  const KeepSignalHandlers keep;
  std::vector<int> position(order.size());
  idx_t n = static_cast<idx_t>(order.size());
  idx_t options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_SEED] = 1;
  if (METIS_NodeND(&n, g.begin.data(), g.to.data(), nullptr, options, order.data(),
                   position.data()) != METIS_OK)
    throw SolveError("not enough memory to order a matrix of order " + std::to_string(n),
                     "too-large");
#else
  // With its diagonal: Eigen puts every column without one at the end, as it does dense ones.
  const Eigen::Index n = order.size();
  const std::vector<double> ones(g.to.size(), 1.0);
  SpMat full = Eigen::Map<const SpMat>(n, n, g.to.size(), g.begin.data(), g.to.data(), ones.data());
  SpMat I(n, n);
  I.setIdentity();
  full += I;
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> p;
  Eigen::AMDOrdering<int>()(full, p);
  std::copy(p.indices().data(), p.indices().data() + p.size(), order.begin());
#endif
  return order;
}

}  // namespace

template <class Scalar>
Ordering dissection(const Eigen::SparseMatrix<Scalar>& lower, const Task& task) {
  if (lower.cols() < 3) {
    Ordering order(lower.cols());
    std::iota(order.begin(), order.end(), 0);
    return order;
  }
  // The library that finds the order cannot be stopped: it works on its own copy of the graph.
  const auto g = std::make_shared<Graph>(graph_of(lower));
  const auto order = std::make_shared<Ordering>();
  run_abandonable(task, [=] { *order = dissect(*g); });
  return std::move(*order);
}

Ordering between_nodes(const Ordering& nodes_order, const Rows<int, 2>& nodes) {
  const int n_nodes = nodes_order.size();
  std::vector<int> position(nodes_order.size());
  for (int k = 0; k < n_nodes; ++k) position[nodes_order[k]] = k;
  std::vector<int> begin(nodes_order.size() + 1, 0), first(nodes.rows());
  for (Eigen::Index i = 0; i < nodes.rows(); ++i) {
    first[i] = std::min(position[nodes(i, 0)], position[nodes(i, 1)]);
    ++begin[first[i]];
  }
  int sum = 0;
  for (int& b : begin) sum += std::exchange(b, sum);
  Ordering order(first.size());
  for (std::size_t i = 0; i < first.size(); ++i) order[begin[first[i]]++] = i;
  return order;
}

Ordering in_blocks(const Ordering& order, int block) {
  Ordering out;
  out.reserve(order.size() * block);
  for (int i : order)
    for (int k = 0; k < block; ++k) out.push_back(i * block + k);
  return out;
}

template Ordering dissection(const SpMat&, const Task&);
template Ordering dissection(const SpMatC&, const Task&);

}  // namespace littoral
