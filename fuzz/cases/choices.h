#pragma once
// Where a random case takes its numbers from: a seed, or the bytes a fuzzer gives.

#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

namespace littoral::fuzz {

class Choices {
 public:
  explicit Choices(std::uint64_t seed) : random_(seed) {}
  /// Bytes in order; zeros after the last.
  Choices(const std::uint8_t* data, std::size_t size) : data_(data), left_(size) {}

  /// 0 to n - 1.
  int below(int n) { return n <= 1 ? 0 : static_cast<int>(bits(n > 256 ? 2 : 1) % unsigned(n)); }
  int between(int low, int high) { return low + below(high - low + 1); }
  /// In [0, 1).
  double unit() { return bits(2) / 65536.0; }
  bool chance(double share) { return unit() < share; }
  template <class T>
  const T& pick(const std::vector<T>& from) {
    return from[below(static_cast<int>(from.size()))];
  }

 private:
  unsigned bits(int bytes) {
    if (data_ == nullptr) return static_cast<unsigned>(random_() >> 16) & 0xffffU;
    unsigned out = 0;
    for (int i = 0; i < bytes; ++i) {
      out <<= 8;
      if (left_ == 0) continue;
      out |= *data_++;
      --left_;
    }
    return out;
  }

  std::mt19937_64 random_;
  const std::uint8_t* data_ = nullptr;
  std::size_t left_ = 0;
};

}  // namespace littoral::fuzz
