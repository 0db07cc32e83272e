// VTK's unstructured grids and polygon data as XML.

#include <algorithm>
#include <map>

#include "base/index.h"
#include "io/surface/surface_formats.h"
#include "io/tet/cell_mesh.h"
#include "io/tet/tet_formats.h"
#include "io/vtk/vtk_xml.h"
#include "littoral/error.h"

namespace littoral::io {

namespace {

enum class VtkCells { any, polygons };

class VtkCellReader {
 public:
  VtkCellReader(std::string_view bytes, const std::string& name, VtkCells data)
      : xml_(bytes, name), data_(data) {
    cells_.name = name;
  }

  CellMesh read() {
    read_structure();
    const std::size_t n = n_points_;
    const VecX coordinates = numbers("Points", 3, n);
    cells_.points = Eigen::Map<const MatX3>(coordinates.data(), index(n), 3);
    for (const auto& [place, array] : arrays_) {
      if (place != "PointData" || !is_number(array)) continue;
      if (array.components == 1) cells_.scalars[array.name] = xml_.values(array, n);
      if (array.components == 3 && lower_case(array.name) == "normals") {
        const VecX normals = xml_.values(array, 3 * n);
        cells_.faces.normals = Eigen::Map<const MatX3>(normals.data(), index(n), 3);
      }
    }
    for (const Run& run : runs())
      if (n_cells_.contains(run.count) && n_cells_.at(run.count) > 0) read_cells(run);
    return std::move(cells_);
  }

 private:
  /// Cells of one element: those of polygon data are all of one kind.
  struct Run {
    std::string place, count;  // the element, and its number as an attribute
    int kind;                  // as VTK numbers it
  };
  static constexpr int kind_each = -1, polyline = 4;

  std::string_view type() const { return data_ == VtkCells::any ? "UnstructuredGrid" : "PolyData"; }
  const std::vector<Run>& runs() const {
    static const std::vector<Run> any = {{"Cells", "NumberOfCells", kind_each}},
                                  polygons = {
                                      {"Polys", "NumberOfPolys", CellMesh::polygon},
                                      {"Strips", "NumberOfStrips", CellMesh::triangle_strip},
                                      {"Lines", "NumberOfLines", polyline}};
    return data_ == VtkCells::any ? any : polygons;
  }
  bool is_place(std::string_view element) const {
    return element == "PointData" || element == "Points" ||
           std::ranges::find(runs(), element, &Run::place) != runs().end();
  }

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
        xml_.read_file_tag(tag, std::string(type()));
      } else if (tag.name == "Piece") {
        if (++pieces > 1)
          throw UnsupportedError(xml_.name() + ": only one piece is read", "unsupported-file");
        n_points_ = count(tag, "NumberOfPoints");
        for (const Run& run : runs())
          if (data_ == VtkCells::any || !tag.attribute(run.count).empty())
            n_cells_[run.count] = count(tag, run.count);
      } else if (is_place(tag.name)) {
        place = tag.empty ? "" : std::string(tag.name);
      } else if (tag.name.starts_with('/') && tag.name.substr(1) == place) {
        place.clear();
      } else if (tag.name == "DataArray" && !place.empty() && pieces == 1) {
        arrays_.emplace_back(place, xml_.array(tag));
      }
      if (!seen_file) fail("the file does not begin with the element VTKFile");
    }
    if (pieces == 0) fail("there is no " + std::string(type()) + " with a piece");
    if (n_points_ == 0) fail("no vertices");
  }

  // Packed numbers take a thousandth of their bytes at least.
  std::size_t count(const XmlTag& tag, const std::string& key) const {
    const auto n = parse_integer(tag.attribute(key));
    if (!n || *n < 0) fail("the piece has no " + key);
    if (static_cast<std::uint64_t>(*n) > std::uint64_t{1040} * (xml_.size() + 1) ||
        *n > std::numeric_limits<int>::max())
      fail(key + " promises " + std::to_string(*n) + ", the file has " +
           std::to_string(xml_.size()) + " bytes");
    return std::size_t(*n);
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
    return xml_.values(array, n * std::size_t(components));
  }

  void read_cells(const Run& run) {
    const std::size_t n = n_cells_.at(run.count);
    VecX types;
    if (run.kind == kind_each) types = xml_.values(find(run.place, "types"), n);
    const VecX ends = xml_.values(find(run.place, "offsets"), n);
    double begin = 0;
    for (std::size_t c = 0; c < n; ++c) {
      const double end = ends[index(c)];
      if (!(end >= begin && end <= 1040.0 * static_cast<double>(xml_.size() + 1)) ||
          end != std::floor(end))
        fail("the offset of cell " + std::to_string(c) + " is out of order");
      begin = end;
    }
    const VecX corners = xml_.values(find(run.place, "connectivity"), std::size_t(begin));
    std::vector<int> held;
    Eigen::Index at = 0;
    for (std::size_t c = 0; c < n; ++c) {
      held.clear();
      for (; at < index(ends[index(c)]); ++at) held.push_back(cells_.corner(c, corners[at]));
      if (run.kind == polyline) {
        cells_.add_line(held);
        continue;
      }
      const double type = run.kind == kind_each ? types[index(c)] : run.kind;
      if (!(type >= 0 && type < 256)) fail("the type of cell " + std::to_string(c) + " is no byte");
      cells_.add(c, static_cast<int>(type), held);
    }
  }

  VtkXml xml_;
  VtkCells data_;
  CellMesh cells_;
  std::size_t n_points_ = 0;
  std::map<std::string, std::size_t> n_cells_;                 // by their attribute
  std::vector<std::pair<std::string, VtkXml::Array>> arrays_;  // by the element they stand in
};

}  // namespace

CellMesh read_vtu(std::string_view bytes, const std::string& name) {
  return VtkCellReader(bytes, name, VtkCells::any).read();
}
PolygonSoup read_vtp(std::string_view bytes, const std::string& name) {
  return VtkCellReader(bytes, name, VtkCells::polygons).read().as_surface();
}

}  // namespace littoral::io
