#pragma once
// Writing files: beside the target under a temporary name, then renamed, so that no half-written
// file is ever left where a whole one is expected.

#include <filesystem>
#include <functional>
#include <ostream>
#include <string>

#include "littoral/domain/polygon_soup.h"

namespace littoral::io {

/// Writes faces, lines, normals and scalars by extension: .obj (lines kept; scalar `field` as
/// texture u), .ply (binary little endian; all scalars as double properties, lines as edge
/// elements), .off, .stl (binary; triangles only). Throws UnsupportedError for others, naming those
/// that work.
void write_surface(const std::filesystem::path& path, const PolygonSoup& soup,
                   const std::string& field = "distance");

/// Writes one scalar per vertex: .csv, .npy, .txt (%.17g a line), .vtp, or what write_surface
/// takes.
void write_field(const std::filesystem::path& path, const PolygonSoup& soup,
                 const std::string& field = "distance");

/// Calls `body` with a stream to a temporary file beside `path`, then renames. Throws IoError.
void write_atomically(const std::filesystem::path& path,
                      const std::function<void(std::ostream&)>& body);

/// Removes temporary files of writes in progress; async-signal-safe enough for an interrupt
/// handler.
void remove_unfinished_files() noexcept;

}  // namespace littoral::io
