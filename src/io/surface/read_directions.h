#pragma once
// Directions on faces from a text file.

#include <filesystem>
#include <utility>
#include <vector>

#include "littoral/types.h"

namespace littoral::io {

/// Either one direction for every face, or some at chosen faces; lengths matter in the former only.
struct FaceDirections {
  MatX3 all{0, 3};                           // faces x 3, or empty
  std::vector<std::pair<int, Vec3>> sparse;  // face, direction
};

/// Lines `x y z`, one for each face in order; or lines `f I x y z`, I counted from 0. `#` starts a
/// comment. Throws IoError where the file cannot be read, InputError naming file and line for
/// anything else: numbers that are not finite, sparse directions of length 0, faces out of range, a
/// count that is not that of the faces.
FaceDirections read_directions(const std::filesystem::path& path, int n_faces);

}  // namespace littoral::io
