// 3MF: one object, built as it is.

#include <sstream>

#include "io/surface/surface_writers.h"
#include "io/zip_archive.h"
#include "littoral/error.h"

namespace littoral::io {

namespace {

constexpr const char* content_types =
    R"(<?xml version="1.0" encoding="UTF-8"?>
<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types"><Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/><Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>
)";
constexpr const char* relationships =
    R"(<?xml version="1.0" encoding="UTF-8"?>
<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships"><Relationship Target="/3D/3dmodel.model" Id="rel0" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>
)";

void check_printable(const PolygonSoup& soup) {
  if (soup.n_faces() == 0)
    throw UnsupportedError("there are no faces, 3MF holds triangles only", "unsupported-file");
  for (Eigen::Index v = 0; v < soup.points.rows(); ++v)
    if (!soup.points.row(v).allFinite())
      throw UnsupportedError("vertex " + std::to_string(v) + " is not finite", "unsupported-file");
  for (int f = 0; f < soup.n_faces(); ++f) {
    const auto face = soup.face(f);
    const std::string label = "face " + std::to_string(f);
    if (face.size() != 3)
      throw UnsupportedError(label + " has " + std::to_string(face.size()) +
                                 " corners, 3MF holds triangles only; .obj, .ply and .off hold "
                                 "polygons, --triangulate cuts them",
                             "unsupported-file");
    if (face[0] == face[1] || face[1] == face[2] || face[2] == face[0])
      throw UnsupportedError(label + " has the same vertex twice, which 3MF does not allow",
                             "unsupported-file");
  }
}

}  // namespace

void write_3mf(std::ostream& out, const PolygonSoup& soup, const std::string&) {
  check_printable(soup);
  std::ostringstream model;
  model << R"(<?xml version="1.0" encoding="UTF-8"?>
<model unit="millimeter" xml:lang="en-US" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02">
<resources><object id="1" type="model"><mesh><vertices>
)";
  for (Eigen::Index v = 0; v < soup.points.rows(); ++v)
    model << "<vertex x=\"" << exact_text(soup.points(v, 0)) << "\" y=\""
          << exact_text(soup.points(v, 1)) << "\" z=\"" << exact_text(soup.points(v, 2))
          << "\"/>\n";
  model << "</vertices><triangles>\n";
  for (int f = 0; f < soup.n_faces(); ++f) {
    const auto face = soup.face(f);
    model << "<triangle v1=\"" << face[0] << "\" v2=\"" << face[1] << "\" v3=\"" << face[2]
          << "\"/>\n";
  }
  model
      << "</triangles></mesh></object></resources><build><item objectid=\"1\"/></build></model>\n";
  write_zip(out, {{"[Content_Types].xml", content_types},
                  {"_rels/.rels", relationships},
                  {"3D/3dmodel.model", model.str()}});
}

}  // namespace littoral::io
