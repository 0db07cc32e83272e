#include "methods/regularized/regularized_part.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/beside.h"
#include "base/index.h"
#include "base/taken.h"
#include "littoral/error.h"
#include "methods/regularized/marched_start.h"
#include "methods/regularized/weighted_laplacian.h"
#include "solve/optimization/bounded_values.h"

namespace littoral {

namespace {

constexpr double gap_over_tolerance = 10;  // residuals below the tolerance do not bound the gap
constexpr double most_flops = 1000;  // of a factorization for every number of the factor: beyond,
                                     // as among many tets, a factorization costs more iterations
                                     // than it saves

/// alpha of eq. 11 from alpha-hat (7.1); in space alpha, a length, scales with the cube root of the
/// volume.
double alpha_of(const Regularized& options, Regularizer regularizer, double measure, int dim) {
  const double root = std::pow(measure, 1.0 / dim);
  return options.alpha * (regularizer == Regularizer::hessian ? root * root * root : root);
}

/// What is known as rows: nodes at 0, which are held, then nodes below a bound, which are held by
/// a penalty and lie in cells of their own.
struct Held {
  SpMat rows;  // rows x nodes
  VecX give;   // rows; 0 where held, the reciprocal of the penalty over rho elsewhere

  // Of the bounds, each in the size of its node's share of the domain:
  std::vector<int> node, sign;
  VecX bound, weight, size;
  SpMat bounded;  // bounds x nodes

  Held(const Calculus& C, const KnownDistances& known, const VecX* signs, int dim) {
    std::vector<int> at_zero;
    std::vector<double> distance;
    for (const auto& [i, d] : known) {
      if (C.component[i] < 0) continue;
      if (d <= 1e-9 * std::pow(C.M[i], 1.0 / dim)) {
        at_zero.push_back(i);
        continue;
      }
      node.push_back(i);
      sign.push_back(signs && (*signs)[i] < 0 ? -1 : 1);
      distance.push_back(d);
    }
    const Eigen::Index n = index(node.size()), zeros = index(at_zero.size());
    weight = C.M(node);
    size = weight.array().pow(1.0 / dim);
    bound = Eigen::Map<const VecX>(distance.data(), n).cwiseQuotient(size);
    give = VecX::Zero(zeros + n);
    give.tail(n) = size.cwiseAbs2().cwiseQuotient(weight);
    Triplets entries, of_bounds;
    for (const int i : at_zero) entries.emplace_back(entries.size(), i, 1);
    for (Eigen::Index k = 0; k < n; ++k) {
      entries.emplace_back(entries.size(), node[k], 1);
      of_bounds.emplace_back(k, node[k], 1 / size[k]);
    }
    rows.resize(zeros + n, C.M.size());
    rows.setFromTriplets(entries.begin(), entries.end());
    bounded.resize(n, C.M.size());
    bounded.setFromTriplets(of_bounds.begin(), of_bounds.end());
  }

