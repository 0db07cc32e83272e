#include "io/zip_archive.h"

#include <zlib.h>

#include <algorithm>
#include <limits>

#include "io/binary.h"
#include "io/volume/volume_formats.h"
#include "littoral/error.h"

namespace littoral::io {

// Names and layout of the records: PKWARE's APPNOTE.TXT, sections 4.3.7, 4.3.12, 4.3.14, 4.3.16,
// 4.5.3.
namespace {

constexpr std::uint32_t local_header = 0x04034b50, directory_entry = 0x02014b50,
                        end_of_directory = 0x06054b50, end_of_directory_64 = 0x06064b50,
                        locator_64 = 0x07064b50;
constexpr std::uint32_t in_extra_field = 0xffffffff;  // the number is in the zip64 extra field

[[noreturn]] void throw_damaged(const std::string& name) {
  throw InputError(name + ": no zip archive, or a damaged one", "bad-file");
}

/// Numbers of a record, with errors where it ends early.
class Record {
 public:
  Record(std::string_view bytes, std::uint64_t at, std::size_t length, const std::string& name)
      : name_(name) {
    if (at > bytes.size() || length > bytes.size() - at) throw_damaged(name);
    bytes_ = bytes.substr(at, length);
  }
  template <class T>
  T at(std::size_t offset) const {
    if (offset + sizeof(T) > bytes_.size()) throw_damaged(name_);
    return load_little<T>(bytes_.data() + offset);
  }

