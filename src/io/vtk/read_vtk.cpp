// VTK legacy files, text or binary (VTK File Formats, version 2.0 to 5.1): unstructured grids,
// polygon data and grids of points.

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <string_view>

#include "base/index.h"
#include "io/any_formats.h"
#include "io/tet/cell_mesh.h"
#include "io/tet/tet_formats.h"
#include "io/volume/volume_formats.h"
#include "io/vtk/vtk_scanner.h"
#include "littoral/error.h"

namespace littoral::io {

namespace {

class VtkReader {
 public:
  VtkReader(std::string_view bytes, const std::string& name) : scan_(bytes, name) {
    cells_.name = name;
  }

  VtkReader& read() {
    header();
    for (std::string_view word = scan_.word(); !word.empty(); word = scan_.word())
      section(lower_case(std::string(word)));
    build();
    return *this;
  }

  TetFile tets() {
    if (set_ == DataSet::grid) scan_.unsupported("it holds a volume and no tets");
    return cells_.as_tets();
  }
  PolygonSoup surface() {
    if (set_ == DataSet::grid) scan_.unsupported("it holds a volume and no surface");
    return cells_.as_surface();
  }
  Volume volume(const std::string& wanted) {
    if (set_ != DataSet::grid) scan_.unsupported("it holds no volume (STRUCTURED_POINTS)");
    std::vector<std::string> names;
    for (const auto& [name, values] : cells_.scalars) names.push_back(name);
    const std::string& name = names[chosen_field(names, wanted, cells_.name)];
    return {grid_, std::move(cells_.scalars.at(name)), name};
  }
  Content what_it_is(const std::string& wanted) {
    if (set_ == DataSet::grid) return volume(wanted);
    return cells_.as_what_it_is();
  }

 private:
  enum class DataSet { cells, polygons, grid };

  // Runs of corners that follow each other.
  struct Runs {
    std::vector<double> starts;  // of each run, and the end, into corners
    VecX corners;
    std::size_t size() const { return starts.empty() ? 0 : starts.size() - 1; }
  };

  void header() {
    const std::string_view first = scan_.rest_of_line();
    constexpr std::string_view magic = "# vtk DataFile Version ";
    if (!first.starts_with(magic)) scan_.fail("expected '# vtk DataFile Version'");
    modern_ = first.substr(magic.size()).starts_with("5");
    scan_.rest_of_line();  // the title
    const std::string mode = lower_case(std::string(scan_.word()));
    if (mode != "ascii" && mode != "binary") scan_.fail("expected ASCII or BINARY");
    if (!scan_.take("dataset")) scan_.fail("expected DATASET");
    const std::string set(scan_.word());
    if (lower_case(set) == "polydata")
      set_ = DataSet::polygons;
    else if (lower_case(set) == "structured_points")
      set_ = DataSet::grid;
    else if (lower_case(set) != "unstructured_grid")
      scan_.unsupported("the data set is " + in_quotes(set) +
                        "; UNSTRUCTURED_GRID, POLYDATA and STRUCTURED_POINTS are read");
    scan_.binary = mode == "binary";
  }

  void section(const std::string& keyword) {
    // What was read already counts on it.
    constexpr std::array<std::string_view, 11> once = {
        "points",          "cells",      "cell_types", "vertices",     "lines", "polygons",
        "triangle_strips", "dimensions", "spacing",    "aspect_ratio", "origin"};
    if (std::ranges::find(once, keyword) != once.end() && !seen_.insert(keyword).second)
      scan_.fail("keyword " + in_quotes(keyword) + " appears twice");
    if (keyword == "points") {
      const std::int64_t n = scan_.count("points");
      const std::string type(scan_.word_of_line());
      const VecX x = scan_.numbers(3 * n, type, "POINTS");
      cells_.points = Eigen::Map<const MatX3>(x.data(), n, 3);
      n_points_ = n;
    } else if (keyword == "cells") {
      cells_runs_ = runs("CELLS");
    } else if (keyword == "vertices") {
      runs("VERTICES");
    } else if (keyword == "lines") {
      lines_ = runs("LINES");
    } else if (keyword == "polygons") {
      polygons_ = runs("POLYGONS");
    } else if (keyword == "triangle_strips") {
      strips_ = runs("TRIANGLE_STRIPS");
    } else if (set_ == DataSet::grid && box(keyword)) {
    } else if (keyword == "cell_types") {
      types_ = scan_.numbers(scan_.count("cells"), "int", "CELL_TYPES");
    } else if (keyword == "point_data" || keyword == "cell_data") {
      at_points_ = keyword == "point_data";
      values_ = scan_.count("values");
    } else if (keyword == "metadata") {
      scan_.rest_of_line();
      while (!scan_.rest_of_line().empty()) {
      }
    } else {
      attribute(keyword);
    }
  }

