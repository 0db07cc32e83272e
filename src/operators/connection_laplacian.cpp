#include "operators/connection_laplacian.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "base/fetch_ahead.h"
#include "domain/mesh/edge_sides.h"
#include "operators/sum_over_triangles.h"

namespace littoral {

namespace {

/// How a face couples the edges at two of its sides, which meet at a corner: r = -w conj(d_row)
/// d_col with w = 2 cot of the angle there and d the direction of an edge in the face's frame
/// (eq. 9 with the rotations of eq. 8 written as their product). Both edges have w on the diagonal;
/// these add up to eq. 6. The row is that of the edge with the larger number.
struct Coupling {
  int row, col;  // sides of the face
  double w;
  Complex r;
};

/// Of sides k and k + 1.
Coupling coupling(const IntrinsicTriangulation& T, const TriangleShape& t, int f, int k) {
  const int l = (k + 1) % 3;
  const double w = 2 * t.cot[l];
  int a = k, b = l;
  if (T.side_edge(f, a) < T.side_edge(f, b)) std::swap(a, b);
  return {a, b, w, -w * std::conj(T.edge_in_face(t, f, a)) * T.edge_in_face(t, f, b)};
}

class ConnectionRows : public HermitianRows<Complex> {
 public:
  explicit ConnectionRows(std::shared_ptr<const IntrinsicTriangulation> T)
      : T_(std::move(T)), sides_(edge_sides(*T_)) {}

  int size() const override { return T_->n_edges(); }

  void neighbours(int i, std::vector<int>& out) const override {
    out.clear();
    for (const TriangleSide& side : sides_.at(i))
      for (const int l : {1, 2}) out.push_back(T_->side_edge(side.face(), (side.k() + l) % 3));
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
  }

  void row(int i, BlockRow<Complex>& out) const override {
    neighbours(i, out.blocks);
    out.blocks.insert(out.blocks.begin(), i);
    out.values.assign(out.blocks.size(), 0);
    for (const TriangleSide& side : sides_.at(i)) {
      const int f = side.face(), k = side.k(), before = (k + 2) % 3;
      const TriangleShape t = T_->shape(f);
      const Coupling first = coupling(*T_, t, f, before), second = coupling(*T_, t, f, k);
      out.values[0] += first.w + second.w;
      place(out, T_->side_edge(f, before)) += first.row == k ? first.r : std::conj(first.r);
      place(out, T_->side_edge(f, (k + 1) % 3)) += second.row == k ? second.r : std::conj(second.r);
    }
  }

  void couplings(int i, std::vector<Coupled>& out) const override {
    out.clear();
    for (const TriangleSide& side : sides_.at(i)) {
      const int f = side.face(), k = side.k(), next = (k + 1) % 3, before = (k + 2) % 3;
      const double a = T_->length(f, k), b = T_->length(f, next), c = T_->length(f, before);
      const double half = 0.5 / area_of_lengths(a, b, c);  // 2 cot = half * what follows
      out.push_back({T_->side_edge(f, next), half * law_of_cosines(a, b, c)});
      out.push_back({T_->side_edge(f, before), half * law_of_cosines(a, c, b)});
    }
  }

  void fetch(int i) const override {
    for (const TriangleSide& side : sides_.at(i)) {
      fetch_ahead(&T_->length(side.face(), 0));
      fetch_ahead(&T_->side_edge.matrix().coeffRef(side.face(), 0));
    }
  }

 private:
  static Complex& place(BlockRow<Complex>& row, int j) {  // of a neighbour: these ascend
    const auto found = std::lower_bound(row.blocks.begin() + 1, row.blocks.end(), j);
    return row.values[found - row.blocks.begin()];
  }

  std::shared_ptr<const IntrinsicTriangulation> T_;
  EdgeSides sides_;
};

}  // namespace

SpMatC connection_laplacian(const IntrinsicTriangulation& T, const Task& task) {
  return sum_over_triangles<Complex>(
      T.n_edges(), T.side_edge.matrix(),
      [&](int f) {
        const TriangleShape t = T.shape(f);
        TriangleTerms<Complex> terms{};
        for (int k = 0; k < 3; ++k) {
          const Coupling c = coupling(T, t, f, k);
          terms.diagonal[k] += c.w;
          terms.diagonal[(k + 1) % 3] += c.w;
          terms.beside[k] = c.r;
        }
        return terms;
      },
      task);
}

std::shared_ptr<const HermitianRows<Complex>> connection_rows(
    std::shared_ptr<const IntrinsicTriangulation> T) {
  return std::make_shared<const ConnectionRows>(std::move(T));
}

SpMat connection_laplacian_real(const IntrinsicTriangulation& T) {
  Triplets entries;
  entries.reserve(std::size_t(T.n_faces()) * 24);
  for (int f = 0; f < T.n_faces(); ++f) {
    const TriangleShape t = T.shape(f);
    for (int k = 0; k < 3; ++k) {
      const Coupling coupled = coupling(T, t, f, k);
      const int row = T.side_edge(f, coupled.row), col = T.side_edge(f, coupled.col);
      for (const int e : {row, col})
        for (int i = 0; i < 2; ++i) entries.emplace_back(2 * e + i, 2 * e + i, coupled.w);
      const Complex r = coupled.r;
      const double s = T.seam(f, coupled.row) ? -1 : 1, c = T.seam(f, coupled.col) ? -1 : 1;
      const double block[2][2] = {{r.real(), -r.imag() * c}, {s * r.imag(), s * r.real() * c}};
      for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j) entries.emplace_back(2 * row + i, 2 * col + j, block[i][j]);
    }
  }
  SpMat L(2 * T.n_edges(), 2 * T.n_edges());
  L.setFromTriplets(entries.begin(), entries.end());
  return L;
}

}  // namespace littoral
