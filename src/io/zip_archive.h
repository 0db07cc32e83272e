#pragma once
// Zip archives, as NumPy writes them: members stored or deflated, also beyond 4 GiB.

#include <ostream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace littoral::io {

struct ZipMember {
  std::string name;
  std::string_view packed;  // within the archive
  std::size_t size = 0;     // unpacked
  bool deflated = false;
  std::uint32_t checksum = 0;  // of the unpacked bytes
};

/// The members by the archive's directory. Throws InputError naming the file.
std::vector<ZipMember> zip_members(std::string_view archive, const std::string& name);
/// The bytes of a member. Throws InputError where they are damaged.
std::string unpacked(const ZipMember& member, const std::string& name);

/// Writes members as they are. Throws UnsupportedError beyond 4 GiB.
void write_zip(std::ostream& out,
               const std::vector<std::pair<std::string, std::string>>& names_and_bytes);

}  // namespace littoral::io