  /// A keyword of a grid's box, with what follows it.
  bool box(const std::string& keyword) {
    const bool size_follows = keyword == "dimensions";
    const bool spacing_follows = keyword == "spacing" || keyword == "aspect_ratio";
    if (!size_follows && !spacing_follows && keyword != "origin") return false;
    const Vec3 size = scan_.three_of_line(keyword);
    if (!size_follows) {
      (spacing_follows ? grid_.spacing : grid_.origin) = size;
      return true;
    }
    std::array<std::int64_t, 3> n{};
    for (int k = 0; k < 3; ++k) {
      if (!(size[k] >= 1 && size[k] < 1e9) || size[k] != std::floor(size[k]))
        scan_.fail("DIMENSIONS must be whole numbers from 1 on");
      n[k] = static_cast<std::int64_t>(size[k]);
    }
    n_points_ = static_cast<std::int64_t>(checked_nodes(n, scan_.size(), cells_.name));
    for (int k = 0; k < 3; ++k) grid_.n[k] = static_cast<int>(n[k]);
    return true;
  }

  Runs runs(const char* keyword) {
    const std::int64_t n = scan_.count("cells"), size = scan_.count("corners");
    Runs out;
    if (modern_) {
      // Offsets of the cells and of the end, then all corners.
      const VecX offsets = array("offsets", n);
      out.corners = array("connectivity", size);
      out.starts.assign(offsets.begin(), offsets.end());
      for (std::size_t c = 0; c < out.starts.size(); ++c)
        if (!(out.starts[c] >= (c > 0 ? out.starts[c - 1] : 0) && out.starts[c] <= size))
          scan_.fail("the offset of cell " + std::to_string(c) + " is out of order");
      return out;
    }
    // Each cell is the number of its corners and these.
    const VecX list = scan_.numbers(size, "int", keyword);
    out.corners.resize(size);
    out.starts.assign(1, 0);
    std::int64_t at = 0, used = 0;
    for (std::int64_t c = 0; c < n; ++c) {
      const double degree = at < size ? list[at] : -1;
      if (!(degree >= 0 && degree <= static_cast<double>(size - at - 1)))
        scan_.fail(std::string(keyword) + " ends within cell " + std::to_string(c));
      ++at;
      for (int k = 0; k < static_cast<int>(degree); ++k) out.corners[used++] = list[at++];
      out.starts.push_back(static_cast<double>(used));
    }
    return out;
  }

  VecX array(const char* name, std::int64_t n) {
    if (!scan_.take(name)) scan_.fail("expected " + std::string(name));
    const std::string type(scan_.word_of_line());
    return scan_.numbers(n, type, name);
  }

  /// Values at points or cells. Kept are those at points of one component, and normals.
  void keep(const std::string& name, int components, std::int64_t tuples, const std::string& type) {
    VecX values = scan_.numbers(components * tuples, type, name.c_str());
    if (!at_points_ || tuples != n_points_) return;
    if (components == 1) cells_.scalars[name] = std::move(values);
    if (components == 3 && lower_case(name) == "normals")
      cells_.faces.normals = Eigen::Map<const MatX3>(values.data(), tuples, 3);
  }

  int components() {
    const std::string_view text = scan_.word_of_line();
    if (text.empty()) return 1;
    const auto n = parse_integer(text);
    if (!n || *n < 1 || *n > 100) scan_.fail("the number of components must be 1 to 100");
    return static_cast<int>(*n);
  }

