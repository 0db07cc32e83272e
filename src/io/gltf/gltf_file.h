#pragma once
// glTF 2.0 (Khronos, "glTF 2.0 Specification", 2021): the document and its numbers.

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "littoral/types.h"

namespace littoral::io {

class GltfFile {
 public:
  using Json = nlohmann::json;
  using Numbers = Rows<double, Eigen::Dynamic>;

  /// `folder`: where files that the document names lie; null: there are none. Throws InputError for
  /// what is no glTF, UnsupportedError naming a required extension that is not read.
  GltfFile(std::string_view bytes, std::string name, const std::filesystem::path* folder);

  const Json& root() const { return root_; }
  /// "accessors", 3: what stands there. Throws InputError where there is none.
  const Json& item(const char* list, std::uint64_t index) const;
  std::size_t count(const char* list) const;
  /// The numbers of an accessor of this type ("VEC3"), one element a row. Normalised integers are
  /// fractions.
  Numbers numbers(std::uint64_t accessor, std::string_view type) const;
  /// A whole number of an object, or the fallback where it has none.
  std::uint64_t natural(const Json& object, const char* key, const std::string& where,
                        std::uint64_t fallback) const;
  std::uint64_t natural(const Json& object, const char* key, const std::string& where) const;
  /// A text of an object; empty where it has none.
  static std::string text(const Json& object, const char* key);
  /// Bytes of the document and of the buffers loaded so far.
  std::size_t size() const { return size_ + loaded_size_; }
  [[noreturn]] void fail(const std::string& text) const;
  [[noreturn]] void unsupported(const std::string& text) const;

 private:
  void parse(std::string_view text);
  void read_container(std::string_view bytes);
  void check_extensions() const;
  std::string_view buffer(std::uint64_t index) const;
  std::string load(const std::string& uri, const std::string& where) const;
  /// `count` rows of `columns` numbers in a buffer view from `offset` on.
  Numbers stored(const Json& view_of, const char* offset_key, std::uint64_t component,
                 std::uint64_t count, int columns, bool normalized, const std::string& where) const;
  void replace_sparse(const Json& sparse, std::uint64_t component, bool normalized,
                      const std::string& where, Numbers& numbers) const;

  std::string name_;
  const std::filesystem::path* folder_;
  std::size_t size_;
  Json root_;
  std::string_view binary_;  // of a container
  bool has_binary_ = false;
  mutable std::map<std::uint64_t, std::string> loaded_;
  mutable std::size_t loaded_size_ = 0;
};

}  // namespace littoral::io
