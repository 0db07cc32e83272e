#include "operators/triangles.h"

#include <algorithm>
#include <array>
#include <functional>
#include <memory>
#include <utility>

#include "base/disjoint_sets.h"
#include "base/fetch_ahead.h"
#include "base/index.h"
#include "base/large_vector.h"
#include "base/now_and_then.h"
#include "base/parallel.h"
#include "operators/connection_laplacian.h"
#include "operators/sum_over_triangles.h"

namespace littoral {

namespace {

using Triangulation = std::shared_ptr<const IntrinsicTriangulation>;
constexpr std::size_t face_grain = 8192;

/// Adds a third of every triangle's area A to the M of each of its three unknowns.
void add_thirds(const VecX& A, const Eigen::Ref<const MatX3i>& unknowns, VecX& M) {
  constexpr Eigen::Index ahead = 12;  // triangles: unknowns are met in any order
  for (Eigen::Index f = 0; f < A.size(); ++f)
    for (int k = 0; k < 3; ++k) {
      if (f + ahead < A.size()) fetch_ahead(&M[unknowns(f + ahead, k)]);
      M[unknowns(f, k)] += A[f] / 3;
    }
}

/// Cotan Laplacian (eq. 10), lower triangle.
SpMat cotan_laplacian(const IntrinsicTriangulation& T, const Task& task) {
  return sum_over_triangles<double>(
      T.n_vertices, T.faces.matrix(),
      [&](int f) {
        const auto cot = T.shape(f).cot;
        TriangleTerms<double> terms;
        for (int k = 0; k < 3; ++k) {
          terms.diagonal[k] = 0.5 * (cot[(k + 1) % 3] + cot[(k + 2) % 3]);
          terms.beside[k] = -0.5 * cot[(k + 2) % 3];
        }
        return terms;
      },
      task);
}

/// Gradient of the hat function of corner k: the opposite side turned inward, over twice the area.
Complex hat_gradient(const IntrinsicTriangulation& T, const TriangleShape& t, int f, int k) {
  const Complex opposite = t.p[(k + 2) % 3] - t.p[(k + 1) % 3];
  return Complex(0, T.orientation[f]) * opposite / (2 * t.area);
}

/// Three complex numbers of every face, kept where that takes little memory.
template <class Compute>
class PerFace {
 public:
  PerFace(const IntrinsicTriangulation& T, Compute compute) : compute_(std::move(compute)) {
    constexpr int most_kept = 2'000'000;
    if (T.n_faces() > most_kept) return;
    kept_.resize(T.n_faces());
    parallel_for(kept_.size(), face_grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t f = begin; f < end; ++f) {
        const std::array<Complex, 3> z = compute_(f);
        for (int k = 0; k < 3; ++k) kept_[f][k] = {z[k].real(), z[k].imag()};
      }
    });
  }
  std::array<Complex, 3> operator()(int f) const {
    if (kept_.empty()) return compute_(f);
    std::array<Complex, 3> z;
    for (int k = 0; k < 3; ++k) z[k] = {kept_[f][k].re, kept_[f][k].im};
    return z;
  }

 private:
  struct Parts {  // which, unlike a Complex, need not be cleared
    double re, im;
  };
  Compute compute_;
  UnclearedVector<std::array<Parts, 3>> kept_;  // large pages are left to factors
};

template <class Compute>
auto per_face(const IntrinsicTriangulation& T, Compute compute) {
  return std::make_shared<const PerFace<Compute>>(T, std::move(compute));
}

/// The same for all faces: rows 2 f and 2 f + 1 hold the parts of face f's gradient.
SpRows gradient_matrix(const IntrinsicTriangulation& T) {
  SpRows G(2 * T.n_faces(), T.n_vertices);
  G.resizeNonZeros(6 * Eigen::Index{T.n_faces()});
  int* begin = G.outerIndexPtr();
  begin[2 * T.n_faces()] = 6 * T.n_faces();
  parallel_for(T.n_faces(), face_grain, [&](std::size_t first, std::size_t end) {
    for (std::size_t s = first; s < end; ++s) {
      const int f = s;
      const TriangleShape t = T.shape(f);
      std::array<int, 3> corner = {0, 1, 2};
      std::sort(corner.begin(), corner.end(),
                [&](int a, int b) { return T.faces(f, a) < T.faces(f, b); });
      for (int d = 0; d < 2; ++d) begin[2 * f + d] = 6 * f + 3 * d;
      for (int k = 0; k < 3; ++k) {
        const Complex g = hat_gradient(T, t, f, corner[k]);
        for (int d = 0; d < 2; ++d) {
          G.innerIndexPtr()[6 * f + 3 * d + k] = T.faces(f, corner[k]);
          G.valuePtr()[6 * f + 3 * d + k] = d == 0 ? g.real() : g.imag();
        }
      }
    }
  });
  return G;
}

