#include "io/gltf/gltf_file.h"

#include <algorithm>
#include <array>
#include <limits>

#include "base/index.h"
#include "io/binary.h"
#include "io/read.h"
#include "io/text_scan.h"
#include "io/volume/volume_formats.h"
#include "littoral/error.h"

namespace littoral::io {

namespace {

/// Numbers of a component type, by its code.
NumberKind component_kind(std::uint64_t code) {
  switch (code) {
    case 5120:
      return {'i', 1};
    case 5121:
      return {'u', 1};
    case 5122:
      return {'i', 2};
    case 5123:
      return {'u', 2};
    case 5125:
      return {'u', 4};
    case 5126:
      return {'f', 4};
    default:
      return {'?', 0};
  }
}

int columns_of(std::string_view type) {
  static constexpr std::array<std::pair<std::string_view, int>, 4> types{
      {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}}};
  for (const auto& [name, columns] : types)
    if (name == type) return columns;
  return 0;
}

}  // namespace

void GltfFile::fail(const std::string& text) const {
  throw InputError(name_ + ": " + text, "bad-file");
}
void GltfFile::unsupported(const std::string& text) const {
  throw UnsupportedError(name_ + ": " + text, "unsupported-file");
}

GltfFile::GltfFile(std::string_view bytes, std::string name, const std::filesystem::path* folder)
    : name_(std::move(name)), folder_(folder), size_(bytes.size()) {
  if (bytes.substr(0, 4) == "glTF")
    read_container(bytes);
  else
    parse(bytes);
  if (!root_.is_object() || !root_.contains("asset") || !root_["asset"].is_object())
    fail("the JSON has no object 'asset', as glTF has");
  const std::string version = text(root_["asset"], "version");
  if (!version.starts_with("2."))
    unsupported("glTF of version " + in_quotes(version) + "; 2.0 is read");
  check_extensions();
}

void GltfFile::parse(std::string_view text) {
  try {
    root_ = Json::parse(text);
  } catch (const Json::exception& e) {
    fail(std::string("the JSON: ") + e.what());
  }
}

std::string GltfFile::text(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : "";
}

// Section 4.4: 12 bytes of header, then chunks of a length, a type and data.
void GltfFile::read_container(std::string_view bytes) {
  constexpr std::uint32_t json = 0x4E4F534A, binary = 0x004E4942;
  if (bytes.size() < 20) fail("the file ends within the header of a binary glTF");
  const auto number = [&](std::size_t at) { return load_little<std::uint32_t>(bytes.data() + at); };
  if (number(4) != 2)
    unsupported("binary glTF of version " + std::to_string(number(4)) + "; 2 is read");
  if (number(8) > bytes.size())
    fail("the header promises " + std::to_string(number(8)) + " bytes, the file has " +
         std::to_string(bytes.size()));
  bytes = bytes.substr(0, number(8));
  std::size_t at = 12;
  for (int chunk = 0; at + 8 <= bytes.size(); ++chunk) {
    const std::size_t length = number(at);
    const std::uint32_t type = number(at + 4);
    at += 8;
    if (length > bytes.size() - at)
      fail("byte " + std::to_string(at) + ": chunk " + std::to_string(chunk) + " promises " +
           std::to_string(length) + " bytes, the file ends");
    const std::string_view data = bytes.substr(at, length);
    at += length;
    if (chunk == 0) {
      if (type != json) fail("the first chunk is not JSON");
      parse(data);
    } else if (type == binary && !has_binary_) {
      binary_ = data;
      has_binary_ = true;
    }
  }
}

// What changes only the look is passed over; anything else that a document requires is refused.
void GltfFile::check_extensions() const {
  if (!root_.contains("extensionsRequired")) return;
  if (!root_["extensionsRequired"].is_array()) fail("'extensionsRequired' must be an array");
  for (const Json& entry : root_["extensionsRequired"]) {
    if (!entry.is_string()) fail("'extensionsRequired' must hold names");
    const auto extension = entry.get<std::string>();
    const auto begins = [&](const char* with) { return extension.starts_with(with); };
    if (extension == "KHR_mesh_quantization" || begins("KHR_materials_") ||
        begins("KHR_texture_") || begins("EXT_texture_") || begins("KHR_lights_"))
      continue;
    unsupported("requires the extension " + in_quotes(extension) +
                ", which is not read; export without it" +
                (extension == "KHR_draco_mesh_compression" ? " (without Draco compression)" : ""));
  }
}

