// VTK's XML image data, one piece.

#include "base/option_table.h"
#include "io/binary.h"
#include "io/surface/surface_writers.h"
#include "io/text_scan.h"
#include "io/volume/volume_formats.h"
#include "io/vtk/vtk_xml.h"
#include "littoral/error.h"

namespace littoral::io {

namespace {

class VtiReader {
 public:
  VtiReader(std::string_view bytes, const std::string& name, const std::string& wanted)
      : xml_(bytes, name), wanted_(wanted) {}

  Volume read() {
    read_structure();
    const Array& array = chosen();
    Volume volume;
    volume.name = array.name;
    volume.grid = grid_;
    volume.values = xml_.values(array, nodes_);
    return volume;
  }

 private:
  using Array = VtkXml::Array;

  [[noreturn]] void fail(const std::string& what) const { xml_.fail(what); }

  template <std::size_t count>
  std::array<double, count> numbers(const XmlTag& tag, const std::string& key,
                                    const std::string& fallback) const {
    const std::string text = tag.attribute(key, fallback);
    LineScanner words(text, xml_.name(), '\0');
    std::array<double, count> out{};
    bool good = words.next();
    for (double& value : out) {
      std::string_view word = good ? words.word() : std::string_view();
      if (good && word.empty() && (good = words.next())) word = words.word();
      const auto number = parse_double(word);
      if (!number) fail("the attribute " + key + " needs " + std::to_string(count) + " numbers");
      value = *number;
    }
    return out;
  }

  void read_structure() {
    XmlTag tag;
    bool in_points = false, seen_file = false;
    for (std::size_t at = 0; xml_.next(at, tag); at = tag.end) {
      if (tag.name == "VTKFile") {
        seen_file = true;
        xml_.read_file_tag(tag, "ImageData");
      } else if (tag.name == "ImageData") {
        read_image_tag(tag);
      } else if (tag.name == "Piece") {
        if (++pieces_ > 1)
          throw UnsupportedError(xml_.name() + ": only one piece is read", "unsupported-file");
        if (numbers<6>(tag, "Extent", extent_text_) != extent_)
          throw UnsupportedError(xml_.name() + ": a piece that is not the whole grid",
                                 "unsupported-file");
      } else if (tag.name == "PointData") {
        in_points = !tag.empty;
      } else if (tag.name == "/PointData") {
        in_points = false;
      } else if (tag.name == "DataArray" && in_points) {
        if (tag.attribute("NumberOfComponents", "1") == "1") arrays_.push_back(xml_.array(tag));
      }
      if (!seen_file) fail("the file does not begin with the element VTKFile");
    }
    if (pieces_ == 0) fail("there is no ImageData with a piece");
  }

  void read_image_tag(const XmlTag& tag) {
    extent_text_ = tag.attribute("WholeExtent");
    extent_ = numbers<6>(tag, "WholeExtent", "");
    const auto origin = numbers<3>(tag, "Origin", "0 0 0");
    const auto spacing = numbers<3>(tag, "Spacing", "1 1 1");
    const std::array<double, 9> straight{1, 0, 0, 0, 1, 0, 0, 0, 1};
    if (numbers<9>(tag, "Direction", "1 0 0 0 1 0 0 0 1") != straight)
      throw UnsupportedError(xml_.name() + ": a grid whose axes do not run along x, y and z",
                             "unsupported-file");
    std::array<std::int64_t, 3> n{};
    for (int k = 0; k < 3; ++k) {
      const double first = extent_[2 * k], last = extent_[2 * k + 1];
      if (!(std::abs(first) < 1e9 && std::abs(last) < 1e9)) fail("WholeExtent is out of range");
      n[k] = static_cast<std::int64_t>(last) - static_cast<std::int64_t>(first) + 1;
      grid_.spacing[k] = spacing[k];
      grid_.origin[k] = origin[k] + first * spacing[k];
    }
    nodes_ = checked_nodes(n, std::uint64_t{1040} * (xml_.size() + 1), xml_.name());
    for (int k = 0; k < 3; ++k) grid_.n[k] = static_cast<int>(n[k]);
    check_box(grid_, xml_.name());
  }

  const Array& chosen() const {
    std::vector<std::string> names;
    for (const Array& array : arrays_) names.push_back(array.name);
    return arrays_[chosen_field(names, wanted_, xml_.name())];
  }

  VtkXml xml_;
  std::string wanted_;
  std::string extent_text_;
  std::array<double, 6> extent_{};
  Grid grid_;
  std::size_t nodes_ = 0;
  int pieces_ = 0;
  std::vector<Array> arrays_;
};

}  // namespace

Volume read_vti(std::string_view bytes, const std::string& name, const std::string& field) {
  return VtiReader(bytes, name, field).read();
}

void write_vti(std::ostream& out, const Volume& volume, const VolumeWriteOptions& options) {
  const Grid& g = volume.grid;
  std::string extent;
  for (int k = 0; k < 3; ++k) extent += (k ? " 0 " : "0 ") + std::to_string(g.n[k] - 1);
  const auto triple = [](const Vec3& v) {
    return exact_text(v[0]) + " " + exact_text(v[1]) + " " + exact_text(v[2]);
  };
  out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\" version=\"1.0\" "
         "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<ImageData WholeExtent=\""
      << extent << "\" Origin=\"" << triple(g.origin) << "\" Spacing=\"" << triple(g.spacing)
      << "\">\n<Piece Extent=\"" << extent << "\">\n<PointData Scalars=\"" << xml_text(volume.name)
      << "\">\n";
  const std::uint64_t bytes = 8 * g.n_nodes();
  for (std::size_t f = 0; f <= options.more.size(); ++f)
    out << "<DataArray type=\"Float64\" Name=\""
        << xml_text(f == 0 ? volume.name : options.more[f - 1].first)
        << "\" NumberOfComponents=\"1\" format=\"appended\" offset=\"" << f * (8 + bytes)
        << "\"/>\n";
  out << "</PointData>\n</Piece>\n</ImageData>\n<AppendedData encoding=\"raw\">\n_";
  for (std::size_t f = 0; f <= options.more.size(); ++f) {
    store_little(out, bytes);
    store_numbers(out, f == 0 ? volume.values : options.more[f - 1].second);
  }
  out << "\n</AppendedData>\n</VTKFile>\n";
}

}  // namespace littoral::io
