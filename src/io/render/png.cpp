#include <algorithm>
#include <array>
#include <cstdlib>

#include "io/render/picture.h"
#include "littoral/error.h"

#if LITTORAL_PNG
#include <zlib.h>
#endif

namespace littoral::io {

#if LITTORAL_PNG

namespace {

void append_big_endian(std::string& bytes, std::uint32_t number) {
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(number >> shift & 0xff);
}

// Length, name, data, checksum (PNG specification, third edition, 5.3).
void append_chunk(std::string& bytes, const std::string& name, const std::string& data) {
  append_big_endian(bytes, static_cast<std::uint32_t>(data.size()));
  const std::string checked = name + data;
  bytes += checked;
  append_big_endian(
      bytes, static_cast<std::uint32_t>(crc32(0, reinterpret_cast<const Bytef*>(checked.data()),
                                              static_cast<uInt>(checked.size()))));
}

int paeth(int left, int above, int corner) {
  const int guess = left + above - corner;
  const int to_left = std::abs(guess - left), to_above = std::abs(guess - above);
  const int to_corner = std::abs(guess - corner);
  if (to_left <= to_above && to_left <= to_corner) return left;
  return to_above <= to_corner ? above : corner;
}

// Each row as differences from a prediction, of the five in 9.2 the one whose differences are
// smallest in sum (12.7), with its number ahead.
std::string filtered_rows(const Image& image) {
  constexpr int bytes_per_pixel = 3, n_filters = 5;
  const size_t row_size = static_cast<size_t>(image.width) * bytes_per_pixel;
  const std::vector<unsigned char> black(row_size, 0);
  std::array<std::string, n_filters> candidates;
  std::string rows;
  rows.reserve((row_size + 1) * static_cast<size_t>(image.height));
  const unsigned char* above_row = black.data();
  for (int y = 0; y < image.height; ++y) {
    const unsigned char* row = image.rgb.data() + static_cast<size_t>(y) * row_size;
    std::array<long, n_filters> costs{};
    for (std::string& candidate : candidates) candidate.resize(row_size);
    for (size_t k = 0; k < row_size; ++k) {
      const int left = k < bytes_per_pixel ? 0 : row[k - bytes_per_pixel];
      const int corner = k < bytes_per_pixel ? 0 : above_row[k - bytes_per_pixel];
      const int above = above_row[k];
      const int predictions[n_filters] = {0, left, above, (left + above) / 2,
                                          paeth(left, above, corner)};
      for (size_t f = 0; f < n_filters; ++f) {
        const auto difference = static_cast<signed char>(row[k] - predictions[f]);
        candidates[f][k] = static_cast<char>(difference);
        costs[f] += std::abs(static_cast<int>(difference));
      }
    }
    const auto best =
        static_cast<size_t>(std::min_element(costs.begin(), costs.end()) - costs.begin());
    rows += static_cast<char>(best);
    rows += candidates[best];
    above_row = row;
  }
  return rows;
}

}  // namespace

std::string encode_png(const Image& image) {
  const std::string rows = filtered_rows(image);
  uLongf size = compressBound(rows.size());
  std::string packed(size, '\0');
  const int status =
      compress2(reinterpret_cast<Bytef*>(packed.data()), &size,
                reinterpret_cast<const Bytef*>(rows.data()), rows.size(), Z_DEFAULT_COMPRESSION);
  if (status != Z_OK) throw IoError("cannot compress a picture", "cannot-write");
  packed.resize(size);

  std::string header;
  append_big_endian(header, static_cast<std::uint32_t>(image.width));
  append_big_endian(header, static_cast<std::uint32_t>(image.height));
  header += {8, 2, 0, 0, 0};  // bits a channel, red green blue, deflate, filters, rows in order
  std::string bytes = "\x89PNG\r\n\x1a\n";
  append_chunk(bytes, "IHDR", header);
  append_chunk(bytes, "sRGB", std::string(1, '\0'));
  append_chunk(bytes, "IDAT", packed);
  append_chunk(bytes, "IEND", "");
  return bytes;
}

#else

std::string encode_png(const Image&) {
  throw UnsupportedError("this build of the library writes no pictures", "unsupported-file");
}

#endif

}  // namespace littoral::io