std::size_t GltfFile::count(const char* list) const {
  if (!root_.contains(list)) return 0;
  if (!root_[list].is_array()) fail("'" + std::string(list) + "' must be an array");
  return root_[list].size();
}

const GltfFile::Json& GltfFile::item(const char* list, std::uint64_t index) const {
  const std::size_t n = count(list);
  if (index >= n)
    fail(std::string(list) + ": there is no number " + std::to_string(index) + ", the file has " +
         std::to_string(n) + " (counted from 0)");
  const Json& found = root_[list][index];
  if (!found.is_object()) fail(std::string(list) + "[" + std::to_string(index) + "] is no object");
  return found;
}

std::uint64_t GltfFile::natural(const Json& object, const char* key, const std::string& where,
                                std::uint64_t fallback) const {
  const auto found = object.find(key);
  if (found == object.end()) return fallback;
  if (!found->is_number_unsigned()) fail(where + ": '" + key + "' must be a whole number");
  return found->get<std::uint64_t>();
}

std::uint64_t GltfFile::natural(const Json& object, const char* key,
                                const std::string& where) const {
  if (!object.contains(key)) fail(where + " has no '" + key + "'");
  return natural(object, key, where, 0);
}

std::string GltfFile::load(const std::string& uri, const std::string& where) const {
  if (uri.starts_with("data:")) {
    const std::size_t comma = uri.find(',');
    if (comma == std::string::npos || !std::string_view(uri).substr(0, comma).ends_with(";base64"))
      fail(where + ": the data are not base64");
    std::size_t used = 0;
    auto bytes = decode_base64(std::string_view(uri).substr(comma + 1), used);
    if (!bytes) fail(where + ": the data are not base64");
    return std::move(*bytes);
  }
  if (uri.find("://") != std::string::npos)
    unsupported(where + " is at " + in_quotes(uri) + "; only files beside this one are read");
  if (folder_ == nullptr)
    unsupported(where + " is in the file " + in_quotes(uri) +
                ", which does not come with these bytes; save as .glb");
  return read_bytes(*folder_ / without_percents(uri));  // section 2.8
}

std::string_view GltfFile::buffer(std::uint64_t index) const {
  const std::string where = "buffer " + std::to_string(index);
  const Json& entry = item("buffers", index);
  const std::uint64_t length = natural(entry, "byteLength", where);
  std::string_view bytes;
  if (entry.contains("uri")) {
    if (!entry["uri"].is_string()) fail(where + ": 'uri' must be a text");
    auto found = loaded_.find(index);
    if (found == loaded_.end()) {
      found = loaded_.emplace(index, load(entry["uri"].get<std::string>(), where)).first;
      loaded_size_ += found->second.size();
    }
    bytes = found->second;
  } else {
    if (index != 0 || !has_binary_) fail(where + " has no data");
    bytes = binary_;
  }
  if (length > bytes.size())
    fail(where + " promises " + std::to_string(length) + " bytes, there are " +
         std::to_string(bytes.size()));
  return bytes.substr(0, length);
}

