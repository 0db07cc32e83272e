#pragma once
// Readers of formats that hold more than one kind of thing: each file as what it is.

#include <string>
#include <string_view>

#include "io/formats.h"

namespace littoral::io {

/// An array of two axes is a cloud, one of three a volume.
Content read_npy(std::string_view bytes, const std::string& name, const std::string& field);
/// An archive without an array of three axes is a cloud.
Content read_npz(std::string_view bytes, const std::string& name, const std::string& field);

/// With solid cells tets, a grid of points with values a volume, otherwise a surface.
Content read_vtk(std::string_view bytes, const std::string& name, const std::string& field);

}  // namespace littoral::io
