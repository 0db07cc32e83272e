// Sources as whole files, and polylines of mesh files as sources.

#include <algorithm>

#include "base/index.h"
#include "io/formats.h"
#include "io/read.h"
#include "io/sources/source_nodes.h"
#include "io/text_scan.h"
#include "littoral/error.h"

namespace littoral::io {
namespace {

// The lines as they are; or, where a file has nothing but single segments (as modelling programs
// export edges), these joined head to tail.
std::vector<std::vector<int>> polylines(const PolygonSoup& soup) {
  std::vector<Segment> segments;
  for (const auto& line : soup.lines) {
    if (line.size() != 2) return soup.lines;
    segments.emplace_back(line[0], line[1]);
  }
  return chain(segments, soup.n_vertices());
}

// Both the same, where NaN equals NaN: unused vertices may hold it.
bool same_points(const MatX3& a, const MatX3& b) {
  if (a.rows() != b.rows()) return false;
  return std::equal(a.data(), a.data() + a.size(), b.data(),
                    [](double x, double y) { return x == y || (x != x && y != y); });
}

void check_finite(const PolygonSoup& soup, int v, const std::string& name) {
  if (soup.points.row(v).allFinite()) return;
  throw InputError(
      name + ": a line uses vertex " + std::to_string(v) + " (counted from 0), which is not finite",
      "bad-file");
}

Sources space_curves_from_lines(const PolygonSoup& soup, const std::string& name) {
  Sources sources;
  for (const auto& line : polylines(soup)) {
    SpaceCurve curve;
    curve.points.resize(index(line.size()), 3);
    for (std::size_t k = 0; k < line.size(); ++k) {
      check_finite(soup, line[k], name);
      curve.points.row(index(k)) = soup.points.row(line[k]);
    }
    curve.origin = name;
    sources.space_curves.push_back(std::move(curve));
  }
  return sources;
}

}  // namespace

Sources sources_from_lines(const PolygonSoup& soup, const std::string& name) {
  Sources sources;
  for (const auto& line : polylines(soup)) {
    Curve curve;
    for (int v : line) {
      check_finite(soup, v, name);
      curve.nodes.push_back(SurfacePoint::at_vertex(v));
    }
    curve.origin = name;
    sources.curves.push_back(std::move(curve));
  }
  return sources;
}

Sources read_sources_bytes(std::string_view bytes, const std::string& extension,
                           const std::string& name, const SurfaceMesh& mesh,
                           std::optional<int> index_base, Report& report) {
  if (index_base && *index_base != 0 && *index_base != 1) {
    throw InputError("the index base must be 0 or 1, not " + std::to_string(*index_base),
                     "option-value");
  }
  const Format& format = format_to_read(extension, name, {Kind::sources});
  Sources sources;
  if (format.read_sources) {
    sources = format.read_sources(bytes, name, mesh, index_base);
  } else {
    const PolygonSoup soup = format.read_surface(bytes, name);
    if (soup.lines.empty()) {
      throw InputError(name + ": no lines; sources need 'l' records (.obj) or edges (.ply)",
                       "bad-file");
    }
    if (index_base)
      report.warn("option-without-effect", name + ": the index base has no effect on " +
                                               std::string(format.extension) + " files");
    sources = same_points(soup.points, mesh.points()) ? sources_from_lines(soup, name)
                                                      : space_curves_from_lines(soup, name);
  }
  if (sources.empty()) throw InputError(name + ": no sources", "nothing-given");
  return sources;
}

Sources read_sources(const std::filesystem::path& path, const SurfaceMesh& mesh,
                     std::optional<int> index_base, Report& report) {
  return read_sources_bytes(FileBytes(path).view(), extension_to_read(path), path.string(), mesh,
                            index_base, report);
}

}  // namespace littoral::io
