// NumPy archives: a volume with its box, or points.

#include <algorithm>
#include <map>
#include <sstream>

#include "base/index.h"
#include "base/option_table.h"
#include "io/any_formats.h"
#include "io/volume/volume_formats.h"
#include "io/write_table.h"
#include "io/zip_archive.h"
#include "littoral/error.h"

namespace littoral::io {

namespace {

using NpyArrays = std::map<std::string, NpyArray>;

/// What an archive holds besides, such as a text about it, says nothing of a shape.
NpyArrays read_arrays(std::string_view bytes, const std::string& name) {
  NpyArrays arrays;
  for (const ZipMember& member : zip_members(bytes, name)) {
    std::string key = member.name;
    if (key.ends_with(".npy")) key.resize(key.size() - 4);
    const std::string held = unpacked(member, name);
    if (const auto header = parse_npy_header(held); header && !is_read_as_numbers(*header))
      continue;
    arrays[key] = read_npy_array(held, name + ": " + key);
  }
  return arrays;
}

std::string names_of(const NpyArrays& arrays) {
  return arrays.empty() ? "none" : listed_names(arrays);
}

/// The array wanted by name or, where there is none of these names, the only one that will do.
template <class Fits>
const NpyArray& choose_array(const NpyArrays& arrays, const std::vector<std::string>& wanted,
                             const std::string& what, const std::string& name, Fits fits,
                             std::string& chosen) {
  for (const std::string& key : wanted)
    if (arrays.count(key) != 0) {
      chosen = key;
      return arrays.at(key);
    }
  const NpyArray* only = nullptr;
  for (const auto& [key, array] : arrays) {
    if (!fits(array)) continue;
    if (only)
      throw InputError(name + ": several arrays could be " + what + "; name one '" +
                           wanted.front() + "'; there are: " + names_of(arrays),
                       "bad-file");
    only = &array;
    chosen = key;
  }
  if (!only)
    throw InputError(name + ": no array is " + what + "; there are: " + names_of(arrays),
                     "bad-file");
  return *only;
}

/// Three numbers, or one for all axes.
void read_triple(const NpyArrays& arrays, const std::string& key, const std::string& name,
                 Vec3& triple) {
  const auto found = arrays.find(key);
  if (found == arrays.end())
    throw InputError(name + ": an archive of a volume holds '" + key +
                         "', three numbers; there are: " + names_of(arrays),
                     "bad-file");
  const VecX& numbers = found->second.numbers;
  if (numbers.size() == 1)
    triple.setConstant(numbers[0]);
  else if (numbers.size() == 3)
    triple = numbers;
  else
    throw InputError(name + ": '" + key + "' has " + std::to_string(numbers.size()) +
                         " numbers instead of three",
                     "bad-file");
}

template <class Write>
std::string npy_bytes(Write write) {
  std::ostringstream out;
  write(out);
  return out.str();
}

Volume volume_in(const NpyArrays& arrays, const std::string& name, const std::string& field) {
  std::string chosen;
  const auto wanted = field.empty() ? std::vector<std::string>{"distance", "values"}
                                    : std::vector<std::string>{field};
  if (!field.empty() && arrays.count(field) == 0 && field != "distance")
    throw InputError(name + ": there is no array '" + field + "'; there are: " + names_of(arrays),
                     "bad-file");
  const NpyArray& values = choose_array(
      arrays, wanted, "a volume of three axes", name,
      [](const NpyArray& array) { return array.shape.size() == 3; }, chosen);
  Volume volume = npy_volume(values, name + ": " + chosen);
  volume.name = chosen == "values" ? "distance" : chosen;
  read_triple(arrays, "origin", name, volume.grid.origin);
  read_triple(arrays, "spacing", name, volume.grid.spacing);
  check_box(volume.grid, name);
  return volume;
}

PolygonSoup cloud_in(const NpyArrays& arrays, const std::string& name) {
  std::string chosen;
  const NpyArray& points = choose_array(
      arrays, {"points"}, "points, N x 3", name,
      [&](const NpyArray& array) {
        const auto normals = arrays.find("normals");
        return array.shape.size() == 2 && (array.shape[1] == 3 || array.shape[1] == 6) &&
               (normals == arrays.end() || &array != &normals->second);
      },
      chosen);
  PolygonSoup cloud = npy_cloud(points, name + ": " + chosen);
  const auto same_count = [&](const std::string& key, Eigen::Index count) {
    if (count != cloud.points.rows())
      throw InputError(name + ": " + std::to_string(count) + " " + key + " for " +
                           std::to_string(cloud.points.rows()) + " points",
                       "bad-file");
  };
  for (const auto& [key, array] : arrays) {
    if (key == "normals") {
      cloud.normals = npy_points(array, name + ": normals");
      same_count(key, cloud.normals.rows());
    } else if (array.shape.size() == 1 && array.shape[0] == cloud.points.rows()) {
      cloud.scalars[key] = array.numbers;
    }
  }
  return cloud;
}

}  // namespace

Volume read_npz_volume(std::string_view bytes, const std::string& name, const std::string& field) {
  return volume_in(read_arrays(bytes, name), name, field);
}

PolygonSoup read_npz_cloud(std::string_view bytes, const std::string& name) {
  return cloud_in(read_arrays(bytes, name), name);
}

Content read_npz(std::string_view bytes, const std::string& name, const std::string& field) {
  const NpyArrays arrays = read_arrays(bytes, name);
  const auto is_volume = [](const auto& entry) { return entry.second.shape.size() == 3; };
  if (std::ranges::none_of(arrays, is_volume) && arrays.contains("points"))
    return cloud_in(arrays, name);
  return volume_in(arrays, name, field);
}

void write_npz_volume(std::ostream& out, const Volume& volume, const VolumeWriteOptions& options) {
  const auto triple = [](const Vec3& x) {
    return npy_bytes([&](std::ostream& to) { write_npy(to, {{""}, x}); });
  };
  const bool taken = volume.name == "origin" || volume.name == "spacing";
  write_zip(out, {{(taken ? "values" : volume.name) + ".npy",
                   npy_bytes([&](std::ostream& to) { write_npy_volume(to, volume, options); })},
                  {"origin.npy", triple(volume.grid.origin)},
                  {"spacing.npy", triple(volume.grid.spacing)}});
}

PointTable read_npz_points(std::string_view bytes, const std::string& name) {
  const NpyArrays arrays = read_arrays(bytes, name);
  std::string chosen;
  const NpyArray& points = choose_array(
      arrays, {"points"}, "points, N x 3", name,
      [](const NpyArray& array) { return array.shape.size() == 2 && array.shape[1] == 3; }, chosen);
  return {npy_points(points, name + ": " + chosen)};
}

void write_npz(std::ostream& out, const Table& table) {
  std::vector<std::pair<std::string, std::string>> members;
  if (table.at)
    members.emplace_back("points.npy", npy_bytes([&](std::ostream& to) {
                           write_npy(to, {{"x", "y", "z"}, table.at->points});
                         }));
  for (std::size_t c = 0; c < table.names.size(); ++c)
    members.emplace_back(table.names[c] + ".npy", npy_bytes([&](std::ostream& to) {
                           write_npy(to, {{""}, table.columns.col(index(c))});
                         }));
  write_zip(out, members);
}

}  // namespace littoral::io