GltfFile::Numbers GltfFile::stored(const Json& view_of, const char* offset_key,
                                   std::uint64_t component, std::uint64_t count, int columns,
                                   bool normalized, const std::string& where) const {
  const NumberKind kind = component_kind(component);
  if (kind.size == 0) fail(where + ": there is no component type " + std::to_string(component));
  const std::uint64_t view_number = natural(view_of, "bufferView", where);
  const std::string view_name = "bufferView " + std::to_string(view_number);
  const Json& view = item("bufferViews", view_number);
  const std::string_view bytes = buffer(natural(view, "buffer", view_name));
  const std::uint64_t begin = natural(view, "byteOffset", view_name, 0),
                      length = natural(view, "byteLength", view_name);
  if (begin > bytes.size() || length > bytes.size() - begin)
    fail(view_name + " runs beyond its buffer");
  const std::string_view data = bytes.substr(begin, length);
  const std::size_t row = kind.size * std::size_t(columns);
  const std::uint64_t stride = natural(view, "byteStride", view_name, row),
                      offset = natural(view_of, offset_key, where, 0);
  if (stride < row) fail(view_name + ": the stride is less than an element");
  if (count > 0 && (offset > data.size() || row > data.size() - offset ||
                    (count - 1) > (data.size() - offset - row) / stride))
    fail(where + " promises " + std::to_string(count) + " elements, " + view_name + " is shorter");
  Numbers out(index(count), columns);
  if (stride == row)
    out.reshaped<Eigen::RowMajor>() =
        load_numbers(data.substr(std::min<std::size_t>(offset, data.size())), kind,
                     count * static_cast<std::uint64_t>(columns), std::endian::little);
  for (std::uint64_t r = 0; r < count && stride != row; ++r)
    out.row(index(r)) = load_numbers(data.substr(offset + r * stride, row), kind,
                                     std::size_t(columns), std::endian::little)
                            .transpose();
  // Section 3.6.2.2: of signed numbers the least is -1 too.
  if (normalized && kind.family != 'f')
    out = (out / (std::ldexp(1.0, static_cast<int>(8 * kind.size) - (kind.family == 'i')) - 1))
              .cwiseMax(-1.0);
  return out;
}

void GltfFile::replace_sparse(const Json& sparse, std::uint64_t component, bool normalized,
                              const std::string& where, Numbers& numbers) const {
  if (!sparse.is_object() || !sparse.contains("indices") || !sparse["indices"].is_object() ||
      !sparse.contains("values") || !sparse["values"].is_object())
    fail(where + ": 'sparse' has no indices and values");
  const std::string inner = where + ", sparse";
  const std::uint64_t n = natural(sparse, "count", inner);
  const Json& places = sparse["indices"];
  const Numbers at = stored(places, "byteOffset", natural(places, "componentType", inner), n, 1,
                            false, inner + " indices");
  const Numbers values = stored(sparse["values"], "byteOffset", component, n,
                                static_cast<int>(numbers.cols()), normalized, inner + " values");
  for (Eigen::Index i = 0; i < at.rows(); ++i) {
    if (!(at(i, 0) >= 0 && at(i, 0) < static_cast<double>(numbers.rows())))
      fail(inner + ": index " + std::to_string(i) + " is out of range");
    numbers.row(index(at(i, 0))) = values.row(i);
  }
}

GltfFile::Numbers GltfFile::numbers(std::uint64_t accessor, std::string_view type) const {
  const std::string where = "accessor " + std::to_string(accessor);
  const Json& entry = item("accessors", accessor);
  if (const std::string held = text(entry, "type"); held != type)
    fail(where + " is of type " + in_quotes(held) + " instead of " + std::string(type));
  const std::uint64_t count = natural(entry, "count", where),
                      component = natural(entry, "componentType", where);
  if (count > static_cast<std::uint64_t>(std::numeric_limits<int>::max()))
    fail(where + " promises " + std::to_string(count) + " elements");
  const auto flag = entry.find("normalized");
  const bool normalized = flag != entry.end() && flag->is_boolean() && flag->get<bool>();
  const int columns = columns_of(type);
  Numbers out;
  if (entry.contains("bufferView")) {
    out = stored(entry, "byteOffset", component, count, columns, normalized, where);
  } else {
    // Zeros, which take no bytes: as many as bytes at most.
    if (count > size_)
      fail(where + " promises " + std::to_string(count) + " elements, the file has " +
           std::to_string(size_) + " bytes");
    out = Numbers::Zero(index(count), columns);
  }
  if (entry.contains("sparse")) replace_sparse(entry["sparse"], component, normalized, where, out);
  return out;
}

}  // namespace littoral::io
