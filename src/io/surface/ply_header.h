#pragma once
// The header of a PLY file.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace littoral::io {

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };
enum class PlyFormat { ascii, little_endian, big_endian };

std::size_t byte_size(PlyType type);
inline bool is_floating(PlyType type) {
  return type == PlyType::float32 || type == PlyType::float64;
}

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::float32;
  bool is_list = false;
  PlyType count_type = PlyType::uint8;  // lists
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;  // at most the number of bytes of the body
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  PlyFormat format = PlyFormat::ascii;
  std::vector<PlyElement> elements;
  std::size_t body = 0;       // first byte after the header
  std::size_t body_line = 1;  // number of the line that starts there
};

/// Parses the header; throws InputError naming the line, also for counts that the bytes after the
/// header cannot hold.
PlyHeader read_ply_header(std::string_view bytes, const std::string& name);

}  // namespace littoral::io
