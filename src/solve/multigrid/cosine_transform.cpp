#include "solve/multigrid/cosine_transform.h"

#include <algorithm>
#include <cmath>

#include "base/index.h"
#include "base/parallel.h"

namespace littoral {

namespace {

template <class S>
constexpr int panel_width = CosineLines<S>::width;

/// Room for panels of lines of one length, and their way from and to an array.
template <class S>
class Panels {
 public:
  Panels(const CosineLines<S>& lines, int panels)
      : lines_(lines),
        size_(index(lines.size()) * panel_width<S>),
        data_(index(panels + 1) * size_) {}

  S* panel(int p) { return data_.data() + (p + 1) * size_; }
  void forward(int p) { lines_.forward(panel(p), data_.data()); }
  void backward(int p) { lines_.backward(panel(p), data_.data()); }

  /// `count` lines, neighbours in the array, whose entries are `stride` apart; the first panels.
  void load_beside(const S* from, Eigen::Index stride, int count) {
    for (int j = 0; j < lines_.size(); ++j, from += stride)
      for (int p = 0; p * panel_width<S> < count; ++p) {
        S* const to = panel(p) + index(j) * panel_width<S>;
        const int here = std::min(panel_width<S>, count - p * panel_width<S>);
        std::copy_n(from + index(p) * panel_width<S>, here, to);
        std::fill(to + here, to + panel_width<S>, S(0));
      }
  }
  void store_beside(S* to, Eigen::Index stride, int count) {
    for (int j = 0; j < lines_.size(); ++j, to += stride)
      for (int p = 0; p * panel_width<S> < count; ++p)
        std::copy_n(panel(p) + index(j) * panel_width<S>,
                    std::min(panel_width<S>, count - p * panel_width<S>),
                    to + index(p) * panel_width<S>);
  }
  /// At most one panel of lines, one after another.
  void load_after(const S* from, int count) {
    const int n = lines_.size();
    S* const to = panel(0);
    for (int j = 0; j < n; ++j) {
      for (int r = 0; r < count; ++r) to[j * panel_width<S> + r] = from[index(r) * n + j];
      for (int r = count; r < panel_width<S>; ++r) to[j * panel_width<S> + r] = S(0);
    }
  }
  void store_after(S* to, int count) {
    const int n = lines_.size();
    const S* const from = panel(0);
    for (int r = 0; r < count; ++r)
      for (int j = 0; j < n; ++j) to[index(r) * n + j] = from[j * panel_width<S> + r];
  }

