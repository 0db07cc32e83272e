#include "desk/call.h"

#include <fstream>
#include <sstream>

#include "base/index.h"
#include "base/platform/temporary_folder.h"

namespace littoral::desk {

namespace {

constexpr struct {
  const char* name;
  std::size_t size;
} array_types[] = {{"$f64", 8}, {"$i32", 4}, {"$u32", 4}, {"$u8", 1}};

template <class T>
std::vector<double> widened(std::string_view bytes) {
  std::vector<T> numbers(bytes.size() / sizeof(T));
  std::memcpy(numbers.data(), bytes.data(), numbers.size() * sizeof(T));
  return {numbers.begin(), numbers.end()};
}

/// The name of an array's type and its bytes; no name for what is no array.
std::pair<std::string, std::string_view> array_in(const Message& message, const json& value) {
  if (value.is_object() && value.size() == 1)
    for (const auto& [name, size] : array_types) {
      const auto found = value.find(name);
      if (found == value.end()) continue;
      const json& place = *found;
      if (!place.is_array() || place.size() != 2 || !place[0].is_number_unsigned() ||
          !place[1].is_number_unsigned())
        throw InputError("an array of the message has no place");
      const auto at = place[0].get<std::size_t>(), count = place[1].get<std::size_t>();
      if (at > message.arrays.size() || count > (message.arrays.size() - at) / size)
        throw InputError("an array reaches beyond the message");
      return {name, std::string_view(message.arrays).substr(at, count * size)};
    }
  return {};
}

std::string without(std::string text, const std::string& part) {
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at))
    text.erase(at, part.size());
  return text;
}

}  // namespace

const json& Call::operator[](std::size_t k) const {
  static const json nothing;
  const json& arguments = request_.head.at("args");
  return k < arguments.size() ? arguments[k] : nothing;
}

std::string Call::text(std::size_t k) const {
  const json& value = (*this)[k];
  if (!value.is_string())
    throw InputError("argument " + std::to_string(k) + " must be text, not " + value.type_name());
  return value.get<std::string>();
}

bool Call::flag(std::size_t k) const {
  const json& value = (*this)[k];
  return value.is_boolean() && value.get<bool>();
}

double Call::number_of(const json& value) {
  if (value.is_number()) return value.get<double>();
  if (value.is_object() && value.contains("$number")) {
    const json& word = value["$number"];
    if (word == "Infinity") return infinity;
    if (word == "-Infinity") return -infinity;
    if (word == "NaN") return std::numeric_limits<double>::quiet_NaN();
  }
  throw InputError(std::string("expected a number, not ") + value.type_name());
}

const Object& Call::held_object(const json& value) const {
  if (!value.is_object() || !value.contains("handle") || !value["handle"].is_number_integer())
    throw InputError("expected an object by its number");
  return desk_.object(value["handle"].get<int>());
}

std::vector<double> Call::doubles(const json& value) const {
  if (value.is_null()) return {};
  const auto [type, data] = array_in(request_, value);
  if (type == "$f64") return widened<double>(data);
  if (type == "$i32") return widened<std::int32_t>(data);
  if (type == "$u32") return widened<std::uint32_t>(data);
  if (type == "$u8") return widened<std::uint8_t>(data);
  if (!value.is_array()) throw InputError("expected an array of numbers");
  std::vector<double> given;
  for (const json& x : value) given.push_back(number_of(x));
  return given;
}

MatX3 Call::points(const json& value) const {
  const std::vector<double> all = doubles(value);
  if (all.size() % 3 != 0)
    throw InputError("points have three coordinates each, there are " + std::to_string(all.size()) +
                     " numbers");
  return Eigen::Map<const MatX3>(all.data(), std::ssize(all) / 3, 3);
}

std::string Call::bytes(std::size_t k) const {
  const auto [type, data] = array_in(request_, (*this)[k]);
  if (type != "$u8") throw InputError("argument " + std::to_string(k) + " must be bytes");
  return std::string(data);
}

AnyMethod Call::method(std::size_t name, std::size_t options) const {
  OptionValues values;
  for (const auto& [key, value] : (*this)[options].items()) {
    if (!value.is_string()) throw InputError("option " + key + " must come as text");
    values.emplace_back(key, value.get<std::string>());
  }
  const std::string method = text(name);
  return method.empty() && values.empty() ? AnyMethod() : AnyMethod::named(method, values);
}

std::string file_name(const std::string& name) {
  std::string own = name.substr(name.find_last_of("/\\") + 1);
  std::erase(own, '\0');
  return own.empty() || own == "." || own == ".." ? "unnamed" : own;
}

void in_a_file(const std::string& name,
               const std::function<void(const std::filesystem::path&)>& use) {
  const TemporaryFolder folder("littoral");
  const std::string place = folder.path().string() + "/";
  try {
    use(folder.path() / file_name(name));
  } catch (const InputError& error) {
    throw InputError(without(error.what(), place), error.code());
  } catch (const UnsupportedError& error) {
    throw UnsupportedError(without(error.what(), place), error.code());
  } catch (const IoError& error) {
    throw IoError(without(error.what(), place), error.code());
  }
}

void with_file(const Call& call, const std::function<void(const std::filesystem::path&)>& read) {
  const std::string bytes = call.bytes(0);
  in_a_file(call.text(1), [&](const std::filesystem::path& path) {
    std::ofstream out(path, std::ios::binary);
    if (!out.write(bytes.data(), std::ssize(bytes)) || (out.close(), !out))
      throw IoError(path.string() + ": there is no room for a copy of it", "cannot-write");
    read(path);
  });
}

json written(Call& call, const std::string& name,
             const std::function<void(const std::filesystem::path&)>& write) {
  json out;
  in_a_file(name, [&](const std::filesystem::path& path) {
    write(path);
    std::ostringstream bytes;
    bytes << std::ifstream(path, std::ios::binary).rdbuf();
    const std::string text = std::move(bytes).str();
    out = call.put(reinterpret_cast<const unsigned char*>(text.data()), text.size());
  });
  return out;
}

}  // namespace littoral::desk