 private:
  std::string_view bytes_;
  const std::string& name_;
};

struct Directory {
  std::uint64_t begin = 0, entries = 0;
};

Directory find_directory(std::string_view archive, const std::string& name) {
  constexpr std::size_t record = 22, longest_comment = 65535;
  if (archive.size() < record) throw_damaged(name);
  const std::size_t lowest = archive.size() - std::min(archive.size(), record + longest_comment);
  std::size_t at = archive.size() - record;
  while (load_little<std::uint32_t>(archive.data() + at) != end_of_directory)
    if (at-- == lowest) throw_damaged(name);
  const Record end(archive, at, record, name);
  Directory directory{end.at<std::uint32_t>(16), end.at<std::uint16_t>(10)};
  if (directory.begin != in_extra_field && directory.entries != 0xffff) return directory;
  if (at < 20) throw_damaged(name);
  const Record locator(archive, at - 20, 20, name);
  if (locator.at<std::uint32_t>(0) != locator_64) return directory;
  const Record end_64(archive, locator.at<std::uint64_t>(8), 56, name);
  if (end_64.at<std::uint32_t>(0) != end_of_directory_64) throw_damaged(name);
  return {end_64.at<std::uint64_t>(48), end_64.at<std::uint64_t>(32)};
}

/// Replaces the numbers that did not fit into 32 bits by those of the zip64 extra field.
void read_extra_field(std::string_view extra, std::array<std::uint64_t, 3>& numbers,
                      const std::string& name) {
  for (std::size_t at = 0; at + 4 <= extra.size();) {
    const Record head(extra, at, 4, name);
    const auto length = head.at<std::uint16_t>(2);
    const Record field(extra, at + 4, length, name);
    std::size_t offset = 0;
    if (head.at<std::uint16_t>(0) == 1)
      for (std::uint64_t& number : numbers) {
        if (number != in_extra_field) continue;
        number = field.at<std::uint64_t>(offset);
        offset += 8;
      }
    at += 4 + length;
  }
}

}  // namespace

std::vector<ZipMember> zip_members(std::string_view archive, const std::string& name) {
  const Directory directory = find_directory(archive, name);
  std::vector<ZipMember> members;
  std::uint64_t at = directory.begin;
  for (std::uint64_t m = 0; m < directory.entries; ++m) {
    const Record entry(archive, at, 46, name);
    if (entry.at<std::uint32_t>(0) != directory_entry) throw_damaged(name);
    const auto method = entry.at<std::uint16_t>(10), name_length = entry.at<std::uint16_t>(28),
               extra_length = entry.at<std::uint16_t>(30), comment = entry.at<std::uint16_t>(32);
    const Record whole(archive, at, 46ul + name_length + extra_length + comment, name);
    std::array<std::uint64_t, 3> numbers{entry.at<std::uint32_t>(24), entry.at<std::uint32_t>(20),
                                         entry.at<std::uint32_t>(42)};
    read_extra_field(archive.substr(at + 46 + name_length, extra_length), numbers, name);
    const auto [size, packed_size, header] = numbers;
    ZipMember member;
    member.name = archive.substr(at + 46, name_length);
    if ((entry.at<std::uint16_t>(8) & 1) != 0 || (method != 0 && method != 8))
      throw UnsupportedError(
          name + ": " + member.name + " is encrypted or packed in another way than deflate",
          "unsupported-file");
    const Record local(archive, header, 30, name);
    if (local.at<std::uint32_t>(0) != local_header) throw_damaged(name);
    const std::uint64_t begin =
        header + 30 + local.at<std::uint16_t>(26) + local.at<std::uint16_t>(28);
    if (begin > archive.size() || packed_size > archive.size() - begin ||
        (method == 0 && size != packed_size))
      throw_damaged(name);
    member.packed = archive.substr(begin, packed_size);
    member.size = size;
    member.deflated = method == 8;
    member.checksum = entry.at<std::uint32_t>(16);
    members.push_back(std::move(member));
    at += 46ul + name_length + extra_length + comment;
  }
  return members;
}

namespace {

std::uint32_t checksum_of(std::string_view bytes) {
  return static_cast<std::uint32_t>(
      crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

}  // namespace

std::string unpacked(const ZipMember& member, const std::string& name) {
  std::optional<std::string> bytes = member.deflated
                                         ? unpack(member.packed, member.size, Packing::raw_deflate)
                                         : std::string(member.packed);
  if (!bytes || checksum_of(*bytes) != member.checksum)
    throw InputError(name + ": " + member.name + " is damaged", "bad-file");
  return std::move(*bytes);
}

void write_zip(std::ostream& out,
               const std::vector<std::pair<std::string, std::string>>& names_and_bytes) {
  std::uint64_t total = 0;
  for (const auto& [name, bytes] : names_and_bytes) total += 76 + 2 * name.size() + bytes.size();
  if (total > std::numeric_limits<std::uint32_t>::max() - 22)
    throw UnsupportedError(
        "cannot write more than 4 GiB into an archive; other formats of volumes hold more",
        "too-large");
  // What both headers of a member share, from "version needed" to "extra field length".
  const auto store_common = [&out](const std::string& name, std::string_view bytes) {
    constexpr std::uint16_t version = 20, first_of_1980 = 33;
    for (const std::uint16_t x :
         std::initializer_list<std::uint16_t>{version, 0, 0, 0, first_of_1980})
      store_little(out, x);
    store_little(out, checksum_of(bytes));
    for (int k = 0; k < 2; ++k) store_little(out, static_cast<std::uint32_t>(bytes.size()));
    store_little(out, static_cast<std::uint16_t>(name.size()));
    store_little(out, std::uint16_t{0});
  };
  std::uint32_t at = 0;
  std::vector<std::uint32_t> begins;
  for (const auto& [name, bytes] : names_and_bytes) {
    begins.push_back(at);
    store_little(out, local_header);
    store_common(name, bytes);
    out << name << bytes;
    at += static_cast<std::uint32_t>(30 + name.size() + bytes.size());
  }
  std::uint32_t directory = 0;
  for (std::size_t m = 0; m < names_and_bytes.size(); ++m) {
    const auto& [name, bytes] = names_and_bytes[m];
    store_little(out, directory_entry);
    store_little(out, std::uint16_t{20});  // made by
    store_common(name, bytes);
    for (int k = 0; k < 3; ++k) store_little(out, std::uint16_t{0});  // comment, disk, attributes
    store_little(out, std::uint32_t{0});
    store_little(out, begins[m]);
    out << name;
    directory += static_cast<std::uint32_t>(46 + name.size());
  }
  const auto count = static_cast<std::uint16_t>(names_and_bytes.size());
  store_little(out, end_of_directory);
  store_little(out, std::uint32_t{0});
  store_little(out, count);
  store_little(out, count);
  store_little(out, directory);
  store_little(out, at);
  store_little(out, std::uint16_t{0});
}

}  // namespace littoral::io
