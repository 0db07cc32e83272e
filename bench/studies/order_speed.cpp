// Orders of elimination: time of the order and of the factors of the scalar and the vector system
// that follow from it, entries and multiply-adds of these, beside METIS where it is installed.
//
// usage: littoral_order_speed [--rounds N] SURFACE|TETS|faces:TETS|torus:N...
// TETS: their vertices' system alone, faces:TETS that of their faces; torus:N: N nodes around the
// tube and 5 N / 2 along it
// prints Markdown; medians of processor time on one thread, orders by turns

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <iostream>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "domain/intrinsic/intrinsic_triangulation.h"
#include "littoral/littoral.h"
#include "operators/tet_operators.h"
#include "operators/triangles.h"
#include "solve/direct/cholesky.h"
#include "solve/direct/ordering.h"
#include "test_meshes.h"
#if LITTORAL_METIS
#include <metis.h>
#endif

using namespace littoral;

namespace {

/// Positive definite matrices with the patterns of a domain's systems.
struct Systems {
  SpMat scalar;
  SpMatC vector;      // no rows where there is none
  Rows<int, 2> ends;  // of its unknowns
};

template <class Scalar>
Eigen::SparseMatrix<Scalar> raised(Eigen::SparseMatrix<Scalar> lower) {
  for (int j = 0; j < lower.outerSize(); ++j)
    for (typename Eigen::SparseMatrix<Scalar>::InnerIterator it(lower, j); it; ++it)
      if (it.row() == j) it.valueRef() += 1e-3 * std::abs(it.value()) + 1e-9;
  return lower;
}

Systems systems_of(const SurfaceMesh& mesh) {
  Report report;
  const Operators ops = triangle_operators(intrinsic_triangulation(mesh, report));
  return {raised(ops.scalar.L), raised(ops.vector.L({})), ops.vector.ends.matrix()};
}

Systems systems_of(const std::string& name) {
  if (name.rfind("torus:", 0) == 0) {
    const int n = std::atoi(name.c_str() + 6);
    return systems_of(SurfaceMesh(test::torus_soup(5 * n / 2, n)));
  }
  if (name.rfind("faces:", 0) == 0)
    return {raised(tet_operators(read_tets(name.substr(6))).face_laplacian), {}, {}};
  if (name.ends_with(".mesh") || name.ends_with(".msh"))
    return {raised(tet_operators(read_tets(name)).L), {}, {}};
  return systems_of(SurfaceMesh(read_mesh(name).soup()));
}

using Order = std::function<Ordering(const SpMat&)>;

#if LITTORAL_METIS
Ordering metis_order(const SpMat& lower) {
  const SpMat full = lower.selfadjointView<Eigen::Lower>();
  std::vector<int> begin{0}, to;
  for (int j = 0; j < full.outerSize(); ++j) {
    for (SpMat::InnerIterator it(full, j); it; ++it)
      if (it.row() != j) to.push_back(static_cast<int>(it.row()));
    begin.push_back(static_cast<int>(to.size()));
  }
  idx_t n = static_cast<idx_t>(full.cols());
  Ordering order(n), position(n);
  idx_t options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_SEED] = 1;
  METIS_NodeND(&n, begin.data(), to.data(), nullptr, options, order.data(), position.data());
  return order;
}
#endif

double seconds_of(const std::function<void()>& work) {
  const std::clock_t start = std::clock();
  work();
  return double(std::clock() - start) / CLOCKS_PER_SEC;
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

struct Times {
  std::vector<double> order, analysis, scalar, vector;
};

void round(const Systems& systems, const Order& find, Times& times) {
  Ordering order;
  times.order.push_back(seconds_of([&] { order = find(systems.scalar); }));
  std::shared_ptr<const Elimination> E, EV;
  times.analysis.push_back(
      seconds_of([&] { E = std::make_shared<const Elimination>(systems.scalar, order); }));
  times.scalar.push_back(seconds_of([&] { Cholesky<double>(systems.scalar, E, {}); }));
  if (systems.vector.rows() == 0) return times.vector.push_back(0);
  EV = std::make_shared<const Elimination>(systems.vector, between_nodes(order, systems.ends));
  times.vector.push_back(seconds_of([&] { Cholesky<Complex>(systems.vector, EV, {}); }));
}

void print(const std::string& name, const std::string& by, const Systems& systems,
           const Order& find, const Times& t) {
  const Ordering order = find(systems.scalar);
  const Elimination E(systems.scalar, order);
  std::cout.precision(3);
  std::cout << "| " << name.substr(name.rfind('/') + 1) << " | " << E.n << " | " << by << " | "
            << median(t.order) << " | " << median(t.analysis) << " | " << median(t.scalar) << " | "
            << median(t.vector) << " | " << median(t.order) + median(t.scalar) + median(t.vector)
            << " | " << 1e-6 * double(E.values()) << " | " << 1e-6 * E.flops() << " | ";
  if (systems.vector.rows() > 0) {
    const Elimination EV(systems.vector, between_nodes(order, systems.ends));
    std::cout << 1e-6 * double(EV.values()) << " | " << 1e-6 * EV.flops();
  } else {
    std::cout << " | ";
  }
  std::cout << " |" << std::endl;
}

}  // namespace

int main(int argc, char** argv) {
  int rounds = 3;
  std::vector<std::string> names;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--rounds" && i + 1 < argc)
      rounds = std::max(1, std::atoi(argv[++i]));
    else
      names.push_back(word);
  }
  if (names.empty())
    return std::cerr
               << "usage: littoral_order_speed [--rounds N] SURFACE|TETS|faces:TETS|torus:N...\n",
           2;
  set_thread_count(1);
  std::vector<std::pair<std::string, Order>> orders{
      {"littoral", [](const SpMat& A) { return dissection(A, {}); }}};
#if LITTORAL_METIS
  orders.emplace_back("METIS", metis_order);
#endif
  std::cout << "| mesh | nodes | order by | order, s | analysis | scalar factor | vector factor | "
               "order and factors | entries, M | multiply-adds, M | of vectors | |\n"
               "|---|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (const std::string& name : names) try {
      const Systems systems = systems_of(name);
      std::vector<Times> times(orders.size());
      for (int k = 0; k < rounds; ++k)
        for (std::size_t o = 0; o < orders.size(); ++o) round(systems, orders[o].second, times[o]);
      for (std::size_t o = 0; o < orders.size(); ++o)
        print(name, orders[o].first, systems, orders[o].second, times[o]);
    } catch (const Error& error) {
      std::cerr << name << ": " << error.what() << "\n";
    }
}
