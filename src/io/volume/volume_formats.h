#pragma once
// One reader and writer per volume format, and what they share.

#include <bit>
#include <cstdint>
#include <optional>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include "io/volume/volume.h"

namespace littoral::io {

Volume read_vti(std::string_view bytes, const std::string& name, const std::string& field);
Volume read_nrrd(std::string_view bytes, const std::string& name, const std::string& field);
Volume read_npy_volume(std::string_view bytes, const std::string& name, const std::string& field);
/// 1 where there are voxels, 0 elsewhere.
Volume read_vol(std::string_view bytes, const std::string& name, const std::string& field);

Volume read_vtk_volume(std::string_view bytes, const std::string& name, const std::string& field);
/// Which of a file's fields is meant: the wanted one, or without one "distance" or the only one.
/// Throws InputError "file: ..." where that is none.
std::size_t chosen_field(const std::vector<std::string>& names, const std::string& wanted,
                         const std::string& file);

void write_vti(std::ostream& out, const Volume& volume, const VolumeWriteOptions& options);
void write_nrrd(std::ostream& out, const Volume& volume, const VolumeWriteOptions& options);
void write_npy_volume(std::ostream& out, const Volume& volume, const VolumeWriteOptions& options);
void write_vdb(std::ostream& out, const Volume& volume, const VolumeWriteOptions& options);

/// The box of a grid's active voxels; beyond a level set's band there is its background. Needs
/// has_openvdb().
Volume read_vdb(std::string_view bytes, const std::string& name, const std::string& field);

/// One of the values of a record.
struct NpyField {
  std::string name, type;  // "x", "<f8"
  std::size_t at = 0;      // bytes from the record's beginning
  std::int64_t count = 1;  // of numbers
};
/// The header of a NumPy file: shape, type and order; nothing if it is none.
struct NpyHeader {
  std::string type;              // "<f8"
  std::vector<NpyField> fields;  // of records, which have no type
  std::size_t record = 0;        // bytes
  bool fortran = false;
  std::vector<std::int64_t> shape;
  std::size_t data = 0;  // where the numbers begin
};
std::optional<NpyHeader> parse_npy_header(std::string_view bytes);
/// Can read_npy_array take it? Texts, dates, complex numbers, objects and records without points it
/// cannot.
bool is_read_as_numbers(const NpyHeader& header);

/// A NumPy array of numbers, as stored.
struct NpyArray {
  std::vector<std::int64_t> shape;
  bool fortran = false;  // the first axis runs fastest
  VecX numbers;
  bool of_records = false;  // whose fields have names
};
/// Records with fields x, y, z, or one of three numbers, are an array of N x 3; with nx, ny, nz too
/// of N x 6. Throws InputError and UnsupportedError naming the file.
NpyArray read_npy_array(std::string_view bytes, const std::string& name);
/// array[i, j, k] at x_i, y_j, z_k; spacing 1, origin 0. Throws InputError unless it has three
/// axes.
Volume npy_volume(const NpyArray& array, const std::string& name);
/// Points N x 3, or N x 6 with normals. Throws InputError for other shapes.
PolygonSoup npy_cloud(const NpyArray& array, const std::string& name);
/// Throws InputError unless the array is N x 3.
MatX3 npy_points(const NpyArray& array, const std::string& name);

/// NumPy archives (.npz): a volume is "values" (or the only array of three axes) with "origin" and
/// "spacing" (three numbers each, or one), points are "points" or the only array of N x 3.
Volume read_npz_volume(std::string_view bytes, const std::string& name, const std::string& field);
void write_npz_volume(std::ostream& out, const Volume& volume, const VolumeWriteOptions& options);

/// Clouds: normals are "normals" (N x 3) or the last three columns of the points, any other array
/// of one axis and N numbers is a scalar.
PolygonSoup read_npy_cloud(std::string_view bytes, const std::string& name);
PolygonSoup read_npz_cloud(std::string_view bytes, const std::string& name);

/// How numbers are stored.
struct NumberKind {
  char family = 'f';  // 'f' floating point, 'i' signed, 'u' unsigned
  std::size_t size = 8;
};

/// `count` numbers stored one after the other, as doubles; bytes must be long enough.
VecX load_numbers(std::string_view bytes, NumberKind kind, std::size_t count, std::endian order);

/// Writes numbers as float64, little endian.
void store_numbers(std::ostream& out, const VecX& values);

/// A size in four or eight bytes; the largest that there is where it is larger.
std::size_t load_size(std::string_view bytes, std::endian order);

/// Number of nodes of a grid; throws InputError "name: ..." where a size is less than 1 or there
/// are more nodes than `most`.
std::size_t checked_nodes(const std::array<std::int64_t, 3>& n, std::uint64_t most,
                          const std::string& name);

/// Throws InputError "name: ..." unless the spacing is positive and the box finite.
void check_box(const Grid& grid, const std::string& name);

/// The bytes that a base64 text stands for, up to its end or padding; blanks are skipped. Nothing
/// where it has other characters. `used`: how much of the text was read.
std::optional<std::string> decode_base64(std::string_view text, std::size_t& used);

/// How packed bytes begin.
enum class Packing { zlib_or_gzip, raw_deflate };
/// Unpacks a stream of exactly `size` bytes; nothing where it is another or damaged.
std::optional<std::string> unpack(std::string_view packed, std::size_t size,
                                  Packing packing = Packing::zlib_or_gzip);
/// What the first bytes of a stream unpack to, `most` at most.
std::string unpacked_beginning(std::string_view packed, std::size_t most);

}  // namespace littoral::io