 private:
  const CosineLines<S>& lines_;
  Eigen::Index size_;
  Eigen::Matrix<S, Eigen::Dynamic, 1> data_;
};

}  // namespace

template <class S>
CosineTransform<S>::CosineTransform(std::array<int, 3> n)
    : n_(n), lines_{CosineLines<S>(n[0]), CosineLines<S>(n[1]), CosineLines<S>(n[2])} {}

/// Along the first two axes: a plane stays in the cache.
template <class S>
void CosineTransform<S>::planes(Vector& v, bool forward, const Lines& used,
                                const Task& task) const {
  const int nx = n_[0], ny = n_[1], at_once = panel_width<S>;
  parallel_for(n_[2], 1, [&](std::size_t k, std::size_t) {
    task.checkpoint();
    S* const plane = v.data() + index(k) * nx * ny;
    const char* const counts = used.empty() ? nullptr : used.data() + k * ny;
    const auto any = [&](int first, int n) {
      return counts == nullptr ||
             std::any_of(counts + first, counts + first + n, [](char c) { return c != 0; });
    };
    if (!any(0, ny)) {
      if (forward) std::fill_n(plane, index(nx) * ny, S(0));
      return;
    }
    Panels<S> along_x(lines_[0], 1), along_y(lines_[1], 1);
    const auto rows = [&] {
      for (int j = 0; j < ny; j += at_once) {
        const int n = std::min(at_once, ny - j);
        S* const first = plane + index(j) * nx;
        if (!any(j, n)) {
          if (forward) std::fill_n(first, index(n) * nx, S(0));
          continue;
        }
        if (forward && counts != nullptr)
          for (int r = 0; r < n; ++r)
            if (counts[j + r] == 0) std::fill_n(first + index(r) * nx, nx, S(0));
        along_x.load_after(first, n);
        forward ? along_x.forward(0) : along_x.backward(0);
        along_x.store_after(first, n);
      }
    };
    if (forward) rows();
    for (int i = 0; i < nx; i += at_once) {
      const int n = std::min(at_once, nx - i);
      along_y.load_beside(plane + i, nx, n);
      forward ? along_y.forward(0) : along_y.backward(0);
      along_y.store_beside(plane + i, nx, n);
    }
    if (!forward) rows();
  });
}

/// Along the last axis: several panels at once, as the entries of a column lie far apart.
template <class S>
void CosineTransform<S>::columns(Vector& v, bool forward, bool backward, const Factor& factor,
                                 const Task& task) const {
  const int nx = n_[0], at_once = 8 * panel_width<S>;
  const int pieces = (nx + at_once - 1) / at_once;
  parallel_for(index(n_[1]) * pieces, 1, [&](std::size_t piece, std::size_t) {
    task.checkpoint();
    const int j = static_cast<int>(piece) / pieces, i = static_cast<int>(piece) % pieces * at_once;
    const int n = std::min(at_once, nx - i), panels = (n + panel_width<S> - 1) / panel_width<S>;
    const Eigen::Index stride = index(nx) * n_[1];
    S* const first = v.data() + index(j) * nx + i;
    Panels<S> along(lines_[2], panels);
    along.load_beside(first, stride, n);
    for (int p = 0; forward && p < panels; ++p) along.forward(p);
    if (factor) {
      Vector factors(panels * panel_width<S>);
      factors.setZero();
      for (int k = 0; k < n_[2]; ++k) {
        factor(i, n, j, k, factors.data());
        for (int p = 0; p < panels; ++p)
          for (int r = 0; r < panel_width<S>; ++r)
            along.panel(p)[index(k) * panel_width<S> + r] *= factors[p * panel_width<S> + r];
      }
    }
    for (int p = 0; backward && p < panels; ++p) along.backward(p);
    along.store_beside(first, stride, n);
  });
}

template <class S>
void CosineTransform<S>::forward(Vector& values, const Task& task) const {
  planes(values, true, {}, task);
  columns(values, true, false, {}, task);
}

template <class S>
void CosineTransform<S>::backward(Vector& coefficients, const Task& task) const {
  columns(coefficients, false, true, {}, task);
  planes(coefficients, false, {}, task);
}

template <class S>
void CosineTransform<S>::filter(Vector& values, const Factor& factor, const Lines& given,
                                const Lines& wanted, const Task& task) const {
  planes(values, true, given, task);
  columns(values, true, true, factor, task);
  planes(values, false, wanted, task);
}

template <class S>
GridPoisson<S>::GridPoisson(std::array<int, 3> n, const Vec3& spacing) : cosine_(n) {
  for (int a = 0; a < 3; ++a) {
    const std::size_t s = a;
    eigenvalues_[s].resize(n[s]);
    for (int i = 0; i < n[s]; ++i) {
      const double sine = std::sin(M_PI * cosine_.frequencies(a)[i] / (2.0 * n[s]));
      eigenvalues_[s][i] = static_cast<S>(4 * sine * sine / (spacing[a] * spacing[a]));
    }
  }
}

template <class S>
void GridPoisson<S>::solve(Vector& b, const Task& task, const Lines& given,
                           const Lines& wanted) const {
  const auto inverse = [this](int i, int n, int j, int k, S* out) {
    const S yz = eigenvalues_[1][j] + eigenvalues_[2][k];
    Eigen::Map<Eigen::Array<S, Eigen::Dynamic, 1>>(out, n) =
        S(1) / (eigenvalues_[0].segment(i, n).array() + yz);
    if (i == 0 && j == 0 && k == 0) out[0] = 0;  // the constants
  };
  cosine_.filter(b, inverse, given, wanted, task);
}

template class CosineTransform<double>;
template class CosineTransform<float>;
template class GridPoisson<double>;
template class GridPoisson<float>;

}  // namespace littoral
