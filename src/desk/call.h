#pragma once
// One request as its operation sees it: arguments, the arrays of the answer, the objects it makes.

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>

#include "desk/desk.h"
#include "littoral/error.h"

namespace littoral::desk {

using nlohmann::json;

class Call {
 public:
  Call(const Desk& desk, const Message& request, const Context& context)
      : desk_(desk), request_(request), context_(context) {}

  const Context& context() const { return context_; }
  const Given& given() const { return desk_.given(); }

  /// null where there are fewer.
  const json& operator[](std::size_t k) const;
  std::string text(std::size_t k) const;
  bool flag(std::size_t k) const;
  double number(std::size_t k) const { return number_of((*this)[k]); }
  static double number_of(const json& value);

  template <class T>
  const T& object(std::size_t k) const {
    const Object& held = held_object((*this)[k]);
    const T* found = std::get_if<T>(&held);
    if (found == nullptr) throw InputError("an argument is an object of another kind");
    return *found;
  }

  /// An array of numbers of any type, or a list in the JSON; null is none.
  template <class T>
  std::vector<T> numbers(const json& value) const {
    const std::vector<double> all = doubles(value);
    if constexpr (std::is_same_v<T, double>) {
      return all;
    } else {
      std::vector<T> whole;
      whole.reserve(all.size());
      for (const double x : all) {
        if (!(x >= std::numeric_limits<T>::min() && x <= std::numeric_limits<T>::max()) ||
            x != std::floor(x))
          throw InputError("an array of whole numbers holds " + std::to_string(x));
        whole.push_back(static_cast<T>(x));
      }
      return whole;
    }
  }
  std::vector<double> doubles(const json& value) const;
  /// Three numbers each.
  MatX3 points(const json& value) const;
  std::string bytes(std::size_t k) const;
  AnyMethod method(std::size_t name, std::size_t options) const;

  /// Puts an array into the answer.
  template <class T>
  json put(const T* data, std::size_t count) {
    constexpr const char* name = std::is_same_v<T, double>          ? "$f64"
                                 : std::is_same_v<T, int>           ? "$i32"
                                 : std::is_same_v<T, std::uint32_t> ? "$u32"
                                                                    : "$u8";
    static_assert(sizeof(T) == 1 || std::is_same_v<T, double> || sizeof(T) == 4);
    std::string& to = out.arrays;
    const std::size_t at = to.size();
    to.append(reinterpret_cast<const char*>(data), count * sizeof(T));
    to.append((8 - to.size() % 8) % 8, '\0');
    return {{name, {at, count}}};
  }
  template <class T>
  json put(const std::vector<T>& values) {
    return put(values.data(), values.size());
  }
  template <class Derived>
  json put(const Eigen::PlainObjectBase<Derived>& values) {
    return put(values.data(), std::size_t(values.size()));
  }
  /// Indices, which are never negative.
  json put_indices(const int* data, std::size_t count) {
    return put(reinterpret_cast<const std::uint32_t*>(data), count);
  }

  /// Keeps an object under the next number that the request has for one.
  template <class T>
  const T& make(T object) {
    made.push_back(std::make_shared<const Object>(std::move(object)));
    return std::get<T>(*made.back());
  }

  Message out;
  std::vector<std::shared_ptr<const Object>> made;

 private:
  const Object& held_object(const json& value) const;

  const Desk& desk_;
  const Message& request_;
  const Context& context_;
};

using Operation = std::function<json(Call&)>;
using Operations = std::map<std::string, Operation>;
void add_surface_operations(Operations& operations);
void add_space_operations(Operations& operations);
void add_shape_operations(Operations& operations);
void add_given_operations(Operations& operations);

/// What is drawn of a surface: positions, triangles, the polygons they were cut from, scalars.
json drawn(Call& call, const PolygonSoup& soup);
/// A surface that is kept, with all that a page wants to know of it.
json made_surface(Call& call, Mesh mesh);

/// The bytes that `write(path)` writes to a file of this name.
json written(Call& call, const std::string& name,
             const std::function<void(const std::filesystem::path&)>& write);
/// A file's own name: messages begin with it.
std::string file_name(const std::string& name);
/// Calls `use(path)` with a place for a file of this name, which is gone afterwards. Messages of
/// what it throws name the file as if it were here.
void in_a_file(const std::string& name,
               const std::function<void(const std::filesystem::path&)>& use);
/// The same with the bytes of argument 0 in it, under the name of argument 1.
void with_file(const Call& call, const std::function<void(const std::filesystem::path&)>& read);

}  // namespace littoral::desk