  VecX within_bounds(VecX u) const {
    for (std::size_t k = 0; k < node.size(); ++k)
      u[node[k]] = sign[k] * std::clamp(sign[k] * u[node[k]], 0.0, bound[k] * size[k]);
    return u;
  }
};

/// The part of the objective that is a function of each cell's gradient, with |grad u| <= 1.
std::unique_ptr<GradientEnergy> cell_energy(Regularizer regularizer, const RegularizerData& data,
                                            double alpha, double beta, int dim) {
  switch (regularizer) {
    case Regularizer::align:
      return std::make_unique<BallQuadraticEnergy>(dim, alpha, alpha * beta, data.V);
    case Regularizer::max_norm:
      return std::make_unique<BallMaxNormEnergy>(alpha, data.frames);
    case Regularizer::dirichlet:
      return std::make_unique<BallQuadraticEnergy>(dim, alpha, 0, VecX());
    case Regularizer::hessian:
      break;
  }
  return std::make_unique<BallQuadraticEnergy>(dim, 0, 0, VecX());
}

VecX times(const SpMat& lower, const VecX& x) { return lower.selfadjointView<Eigen::Lower>() * x; }

void check_data(const Calculus& C, Regularizer regularizer, const RegularizerData& data) {
  if (regularizer == Regularizer::align && data.V.size() != C.G.rows)
    throw InputError(
        "aligned distance needs one direction per face: option field names a file of them",
        "option-value");
  if (regularizer == Regularizer::align && !data.V.allFinite())
    throw InputError("a direction of the field is not finite", "not-finite");
  if (regularizer == Regularizer::max_norm && data.frames.rows() != C.G.rows)
    throw UnsupportedError("the max-norm regularizer needs faces in space");
  if (regularizer == Regularizer::hessian && data.W.rows() != C.L.rows())
    throw UnsupportedError("the Hessian regularizer needs a triangle mesh");
}

/// The entries of a matrix that couples no components, for each of them in its own numbers.
std::vector<SpMat> split_matrix(const SpMat& lower, const std::vector<int>& component,
                                const std::vector<int>& local, const std::vector<int>& sizes) {
  std::vector<Triplets> entries(sizes.size());
  for (int j = 0; j < lower.outerSize(); ++j)
    for (SpMat::InnerIterator it(lower, j); it && component[j] >= 0; ++it)
      if (component[it.row()] == component[j])
        entries[component[j]].emplace_back(local[it.row()], local[j], it.value());
  std::vector<SpMat> out(sizes.size());
  for (std::size_t c = 0; c < sizes.size(); ++c) {
    out[c].resize(sizes[c], sizes[c]);
    out[c].setFromTriplets(entries[c].begin(), entries[c].end());
  }
  return out;
}

/// Throws SolveError where the curved Hessian's energy outweighs the penalty with the wrong sign.
ConstrainedSystem::Constrained with_hessian(const SpMat& matrix, const Calculus& C,
                                            const Held& held, double rho, const Task& task) {
  return ConstrainedSystem(matrix, C.component, C.n_components, task, ConstrainedSystem::Rows::many)
      .constrain(held.rows, task, held.give / rho);
}

/// The least c, to a fifth, with which W + c L is definite where what is known is held.
double least_convex(const SpMat& W, const Calculus& C, const Held& held, const Task& task) {
  const auto definite = [&](double c) {
    try {
      with_hessian(SpMat(W + c * C.L), C, held, c, task);
      return true;
    } catch (const SolveError&) {
      return false;
    }
  };
  double high = 1e-6 * W.diagonal().cwiseAbs().sum() / C.L.diagonal().sum();
  for (int i = 0; i < 30 && !definite(high); ++i) high *= 4;
  double low = high / 4;
  for (int i = 0; i < 3; ++i) {
    const double middle = std::sqrt(low * high);
    (definite(middle) ? high : low) = middle;
  }
  return high;
}

LinearMap as_map(SpRows&& matrix) {
  LinearMap G;
  G.rows = matrix.rows();
  G.cols = matrix.cols();
  const auto A = shared_taken(matrix);
  G.apply = [A](const VecX& u) { return VecX(*A * u); };
  G.matrix = [A] { return *A; };
  return G;
}

/// Cells of each component, by the nodes of their gradients; cells without any are in none.
std::vector<std::vector<int>> cells_of(const Calculus& C, const SpRows& G, int dim) {
  std::vector<std::vector<int>> cells(C.n_components);
  for (int k = 0; k < C.A.size(); ++k) {
    int c = -1;
    for (int r = dim * k; r < dim * (k + 1) && c < 0; ++r)
      for (SpRows::InnerIterator it(G, r); it && c < 0; ++it) c = C.component[it.col()];
    if (c >= 0) cells[c].push_back(k);
  }
  return cells;
}

}  // namespace

RegularizedPart::RegularizedPart(std::shared_ptr<const Calculus> C, Regularizer regularizer,
                                 RegularizerData data, ConstrainedSystem::Rows expected)
    : C_(std::move(C)),
      regularizer_(regularizer),
      data_(std::make_shared<const RegularizerData>(std::move(data))),
      expected_(expected),
      laplacian_(std::make_shared<Kept<ConstrainedSystem>>()) {}

std::shared_ptr<const ConstrainedSystem> RegularizedPart::laplacian(const Task& task) const {
  return laplacian_->get(
      [&] { return ConstrainedSystem(C_->L, C_->component, C_->n_components, task, expected_); });
}

void RegularizedPart::order(const Task& task) const {
  // Of the Hessian there is nothing to order before rho is known.
  if (regularizer_ != Regularizer::hessian) laplacian(task);
}

AdmmResult RegularizedPart::minimize(const KnownDistances& known, const Regularized& options,
                                     AdmmState& state, const Task& task, const VecX* sign) const {
  const Calculus& C = *C_;
  const int dim = C.G.rows / C.A.size();
  const Held held(C, known, sign, dim);
  if (held.rows.rows() == 0) {
    AdmmResult nothing;
    nothing.u = VecX::Zero(C.M.size());
    nothing.converged = true;
    return nothing;
  }
  SplitProblem problem;
  problem.b = C.M;  // A_V
  for (Eigen::Index i = 0; i < C.M.size(); ++i)
    if (C.component[i] < 0) problem.b[i] = 0;
  const double area = problem.b.sum();
  if (sign) problem.b = problem.b.cwiseProduct(*sign);
  const double alpha = alpha_of(options, regularizer_, area, dim);
  // Alg. 1: alpha W + rho W_D = (alpha + rho) W_D, so the factor of W_D serves every penalty. With
  // bounds, which have the penalty rho alone, it does if gradients carry the energy.
  const bool with_bounds = held.bound.size() > 0;
  const bool first_algorithm = regularizer_ == Regularizer::dirichlet && !with_bounds;
  const auto of_gradients =
      cell_energy(regularizer_, *data_, first_algorithm ? 0 : alpha, options.beta, dim);
  const BoundedEnergy energy(*of_gradients, dim, C.A.size(), held.sign, held.bound);
  problem.A.resize(C.A.size() + held.bound.size());
  problem.A << C.A, held.weight;
  problem.dim = dim;
  problem.energy = &energy;
  problem.G = with_bounds ? stacked(C.G.matrix(), held.bounded, dim) : C.G.matrix();
  if (with_bounds) problem.allowed = [&held](VecX u) { return held.within_bounds(std::move(u)); };

  problem.fixed.assign(C.M.size(), 0);
  for (const int i : unknowns_of(held.rows)) problem.fixed[i] = 1;

  AdmmOptions admm_options;
  admm_options.relative = options.tolerance;
  admm_options.absolute = std::min(5e-6, 5e-4 * options.tolerance);
  admm_options.gap = options.gap;
  admm_options.certified = gap_over_tolerance * options.tolerance;
  admm_options.max_iterations = options.max_iterations;

  Task rest = task;
  ConstrainedSystem::Constrained constrained;
  double constrained_rho = -1;  // the penalty for which `constrained` was made; less: it was not
  if (regularizer_ == Regularizer::hessian) {
    SpMat W = alpha * data_->W;
    problem.quadratic = [&W](const VecX& u) { return times(W, u); };
    problem.solve = [&](const VecX& b, double rho) {
      if (rho != constrained_rho) {
        constrained = with_hessian(SpMat(W + rho * C.L), C, held, rho, task);
        constrained_rho = rho;
      }
      return constrained.solve(b);
    };
    admm_options.penalty_changes = 8;
    const AdmmState start = state;
    try {
      return admm(problem, admm_options, state, task);
    } catch (const SolveError&) {
      // On saddles the energy is negative for functions that bend with them, and not convex. More
      // curvature makes it so, and where |grad u| = 1 the same constant is added for all u.
      const double more = least_convex(W, C, held, task);
      W += more * C.L;
      constrained_rho = -1;
      state = start;
      AdmmResult result = admm(problem, admm_options, state, task);
      result.convexified = more / alpha;
      return result;
    }
  } else {
    const double in_quadratic = first_algorithm ? alpha : 0;
    if (in_quadratic > 0)
      problem.quadratic = [&C, alpha](const VecX& u) { return VecX(alpha * times(C.L, u)); };
    std::optional<MarchedStart> near;
    std::optional<Beside> march;  // beside the order of elimination
    if (state.empty() && !sign && dim == 2)
      march.emplace([&](const Task& beside) {
        near = marched_start(problem.G, C.A, problem.b, known, beside);
      });
    const auto system = laplacian(rest.stage(0.1, "factoring"));
    problem.solve = [&, system, in_quadratic](const VecX& b, double rho) {
      if (constrained_rho < 0) {
        constrained = system->constrain(held.rows, task, held.give);
        constrained_rho = rho;
      }
      return VecX(constrained.solve(b) / (in_quadratic + rho));
    };
    admm_options.least = std::max(admm_options.least, alpha / problem.length());
    problem.solve_cells = [&, system, in_quadratic](const VecX& rho,
                                                    const SpRows& D) -> SplitProblem::Solve {
      if (system->flops_of_number(constrained) > most_flops) return nullptr;
      const auto matrix = weighted_laplacian(
          C.L, D, problem.G, VecX(rho.head(C.A.size()).array() + in_quadratic), dim, task);
      if (!matrix) return nullptr;
      VecX give = held.give;
      give.tail(held.bound.size()).array() /= rho.tail(held.bound.size()).array();
      return [weighted = system->constrain_like(constrained, *matrix, held.rows, task, give)](
                 const VecX& b) { return weighted.solve(b); };
    };
    if (march) march->finish(task);
    if (near) start_from(near->flux, alpha, first_algorithm, held.bound, problem);
  }
  return admm(problem, admm_options, state, rest.stage(0.9, "alternating directions"));
}

std::vector<RegularizedPart> regularized_parts(const std::shared_ptr<const Calculus>& C,
                                               Regularizer regularizer, RegularizerData data,
                                               ConstrainedSystem::Rows expected) {
  check_data(*C, regularizer, data);
  std::vector<RegularizedPart> out;
  if (C->n_components <= 1) {
    out.emplace_back(C, regularizer, std::move(data), expected);
    return out;
  }
  const int dim = C->G.rows / C->A.size();
  const SpRows G = C->G.matrix();
  std::vector<std::vector<int>> nodes(C->n_components);
  std::vector<int> local(C->component.size(), -1), sizes;
  for (std::size_t i = 0; i < C->component.size(); ++i)
    if (const int c = C->component[i]; c >= 0) {
      local[i] = int_size(nodes[c]);
      nodes[c].push_back(i);
    }
  for (const auto& of_part : nodes) sizes.push_back(int_size(of_part));
  std::vector<SpMat> L = split_matrix(C->L, C->component, local, sizes), W(sizes.size());
  if (data.W.size() > 0) W = split_matrix(data.W, C->component, local, sizes);
  const std::vector<std::vector<int>> cells = cells_of(*C, G, dim);
  for (std::size_t c = 0; c < sizes.size(); ++c) {
    Calculus part;
    part.L.swap(L[c]);
    part.M = C->M(nodes[c]);
    part.A = C->A(cells[c]);
    part.h = C->h;
    part.component.assign(nodes[c].size(), 0);
    part.n_components = 1;
    RegularizerData of_part;
    of_part.W.swap(W[c]);
    if (data.V.size() > 0) of_part.V.resize(dim * part.A.size());
    if (data.frames.rows() > 0) of_part.frames.resize(dim * part.A.size(), 3);
    Triplets entries;
    for (std::size_t k = 0; k < cells[c].size(); ++k)
      for (int d = 0; d < dim; ++d) {
        const int to = dim * static_cast<int>(k) + d, from = dim * cells[c][k] + d;
        for (SpRows::InnerIterator it(G, from); it; ++it)
          if (C->component[it.col()] == static_cast<int>(c))  // flat cells may have others
            entries.emplace_back(to, local[it.col()], it.value());
        if (data.V.size() > 0) of_part.V[to] = data.V[from];
        if (data.frames.rows() > 0) of_part.frames.row(to) = data.frames.row(from);
      }
    SpRows gradient(dim * part.A.size(), sizes[c]);
    gradient.setFromTriplets(entries.begin(), entries.end());
    part.G = as_map(std::move(gradient));
    out.emplace_back(std::make_shared<const Calculus>(std::move(part)), regularizer,
                     std::move(of_part), expected);
    out.back().nodes = std::move(nodes[c]);
  }
  return out;
}

}  // namespace littoral