LinearMap gradient(Triangulation T) {
  const auto hats = per_face(*T, [T](int f) {
    const TriangleShape t = T->shape(f);
    return std::array{hat_gradient(*T, t, f, 0), hat_gradient(*T, t, f, 1),
                      hat_gradient(*T, t, f, 2)};
  });
  LinearMap G;
  G.rows = 2 * T->n_faces();
  G.cols = T->n_vertices;
  G.apply = [T, hats](const VecX& u) {
    VecX g(2 * T->n_faces());
    parallel_for(T->n_faces(), face_grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t s = begin; s < end; ++s) {
        const int f = s;
        const auto hat = (*hats)(f);
        Complex z = 0;
        for (int k = 0; k < 3; ++k) z += u[T->faces(f, k)] * hat[k];
        g[2 * f] = z.real();
        g[2 * f + 1] = z.imag();
      }
    });
    return g;
  };
  G.adjoint = [T, hats](const VecX& g) {
    VecX u = VecX::Zero(T->n_vertices);
    const auto find = [&](int f) {
      const auto hat = (*hats)(f);
      std::array<double, 3> terms;
      for (int k = 0; k < 3; ++k)
        terms[k] = hat[k].real() * g[2 * f] + hat[k].imag() * g[2 * f + 1];
      return terms;
    };
    add_in_order(T->n_faces(), find, [&](int f, const std::array<double, 3>& terms) {
      for (int k = 0; k < 3; ++k) u[T->faces(f, k)] += terms[k];
    });
    return u;
  };
  G.matrix = [T] { return gradient_matrix(*T); };
  return G;
}

/// Mean of the three edge vectors of a face, in the face's frame (section 6).
LinearMap edges_to_faces(Triangulation T) {
  const auto edges = per_face(*T, [T](int f) {
    const TriangleShape t = T->shape(f);
    return std::array<Complex, 3>{T->edge_in_face(t, f, 0), T->edge_in_face(t, f, 1),
                                  T->edge_in_face(t, f, 2)};
  });
  LinearMap P;
  P.rows = 2 * T->n_faces();
  P.cols = 2 * T->n_edges();
  P.apply = [T, edges](const VecX& X) {
    VecX Y(2 * T->n_faces());
    parallel_for(T->n_faces(), face_grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t s = begin; s < end; ++s) {
        const int f = s;
        const auto edge = (*edges)(f);
        double x = 0, y = 0;
        for (int k = 0; k < 3; ++k) {
          const int e = T->side_edge(f, k);
          const double re = X[2 * e], im = T->seam(f, k) ? -X[2 * e + 1] : X[2 * e + 1];
          x += re * edge[k].real() - im * edge[k].imag();
          y += re * edge[k].imag() + im * edge[k].real();
        }
        Y[2 * f] = x / 3;
        Y[2 * f + 1] = y / 3;
      }
    });
    return Y;
  };
  return P;
}

/// Pieces of edges connected through faces, and the vertices where several of them touch.
void find_pieces(const IntrinsicTriangulation& T, VectorDiffusion& V) {
  DisjointSets edges(T.n_edges());
  for (int f = 0; f < T.n_faces(); ++f)
    for (int k = 1; k < 3; ++k) edges.join(T.side_edge(f, 0), T.side_edge(f, k));
  V.piece = edges.numbered(V.n_pieces, {T.edge_use.begin(), T.edge_use.end()});
  if (V.n_pieces == T.n_components) return;  // nothing touches at vertices only

  std::vector<int> seen(T.n_vertices, -1);
  std::vector<char> pinched(T.n_vertices, 0);
  for (int f = 0; f < T.n_faces(); ++f)
    for (int k = 0; k < 3; ++k) {
      const int v = T.faces(f, k), p = V.piece[T.side_edge(f, 0)];
      if (seen[v] >= 0 && seen[v] != p) pinched[v] = 1;
      seen[v] = p;
    }
  std::vector<std::array<int, 4>> list;  // vertex, piece, face, corner
  for (int f = 0; f < T.n_faces(); ++f)
    for (int k = 0; k < 3; ++k)
      if (pinched[T.faces(f, k)]) list.push_back({T.faces(f, k), V.piece[T.side_edge(f, 0)], f, k});
  std::sort(list.begin(), list.end());
  for (std::size_t i = 0; i < list.size();) {
    std::vector<PointInFace> where;
    std::size_t j = i;
    for (; j < list.size() && list[j][0] == list[i][0] && list[j][1] == list[i][1]; ++j) {
      PointInFace corner{list[j][2], {0, 0, 0}};
      corner.b[list[j][3]] = 1;
      where.push_back(corner);
    }
    Pinch pinch{list[i][0], list[i][1], {}};
    add_radial_measure(T, where, 1, pinch.radial);
    V.pinches.push_back(std::move(pinch));
    i = j;
  }
}

