#include "solve/direct/ordering.h"

#include <algorithm>
#include <new>
#include <string>
#include <utility>

#include "base/now_and_then.h"
#include "littoral/error.h"
#include "solve/direct/nested_dissection.h"

namespace littoral {

namespace {

template <class Scalar>
Graph graph_of(const Eigen::SparseMatrix<Scalar>& lower, const Task& task) {
  Graph g;
  g.begin.assign(lower.cols() + 1, 0);
  g.weight.assign(lower.cols(), 1);
  auto for_edges = [&](const auto& put) {
    for (int j = 0; j < lower.outerSize(); ++j) {
      stop_now_and_then(j, task);
      for (typename Eigen::SparseMatrix<Scalar>::InnerIterator it(lower, j); it; ++it)
        if (it.row() != j) put(it.row(), j);
    }
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

}  // namespace

template <class Scalar>
Ordering dissection(const Eigen::SparseMatrix<Scalar>& lower, const Task& task) {
  try {
    return nested_dissection(graph_of(lower, task), task);
  } catch (const std::bad_alloc&) {
    throw SolveError("not enough memory to order a matrix of order " + std::to_string(lower.cols()),
                     "too-large");
  }
}

Ordering between_nodes(const Ordering& nodes_order, const Eigen::Ref<const Rows<int, 2>>& nodes) {
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
