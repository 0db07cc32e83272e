#include "io/formats.h"

#include <algorithm>
#include <array>

#include "io/any_formats.h"
#include "io/contents_hint.h"
#include "io/read.h"
#include "io/sources/source_nodes.h"
#include "io/surface/surface_formats.h"
#include "io/surface/surface_writers.h"
#include "io/tet/cell_mesh.h"
#include "io/tet/tet_formats.h"
#include "io/text_scan.h"
#include "io/volume/volume_formats.h"
#include "littoral/error.h"

namespace littoral::io {

const std::vector<Format>& formats() {
  // clang-format off
  static const std::vector<Format> all = {
      {.extension = ".obj", .about = "Wavefront OBJ, text: points, polygons, lines, normals, a field as texture u; isolines in groups by their level", .lines = true, .read_surface = read_obj, .read_cloud = read_obj, .write_surface = write_obj, .write_field = write_obj, .begins = {"v ", "mtllib "}},
      {.extension = ".ply", .about = "Stanford PLY, text or binary (written: binary): points, polygons, lines, normals, any fields, one of them also as colours", .lines = true, .more_values = true, .read_surface = read_ply, .read_cloud = read_ply, .write_surface = write_ply, .write_cloud = write_ply, .write_field = write_ply, .begins = {"ply "}},
      {.extension = ".off", .about = "Geomview OFF, text or binary (written: text): points, polygons, normals", .read_surface = read_off, .read_cloud = read_off, .write_surface = write_off, .begins = {"off ", "coff ", "noff "}},
      {.extension = ".stl", .about = "STL, text or binary (written: binary): triangles in single precision", .read_surface = read_stl, .write_surface = write_stl, .begins = {"solid "}, .fits = is_binary_stl},
      {.extension = ".glb", .about = "binary glTF 2.0, in single precision: triangles, lines, points of a scene, normals, any fields as attributes _NAME, one of them also as colours; no Draco", .lines = true, .more_values = true, .read_surface = read_gltf, .read_cloud = read_gltf, .write_surface = write_glb, .write_cloud = write_glb, .write_field = write_glb, .begins = {"gltf"}},
      {.extension = ".gltf", .about = "glTF 2.0 as text, with data inside or in files beside it", .lines = true, .read_surface = read_gltf, .read_cloud = read_gltf, .read_beside = read_gltf_beside},
      {.extension = ".3mf", .about = "3MF, packed or plain (written: plain): triangles of all items on the plate, in millimetres", .read_surface = read_3mf, .write_surface = write_3mf, .begins = {"pk\x03\x04"}},
      {.extension = ".pc", .about = "records v x y z and vn x y z", .read_cloud = read_pc, .begins = {"v "}},
      {.extension = ".xyz", .about = "rows x y z, or x y z and a normal, between blanks, commas, semicolons or tabs; below names, columns as of .csv and nx, ny, nz; six columns without names that look like colours are not taken for normals", .read_cloud = read_xyz},
      {.extension = ".asc", .about = "as .xyz", .read_cloud = read_xyz},
      {.extension = ".pcd", .about = "Point Cloud Library, text or binary, also compressed: points, normals", .read_cloud = read_pcd, .begins = {"# .pcd"}},
      {.extension = ".vti", .about = "VTK image data: grid and values, packed or plain (written: plain)", .more_values = true, .exchanged = true, .read_volume = read_vti, .write_volume = write_vti, .begins = {"<vtkfile type=\"imagedata\""}},
      {.extension = ".nrrd", .about = "NRRD in one file, text, raw or gzip (written: raw): grid and values", .read_volume = read_nrrd, .write_volume = write_nrrd, .begins = {"nrrd0"}},
      {.extension = ".npy", .about = "NumPy array: as a volume three axes x, y, z, without a place for the box; as points N x 3, N x 6 with normals, or records with fields x, y, z", .no_box = true, .read_cloud = read_npy_cloud, .read_volume = read_npy_volume, .read_any = read_npy, .read_table = read_npy_points, .write_volume = write_npy_volume, .write_table = write_npy, .begins = {"\x93numpy"}},
      {.extension = ".npz", .about = "NumPy archive, plain or packed (written: plain): a volume as values, origin, spacing; points as points, N x 3, with normals and values at points as arrays of their own", .read_cloud = read_npz_cloud, .read_volume = read_npz_volume, .read_any = read_npz, .read_table = read_npz_points, .write_volume = write_npz_volume, .write_table = write_npz, .begins = {"pk\x03\x04"}},
      {.extension = ".vol", .about = "voxels of one byte, plain or packed", .read_volume = read_vol, .read_voxels = read_vol_bytes},
      {.extension = ".vdb", .about = "OpenVDB level set in single precision, where the program has that module (as read: the box of the active voxels)", .read_volume = read_vdb, .write_volume = write_vdb, .available = has_openvdb, .unless = "the module littoral_vdb.so, which needs OpenVDB to be built, is not installed with the program"},
      {.extension = ".mesh", .about = "Medit, text: tets, hexahedra, prisms and pyramids (cut into tets), or else triangles and quads", .read_surface = CellsAs<read_medit>::surface, .read_tets = CellsAs<read_medit>::tets, .read_any = CellsAs<read_medit>::any, .begins = {"meshversionformatted"}},
      {.extension = ".tet", .about = "counts, points and tets as text", .read_tets = read_tet},
      {.extension = ".vtk", .about = "VTK legacy, text or binary (written: binary): tets, hexahedra, prisms and pyramids (cut into tets), or else polygons and lines, also of polygon data; points with normals; a grid of points; values at points", .lines = true, .exchanged = true, .read_surface = read_vtk_surface, .read_cloud = read_vtk_surface, .read_volume = read_vtk_volume, .read_tets = read_vtk_tets, .read_any = read_vtk, .write_tets = write_vtk, .begins = {"# vtk datafile"}},
      {.extension = ".msh", .about = "Gmsh 2 and 4, text or binary: as .vtu, of first order", .read_surface = CellsAs<read_msh>::surface, .read_tets = CellsAs<read_msh>::tets, .read_any = CellsAs<read_msh>::any, .begins = {"$meshformat"}},
      {.extension = ".vtu", .about = "VTK unstructured grid as XML, text, base64 or appended, packed or plain (written: appended, plain): tets, hexahedra, prisms and pyramids (cut into tets), or else polygons; values at points", .exchanged = true, .read_surface = CellsAs<read_vtu>::surface, .read_tets = CellsAs<read_vtu>::tets, .read_any = CellsAs<read_vtu>::any, .write_tets = write_vtu, .begins = {"<vtkfile type=\"unstructuredgrid\""}},
      {.extension = ".vtp", .about = "VTK polygon data as XML, as .vtu (written: appended, plain): points, polygons, lines, normals, values at points", .lines = true, .more_values = true, .exchanged = true, .read_surface = read_vtp, .read_cloud = read_vtp, .write_surface = write_vtp, .write_cloud = write_vtp, .write_field = write_vtp, .begins = {"<vtkfile type=\"polydata\""}},
      {.extension = ".csv", .about = "rows below names; points in columns x, y, z, Px, Py, Pz or Points:0, Points:1, Points:2", .read_table = read_points_text, .write_table = write_csv},
      {.extension = ".tsv", .about = "as .csv, with tabs between", .read_table = read_points_text, .write_table = write_tsv},
      {.extension = ".txt", .about = "rows of numbers; as sources, nodes by their place on a surface", .read_sources = read_sources_txt, .read_table = read_points_text, .write_table = write_txt},
      {.extension = ".json", .about = "curves and points on a surface or in space", .read_sources = read_sources_json},
      {.extension = ".svg", .about = "drawing of lines (isolines with their level) and outlines of regions in a plane x, y or z = constant", .lines = true, .write_surface = write_svg},
      {.extension = ".html", .about = "one page that shows a result in a browser, offline", .write_page = write_page, .available = has_viewer, .unless = "this build has no viewer page (npm was missing when it was built)"},
      {.extension = ".png", .about = "picture of a result", .write_picture = write_picture},
  };
  // clang-format on
  return all;
}

const Format* format_of(const std::string& extension) {
  const auto found = std::ranges::find(formats(), lower_case(extension), &Format::extension);
  return found == formats().end() ? nullptr : &*found;
}

bool reads(const Format& f, Kind kind) {
  switch (kind) {
    case Kind::surface:
      return f.read_surface != nullptr;
    case Kind::cloud:
      return f.read_cloud != nullptr;
    case Kind::volume:
      return f.read_volume != nullptr;
    case Kind::voxels:
      return f.read_voxels != nullptr || f.read_volume != nullptr;
    case Kind::tets:
      return f.read_tets != nullptr;
    case Kind::sources:
      return f.read_sources != nullptr || (f.lines && f.read_surface != nullptr);
    case Kind::table:
      return f.read_table != nullptr;
    case Kind::field:
    case Kind::page:
    case Kind::picture:
      return false;
  }
  return false;
}

bool writes(const Format& f, Kind kind) {
  switch (kind) {
    case Kind::surface:
      return f.write_surface != nullptr;
    case Kind::cloud:
      return f.write_cloud != nullptr;
    case Kind::volume:
      return f.write_volume != nullptr;
    case Kind::tets:
      return f.write_tets != nullptr;
    case Kind::sources:
      return f.lines && f.write_surface != nullptr;
    case Kind::field:
      return f.write_field != nullptr || f.write_table != nullptr;
    case Kind::table:
      return f.write_table != nullptr;
    case Kind::page:
      return f.write_page != nullptr;
    case Kind::picture:
      return f.write_picture != nullptr;
    case Kind::voxels:
      return false;
  }
  return false;
}

namespace {

using Holds = bool (*)(const Format&, Kind);

constexpr std::array<const char*, 10> kind_names = {
    "surface", "cloud", "volume", "voxels", "tets", "sources", "field", "table", "page", "picture"};

const char* name_of(Kind kind) { return kind_names[std::size_t(kind)]; }

bool holds_any(const Format& format, const Kinds& kinds, Holds holds) {
  return std::ranges::any_of(kinds, [&](Kind kind) { return holds(format, kind); });
}

std::string extensions(const Kinds& kinds, Holds holds) {
  std::string out;
  for (const Format& format : formats())
    if (holds_any(format, kinds, holds))
      out.append(out.empty() ? "" : " ").append(format.extension);
  return out;
}

/// Why a name does not say a format that is read or written here, and what to say instead.
std::string refusal(const std::string& what, const std::string& name, const std::string& extension,
                    const Kinds& kinds, Holds holds) {
  const std::string possible = extensions(kinds, holds);
  const std::string first = possible.substr(1, possible.find(' ') - 1);
  std::string why = "the extension is " + in_quotes(extension);
  if (name.empty())
    why = "the name is empty";
  else if (name == "-" || name.starts_with("/dev/"))
    why = "it has no extension, which says the format; write " + first + ":- for the format " +
          in_quotes("." + first);
  else if (lower_case(extension) == ".gz")
    why = "results are not packed by gzip";
  else if (extension.empty())
    why = "it has no extension, which says the format";
  const Format* known = format_of(extension);
  if (known && lower_case(extension) != lower_case(extension_named(name)))
    why = "it holds " + in_quotes(extension);
  const bool rows = holds == reads && known && known->read_table && !known->read_cloud &&
                    std::ranges::find(kinds, Kind::cloud) != kinds.end();
  return what + " as " + kinds_text(kinds) + ": " + why + "; possible: " + possible +
         (rows ? ". Name rows of points .xyz" : "");
}

std::string names_held(const Format& format, Holds holds) {
  std::string out;
  for (std::size_t k = 0; k < kind_names.size(); ++k)
    if (holds(format, static_cast<Kind>(k)))
      out += (out.empty() ? "" : ", ") + std::string(kind_names[k]);
  return out;
}

}  // namespace

std::string read_extensions(const Kinds& kinds) { return extensions(kinds, reads); }
std::string written_extensions(const Kinds& kinds) { return extensions(kinds, writes); }

std::string kinds_text(const Kinds& kinds) {
  std::string out = kinds.front() >= Kind::voxels && kinds.front() <= Kind::sources ? "" : "a ";
  for (std::size_t k = 0; k < kinds.size(); ++k)
    out += std::string(k == 0 ? "" : k + 1 == kinds.size() ? " or " : ", ") + name_of(kinds[k]);
  return out;
}

const Format& format_to_read(const std::string& extension, const std::string& name,
                             const Kinds& kinds) {
  const Format* format = format_of(extension);
  if (format && holds_any(*format, kinds, reads)) {
    if (format->available && !format->available())
      throw UnsupportedError(name + ": cannot be read: " + std::string(format->unless),
                             "unknown-format");
    return *format;
  }
  if (std::error_code none; std::filesystem::is_directory(name, none))
    throw InputError(name + ": cannot be read: it is a folder", "cannot-read");
  if (std::error_code none;
      name != "-" && extension.empty() && !std::filesystem::exists(name, none))
    throw InputError("cannot read " + name + ": there is no such file", "cannot-read");
  const std::string text = refusal(name + ": cannot be read", name, extension, kinds, reads);
  if (format) throw UnsupportedError(text, "unknown-format");
  throw InputError(text, "unknown-format");
}

const Format& format_to_write(const std::filesystem::path& path, const Kinds& kinds) {
  const std::string extension = extension_to_write(path);
  const Format* format = format_of(extension);
  if (!format || !holds_any(*format, kinds, writes))
    throw UnsupportedError(
        refusal("cannot write " + path.string(), path.string(), extension, kinds, writes),
        "unknown-format");
  if (format->available && !format->available())
    throw UnsupportedError("cannot write " + path.string() + ": " + std::string(format->unless),
                           "unknown-format");
  return *format;
}

bool is_named_as(const std::filesystem::path& path, const Kinds& kinds) {
  const Format* format = format_of(extension_named(path));
  return format && holds_any(*format, kinds, reads);
}

bool is_read_as(const std::filesystem::path& path, const Kinds& kinds) {
  const Format* format = format_of(extension_to_read(path));
  return format && holds_any(*format, kinds, reads);
}

bool is_written_as(const std::filesystem::path& path, const Kinds& kinds) {
  const Format* format = format_of(extension_to_write(path));
  return format && holds_any(*format, kinds, writes);
}

bool has_extension(const std::filesystem::path& path, std::string_view extension) {
  return lower_case(extension_named(path)) == extension;
}

Content read_content(const std::filesystem::path& path, const std::string& field) {
  const Format& format = format_to_read(extension_to_read(path), path.string(),
                                        {Kind::surface, Kind::cloud, Kind::volume, Kind::tets});
  if (format.read_any) {
    const FileBytes bytes(path);
    return read_with_hint(bytes.view(), extension_to_read(path),
                          [&] { return format.read_any(bytes.view(), path.string(), field); });
  }
  if (format.read_volume) return read_volume(path, field);
  if (format.read_tets) return read_tets(path);
  return read_surface(path);
}

bool holds(const std::filesystem::path& path, Kind kind) {
  const Format* format = format_of(extension_to_read(path));
  if (!format || !reads(*format, kind)) return false;
  if (!format->read_any) return true;
  const Content content = read_content(path);
  switch (kind) {
    case Kind::surface:
    case Kind::cloud:
      return std::holds_alternative<PolygonSoup>(content);
    case Kind::volume:
    case Kind::voxels:
      return std::holds_alternative<Volume>(content);
    case Kind::tets:
      return std::holds_alternative<TetFile>(content);
    default:
      return true;
  }
}

void write_scene(const std::filesystem::path& path, const Scene& scene) {
  const Format& format = format_to_write(path, {Kind::page, Kind::picture});
  format.write_page ? format.write_page(path, scene) : format.write_picture(path, scene, {});
}

std::string formats_text() {
  std::string out;
  for (const Format& format : formats()) {
    const std::string read = names_held(format, reads), written = names_held(format, writes);
    out += std::string(format.extension) + (read.empty() ? "" : "  read as: " + read) +
           (written.empty() ? "" : "  written as: " + written) + "\n      " +
           std::string(format.about) + "\n";
  }
  return out;
}

namespace {

constexpr const char* format_notes = R"(
## Files of other programs

- Where a format holds several kinds, the file decides: an array of three axes is a volume, one of
  two a cloud; a mesh with solid cells is tets, one without a surface.
- Hexahedra, prisms and pyramids become 6, 3 and 2 tets. Every face of four corners is cut through
  its vertex with the smallest number, so that the tets of neighbours fit together. Curved cells (of
  second order) are refused.
- glTF: the scene's meshes are placed by its nodes. Vertices of one mesh at one place, which
  exporters double for normals and textures, are one, unless a field differs there. Infinite values
  are written as the largest number. A required extension that is not read (Draco, meshopt), a skin
  or a morph in use is an error that names it.
- 3MF: items and components are placed by their transforms, and every unit becomes millimetres.
- Colours of `.ply` and `.glb` are those of pictures: two hues where values are negative somewhere,
  grey where they are infinite.
- SVG is drawn from the positive side of the axis that is flat; without one it is an error.
- The package for JavaScript has all of these but `.vdb`, `.html` and `.png`; of a `.gltf` it reads
  the data inside.
)";

}  // namespace

std::string formats_markdown() {
  std::string out =
      "# File formats\n\nThe extension of a file, in any case, says its format. Where it is none "
      "of "
      "these, or one of VTK's, how the file begins does: `scan.dat` may hold PLY, and `a.vtk` XML. "
      "Clouds are written "
      "with any values at their points, fields with one value per vertex.\n\n"
      "| extension | read as | written as | what it holds |\n|---|---|---|---|\n";
  for (const Format& format : formats())
    out += "| `" + std::string(format.extension) + "` | " + names_held(format, reads) + " | " +
           names_held(format, writes) + " | " + std::string(format.about) + " |\n";
  return out + format_notes;
}

}  // namespace littoral::io