using Jobs = std::vector<std::function<void()>>;

/// Makes C and does what else is to be done, which may read C.A: on whatever threads are free.
void make_calculus(const Triangulation& T, const Task& task, const Jobs& others, Calculus& C) {
  C.h = T->mean_edge_length;
  C.n_components = T->n_components;
  C.A.resize(T->n_faces());
  parallel_for(T->n_faces(), face_grain, [&](std::size_t begin, std::size_t end) {
    for (Eigen::Index f = index(begin); f < index(end); ++f)
      C.A[f] = area_of_lengths(T->length(f, 0), T->length(f, 1), T->length(f, 2));
  });
  Jobs jobs{[&] { C.L = cotan_laplacian(*T, task); },  // the longest
            [&] { C.G = gradient(T); },
            [&] {
              C.M = VecX::Zero(T->n_vertices);
              add_thirds(C.A, T->faces.matrix(), C.M);
              C.component = T->component;
              C.boundary.assign(T->n_vertices, 0);
              for (int e = 0; e < T->n_edges(); ++e)
                if (T->edge_use[e] == 1)
                  C.boundary[T->edges(e, 0)] = C.boundary[T->edges(e, 1)] = 1;
            }};
  jobs.insert(jobs.end(), others.begin(), others.end());
  parallel_for(jobs.size(), 1, [&](std::size_t j, std::size_t) {
    stop_if_cancelled(task);
    jobs[j]();
  });
}

}  // namespace

void add_radial_measure(const IntrinsicTriangulation& T, std::span<const PointInFace> where,
                        double weight, std::vector<std::pair<int, Complex>>& out) {
  const std::size_t first = out.size();
  double Theta = 0;
  for (const auto& [f, b] : where) {
    const TriangleShape t = T.shape(f);
    const Complex x = b[0] * t.p[0] + b[1] * t.p[1] + b[2] * t.p[2];
    for (int k = 0; k < 3; ++k) {
      if (b[(k + 2) % 3] == 0) continue;  // the point lies on side k: it subtends no angle
      const Complex u = t.p[k] - x, w = t.p[(k + 1) % 3] - x;
      if (u == 0.0 || w == 0.0) continue;
      const double angle = std::abs(std::arg(w / u));
      Theta += angle;
      // The integral of e^{i theta} over the sector: along its bisector, 2 sin(angle / 2) long.
      const Complex bisector = u / std::abs(u) + w / std::abs(w);
      if (std::abs(bisector) == 0) continue;
      const Complex S = bisector / std::abs(bisector) * (2 * std::sin(angle / 2));
      for (int l = 0; l < 3; ++l)
        if (l == k || b[(l + 2) % 3] == 0)
          out.emplace_back(T.side_edge(f, l), T.face_to_edge(t, f, l, S));
    }
  }
  for (std::size_t i = first; i < out.size(); ++i) out[i].second *= weight / Theta;
}

VecX Calculus::divergence(const VecX& Y) const {
  VecX AY(Y.size());
  const Eigen::Index dim = A.size() > 0 ? Y.size() / A.size() : 0;  // 2, or 3 in tets
  parallel_for(A.size(), face_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c)
      for (Eigen::Index k = dim * index(c); k < dim * index(c + 1); ++k) AY[k] = A[index(c)] * Y[k];
  });
  return G.adjoint(AY);
}

Calculus triangle_calculus(const std::shared_ptr<const IntrinsicTriangulation>& T,
                           const Task& task) {
  Calculus C;
  make_calculus(T, task, {}, C);
  return C;
}

Operators triangle_operators(const IntrinsicTriangulation& T) {
  return triangle_operators(std::make_shared<const IntrinsicTriangulation>(T));
}

Operators triangle_operators(const std::shared_ptr<const IntrinsicTriangulation>& T,
                             const Task& task) {
  Operators ops;
  ops.domain = "triangle mesh";
  ops.unit = T->unit;
  VectorDiffusion& V = ops.vector;
  V.n = T->n_edges();
  const auto masses = [&] {
    V.M = VecX::Zero(V.n);
    add_thirds(ops.scalar.A, T->side_edge.matrix(), V.M);  // eq. 7
  };
  make_calculus(T, task,
                {[&] { V.to_cells = edges_to_faces(T); }, [&] { find_pieces(*T, V); }, masses},
                ops.scalar);
  V.ends = T->edges;
  if (T->has_seams()) {
    V.L_real = [T](const Task&) { return connection_laplacian_real(*T); };
  } else {
    V.L = [T](const Task& making) { return connection_laplacian(*T, making); };
    V.L_rows = [T] { return connection_rows(T); };
  }
  V.h = T->mean_edge_length / 2;
  return ops;
}

}  // namespace littoral
