#pragma once
// Writing files: beside the target under a temporary name, then renamed, so that no half-written
// file is ever left where a whole one is expected.

#include <filesystem>
#include <functional>
#include <ostream>
#include <string>

#include "littoral/polygon_soup.h"

namespace littoral::io {

/// Writes a surface by extension; reading the file again gives the same numbers, exactly, of what
/// the format holds:
///   .obj  points, faces, lines, normals; the scalar `field`, where present, as texture u
///   .ply  points, faces, lines, normals, all scalars (binary little endian, double properties;
///   lines
///         as edge elements, numbered by the property "line")
///   .vtp  points, faces, lines, normals, all scalars
///   .off  points, faces, normals
///   .stl  triangles only (binary, single precision)
/// Throws UnsupportedError for other extensions and for what a format cannot hold, InputError for
/// normals or scalars of another length than the points, IoError naming the path.
void write_surface(const std::filesystem::path& path, const PolygonSoup& soup,
                   const std::string& field = "distance");

/// Writes one scalar per vertex, which may be +inf: .csv ("vertex,FIELD", 0-based), .npy (float64),
/// .txt (%.17g a line), or what write_surface takes except .off and .stl. A scalar "confidence" is
/// a second column. Throws InputError where the soup has no such scalar, otherwise as
/// write_surface.
void write_field(const std::filesystem::path& path, const PolygonSoup& soup,
                 const std::string& field = "distance");

/// Calls `body` with a stream to a temporary file beside `path`, then renames; after an error
/// nothing is left behind and what was at `path` is untouched. Links are followed; devices and
/// pipes are written directly. Throws IoError naming the path, or what `body` throws.
void write_atomically(const std::filesystem::path& path,
                      const std::function<void(std::ostream&)>& body);

/// Throws IoError where a file could not be written at `path`: its folder is not there or cannot be
/// written to, or `path` is a folder. Leaves nothing behind.
void check_writable(const std::filesystem::path& path);

/// Removes temporary files of writes in progress; async-signal-safe enough for an interrupt
/// handler.
void remove_unfinished_files() noexcept;

}  // namespace littoral::io
