#pragma once
// SHA-256 (FIPS 180-4): what the program sha256sum prints.

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace littoral {

/// Of bytes that come in pieces.
class Sha256 {
 public:
  void add(std::string_view bytes);
  /// 64 hexadecimal digits; to be called once.
  std::string digest();

 private:
  void take_block(const unsigned char* block);

  std::array<std::uint32_t, 8> state_{0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                      0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::array<unsigned char, 64> pending_{};
  std::size_t held_ = 0;
  std::uint64_t size_ = 0;
};

/// Of a file. Throws InputError where there is none or it is not a regular one, IoError where it
/// cannot be read.
std::string sha256_of_file(const std::filesystem::path& path);

}  // namespace littoral
