// VTK's unstructured grids as XML.

#include "io/any_formats.h"
#include "io/tet/cell_mesh.h"
#include "io/tet/tet_formats.h"
#include "io/vtk_xml.h"
#include "littoral/error.h"

namespace littoral::io {

namespace {

class VtuReader {
 public:
  VtuReader(std::string_view bytes, const std::string& name) : xml_(bytes, name) {
    cells_.name = name;
  }

  CellMesh read() {
    read_structure();
    const std::size_t n = n_points_;
    const VecX coordinates = numbers("Points", 3, n);
    cells_.points = Eigen::Map<const MatX3>(coordinates.data(), static_cast<Eigen::Index>(n), 3);
    for (const auto& [place, array] : arrays_)
      if (place == "PointData" && array.components == 1 && is_number(array))
        cells_.scalars[array.name] = xml_.values(array, n);
    if (n_cells_ > 0) read_cells();
    return std::move(cells_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { xml_.fail(what); }
  static bool is_number(const VtkXml::Array& array) { return array.type != "String"; }

  void read_structure() {
    XmlTag tag;
    std::string place;  // the element that arrays stand in
    bool seen_file = false;
    int pieces = 0;
    for (std::size_t at = 0; xml_.next(at, tag); at = tag.end) {
      if (tag.name == "VTKFile") {
        seen_file = true;
        xml_.read_file_tag(tag, "UnstructuredGrid");
      } else if (tag.name == "Piece") {
        if (++pieces > 1)
          throw UnsupportedError(xml_.name() + ": only one piece is read", "unsupported-file");
        n_points_ = count(tag, "NumberOfPoints");
        n_cells_ = count(tag, "NumberOfCells");
      } else if (tag.name == "PointData" || tag.name == "Points" || tag.name == "Cells") {
        place = tag.empty ? "" : std::string(tag.name);
      } else if (tag.name.starts_with('/') && tag.name.substr(1) == place) {
        place.clear();
      } else if (tag.name == "DataArray" && !place.empty() && pieces == 1) {
        arrays_.emplace_back(place, xml_.array(tag));
      }
      if (!seen_file) fail("the file does not begin with the element VTKFile");
    }
    if (pieces == 0) fail("there is no UnstructuredGrid with a piece");
    if (n_points_ == 0) fail("no vertices");
  }

  // Packed numbers take a thousandth of their bytes at least.
  std::size_t count(const XmlTag& tag, const char* key) const {
    const auto n = parse_integer(tag.attribute(key));
    if (!n || *n < 0) fail(std::string("the piece has no ") + key);
    if (static_cast<std::uint64_t>(*n) > std::uint64_t{1040} * (xml_.size() + 1) ||
        *n > std::numeric_limits<int>::max())
      fail(std::string(key) + " promises " + std::to_string(*n) + ", the file has " +
           std::to_string(xml_.size()) + " bytes");
    return static_cast<std::size_t>(*n);
  }

  const VtkXml::Array& find(const std::string& place, const std::string& name) const {
    for (const auto& [where, array] : arrays_)
      if (where == place && (name.empty() || array.name == name)) return array;
    fail("there is no array " + (name.empty() ? "in " + place : in_quotes(name)));
  }

  VecX numbers(const std::string& place, int components, std::size_t n) const {
    const VtkXml::Array& array = find(place, "");
    if (array.components != components)
      fail("the array of " + place + " must have " + std::to_string(components) + " components");
    return xml_.values(array, n * static_cast<std::size_t>(components));
  }

  void read_cells() {
    const VecX types = xml_.values(find("Cells", "types"), n_cells_),
               ends = xml_.values(find("Cells", "offsets"), n_cells_);
    double begin = 0;
    for (std::size_t c = 0; c < n_cells_; ++c) {
      const double end = ends[static_cast<Eigen::Index>(c)];
      if (!(end >= begin && end <= 1040.0 * static_cast<double>(xml_.size() + 1)) ||
          end != std::floor(end))
        fail("the offset of cell " + std::to_string(c) + " is out of order");
      begin = end;
    }
    const VecX corners =
        xml_.values(find("Cells", "connectivity"), static_cast<std::size_t>(begin));
    std::vector<int> held;
    Eigen::Index at = 0;
    for (std::size_t c = 0; c < n_cells_; ++c) {
      held.clear();
      for (; at < static_cast<Eigen::Index>(ends[static_cast<Eigen::Index>(c)]); ++at)
        held.push_back(cells_.corner(c, corners[at]));
      const double type = types[static_cast<Eigen::Index>(c)];
      if (!(type >= 0 && type < 256)) fail("the type of cell " + std::to_string(c) + " is no byte");
      cells_.add(c, static_cast<int>(type), held);
    }
  }

  VtkXml xml_;
  CellMesh cells_;
  std::size_t n_points_ = 0, n_cells_ = 0;
  std::vector<std::pair<std::string, VtkXml::Array>> arrays_;  // by the element they stand in
};

}  // namespace

TetFile read_vtu_tets(std::string_view bytes, const std::string& name) {
  return VtuReader(bytes, name).read().as_tets();
}
PolygonSoup read_vtu_surface(std::string_view bytes, const std::string& name) {
  return VtuReader(bytes, name).read().as_surface();
}
Content read_vtu(std::string_view bytes, const std::string& name, const std::string&) {
  return VtuReader(bytes, name).read().as_what_it_is();
}

}  // namespace littoral::io
