#pragma once
// Random numbers that depend on where they are used and not on when: the same on every machine.

#include <array>
#include <cstdint>

namespace littoral {

/// Philox 4x32 of ten rounds: four words that look random, a function of a counter and a key alone.
/// Salmon, Moraes, Dror, Shaw: Parallel Random Numbers: As Easy as 1, 2, 3 (2011), section 4.2.
std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> counter,
                                    std::array<std::uint32_t, 2> key);

/// The random numbers of one thing among many: `stream` says what they are for, `index` for which.
class RandomNumbers {
 public:
  RandomNumbers(std::uint64_t seed, std::uint32_t stream, std::uint64_t index)
      : counter_{static_cast<std::uint32_t>(index), static_cast<std::uint32_t>(index >> 32), stream,
                 0},
        key_{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)} {}

  /// Uniform in [0, 2^32).
  std::uint32_t word();
  /// Uniform in [0, 1), a multiple of 2^-53.
  double uniform();
  /// The sum of twelve uniform numbers less six: mean 0, variance 1, and close to normal, by
  /// additions alone, which all machines do alike; never beyond 6.
  double about_normal();

 private:
  std::array<std::uint32_t, 4> counter_, block_{};
  std::array<std::uint32_t, 2> key_;
  std::size_t used_ = 4;
};

}  // namespace littoral
