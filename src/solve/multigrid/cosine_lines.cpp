#include "solve/multigrid/cosine_lines.h"

#include <algorithm>
#include <cmath>

#include "base/index.h"
#include "base/kernel_choice.h"
#include "base/vector_lanes.h"

namespace littoral {

namespace {

constexpr int dense_below = 8;  // entries: folding costs as much as it saves

template <class S>
constexpr int width = CosineLines<S>::width;

/// `rows` rows of A B -> C, B depth x width. Every entry is summed in the order of the depth.
template <int bytes, int rows, class S>
[[gnu::always_inline]] inline void product_rows(int depth, const S* A, const S* B, S* C) {
  using Lanes [[gnu::vector_size(bytes)]] = S;
  constexpr int lanes = bytes / static_cast<int>(sizeof(S));
  for (int at = 0; at < width<S>; at += 2 * lanes) {
    Lanes low[rows] = {}, high[rows] = {};
    for (int k = 0; k < depth; ++k) {
      Lanes b, c;
      load(b, B + index(k) * width<S> + at);
      load(c, B + index(k) * width<S> + at + lanes);
      for (int r = 0; r < rows; ++r) {
        const S a = A[index(r) * depth + k];
        low[r] += a * b;
        high[r] += a * c;
      }
    }
    for (int r = 0; r < rows; ++r) {
      store(C + index(r) * width<S> + at, low[r]);
      store(C + index(r) * width<S> + at + lanes, high[r]);
    }
  }
}

/// C = A B, A size x size.
template <int bytes, class S>
[[gnu::always_inline]] inline void product(int size, const S* A, const S* B, S* C) {
  int row = 0;
  for (; row + 4 <= size; row += 4)
    product_rows<bytes, 4>(size, A + index(row) * size, B, C + index(row) * width<S>);
  for (; row < size; ++row)
    product_rows<bytes, 1>(size, A + index(row) * size, B, C + index(row) * width<S>);
}

template <class S>
using Product = void(int size, const S* A, const S* B, S* C);

template <class S>
void plain_product(int size, const S* A, const S* B, S* C) {
  product<16>(size, A, B, C);
}
#if defined(__x86_64__)
template <class S>
[[gnu::target("avx2")]] void avx2_product(int size, const S* A, const S* B, S* C) {
  product<32>(size, A, B, C);
}
#endif

template <class S>
Product<S>* fastest_product() {
  static Product<S>* const best = LITTORAL_FASTEST(&plain_product<S>, &avx2_product<S>);
  return best;
}

/// Sums in the first half of `entries` rows, differences, backwards, in the second; its own
/// transpose.
template <class S>
void fold(int entries, S* panel) {
  for (int j = 0; j < entries / 2; ++j) {
    S* const a = panel + index(j) * width<S>;
    S* const b = panel + index(entries - 1 - j) * width<S>;
    for (int r = 0; r < width<S>; ++r) {
      const S sum = a[r] + b[r], difference = a[r] - b[r];
      a[r] = sum;
      b[r] = difference;
    }
  }
}

}  // namespace

template <class S>
CosineLines<S>::CosineLines(int n) : n_(n), frequencies_(n) {
  for (int entries = n, step = 1;; step *= 2) {
    const int even = (entries + 1) / 2;
    folded_.push_back(entries);
    add_block(even, entries / 2, step, true);
    if (entries % 2 != 0 || entries <= dense_below) {
      add_block(0, even, 2 * step, false);
      return;
    }
    entries = even;
  }
}

template <class S>
void CosineLines<S>::add_block(int first, int size, int step, bool odd) {
  if (size == 0) return;
  Block block{first, size, {}, {}};
  block.matrix.resize(index(size) * size);
  block.transposed.resize(index(size) * size);
  for (int k = 0; k < size; ++k) {
    const int frequency = odd ? (2 * k + 1) * step : k * step;
    frequencies_[first + k] = frequency;
    for (int i = 0; i < size; ++i) {
      const int j = odd ? size - 1 - i : i;  // `fold` leaves differences backwards
      // The angle is reduced first: frequency (2 j + 1) may be large.
      const long long turn = static_cast<long long>(frequency) * (2 * j + 1) % (4LL * n_);
      const double cosine = std::cos(M_PI * static_cast<double>(turn) / (2.0 * n_));
      block.matrix[index(k) * size + i] = block.transposed[index(i) * size + k] =
          static_cast<S>(std::sqrt((frequency == 0 ? 1.0 : 2.0) / n_) * cosine);
    }
  }
  blocks_.push_back(std::move(block));
}

template <class S>
void CosineLines<S>::multiply(bool forward, const S* from, S* to) const {
  for (const Block& block : blocks_)
    fastest_product<S>()(block.size, (forward ? block.matrix : block.transposed).data(),
                         from + index(block.first) * width, to + index(block.first) * width);
}

template <class S>
void CosineLines<S>::forward(S* panel, S* room) const {
  for (const int entries : folded_) fold(entries, panel);
  std::copy_n(panel, index(n_) * width, room);
  multiply(true, room, panel);
}

template <class S>
void CosineLines<S>::backward(S* panel, S* room) const {
  std::copy_n(panel, index(n_) * width, room);
  multiply(false, room, panel);
  for (auto it = folded_.rbegin(); it != folded_.rend(); ++it) fold(*it, panel);
}

template class CosineLines<double>;
template class CosineLines<float>;

}  // namespace littoral