  void attribute(const std::string& keyword) {
    const std::string name = without_percents(scan_.word_of_line());
    if (keyword == "field") {
      const std::int64_t n = scan_.count("arrays");
      for (std::int64_t i = 0; i < n; ++i) {
        const std::string label(scan_.word());
        if (lower_case(label) == "metadata") {
          section("metadata");
          --i;
          continue;
        }
        const int width = components();
        const std::int64_t tuples = scan_.count("values");
        const std::string type(scan_.word_of_line());
        if (lower_case(type) == "string")
          scan_.skip_texts(width * tuples);
        else
          keep(without_percents(label), width, tuples, type);
      }
      return;
    }
    if (keyword == "lookup_table") {
      const std::int64_t n = scan_.count("colours");
      scan_.numbers(4 * n, scan_.binary ? "unsigned_char" : "float", "LOOKUP_TABLE");
      return;
    }
    if (keyword == "color_scalars") {
      const int width = components();
      keep(name, width, values_, scan_.binary ? "unsigned_char" : "float");
      return;
    }
    if (keyword == "texture_coordinates") {
      const int width = components();
      keep("", std::max(2, width), values_, std::string(scan_.word_of_line()));
      return;
    }
    const std::string type(scan_.word_of_line());
    if (keyword == "scalars") {
      const int width = components();
      if (scan_.take("lookup_table")) scan_.word_of_line();
      keep(name, width, values_, type);
    } else if (keyword == "normals") {
      keep("normals", 3, values_, type);
    } else if (keyword == "vectors") {
      keep(name, 3, values_, type);
    } else if (keyword == "tensors" || keyword == "tensors6") {
      keep(name, keyword == "tensors" ? 9 : 6, values_, type);
    } else if (keyword == "global_ids" || keyword == "pedigree_ids") {
      scan_.numbers(values_, type, name.c_str());
    } else {
      scan_.fail("unknown keyword " + in_quotes(keyword));
    }
  }

  void build() {
    if (set_ == DataSet::grid) {
      if (grid_.n[0] == 0) scan_.fail("there are no DIMENSIONS");
      return check_box(grid_, cells_.name);
    }
    if (std::size_t(types_.size()) != cells_runs_.size())
      scan_.fail("there are " + std::to_string(cells_runs_.size()) + " cells and " +
                 std::to_string(types_.size()) + " cell types");
    each(cells_runs_, [&](std::size_t c, const std::vector<int>& corners) {
      const double type = types_[index(c)];
      cells_.add(c, std::abs(type) < 1e9 ? static_cast<int>(type) : -1, corners);
    });
    each(polygons_, [&](std::size_t c, const std::vector<int>& corners) {
      cells_.add(c, CellMesh::polygon, corners);
    });
    each(strips_, [&](std::size_t c, const std::vector<int>& corners) {
      cells_.add(c, CellMesh::triangle_strip, corners);
    });
    each(lines_, [&](std::size_t, const std::vector<int>& corners) { cells_.add_line(corners); });
  }

  template <class Visit>
  void each(const Runs& runs, const Visit& visit) {
    std::vector<int> corners;
    for (std::size_t c = 0; c < runs.size(); ++c) {
      corners.clear();
      for (auto k = index(runs.starts[c]); k < index(runs.starts[c + 1]); ++k)
        corners.push_back(cells_.corner(c, runs.corners[k]));
      visit(c, corners);
    }
  }

  VtkScanner scan_;
  std::set<std::string> seen_;
  CellMesh cells_;
  DataSet set_ = DataSet::cells;
  Grid grid_;
  bool modern_ = false, at_points_ = true;
  std::int64_t n_points_ = 0;
  std::int64_t values_ = 0;  // points or cells that attributes have values at
  Runs cells_runs_, polygons_, strips_, lines_;
  VecX types_;
};

}  // namespace

TetFile read_vtk_tets(std::string_view bytes, const std::string& name) {
  return VtkReader(bytes, name).read().tets();
}
PolygonSoup read_vtk_surface(std::string_view bytes, const std::string& name) {
  return VtkReader(bytes, name).read().surface();
}
Volume read_vtk_volume(std::string_view bytes, const std::string& name, const std::string& field) {
  return VtkReader(bytes, name).read().volume(field);
}
Content read_vtk(std::string_view bytes, const std::string& name, const std::string& field) {
  return VtkReader(bytes, name).read().what_it_is(field);
}

}  // namespace littoral::io
