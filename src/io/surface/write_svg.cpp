// Lines and regions in a plane as Scalable Vector Graphics (W3C, "SVG 1.1").

#include <algorithm>
#include <array>
#include <map>
#include <utility>
#include <vector>

#include "base/option_table.h"
#include "io/render/scene_style.h"
#include "io/surface/surface_writers.h"
#include "littoral/error.h"

namespace littoral::io {

namespace {

/// The two axes that are drawn, to the right and upwards.
struct DrawnPlane {
  int right = 0, up = 1;
  double low = 0, high = 0;  // of `up`, which SVG counts downwards

  std::string point(const Eigen::RowVector3d& p) const {
    return exact_text(p[right]) + " " + exact_text(low + (high - p[up]));
  }
};

DrawnPlane plane_of(const PolygonSoup& soup) {
  if (soup.points.rows() == 0)
    throw UnsupportedError("there is nothing to draw", "unsupported-file");
  for (Eigen::Index v = 0; v < soup.points.rows(); ++v)
    if (!soup.points.row(v).allFinite())
      throw UnsupportedError("vertex " + std::to_string(v) + " is not finite", "unsupported-file");
  const Eigen::RowVector3d low = soup.points.colwise().minCoeff(),
                           high = soup.points.colwise().maxCoeff(), size = high - low;
  int flat = 2;  // of several flat axes the last one
  for (int k = 1; k >= 0; --k)
    if (size[k] < size[flat]) flat = k;
  // Rounding of a computed plane is no height.
  if (!(size[flat] <= 1e-9 * size.maxCoeff()))
    throw UnsupportedError("the points fill " + rounded_text(size[0]) + " x " +
                               rounded_text(size[1]) + " x " + rounded_text(size[2]) +
                               "; SVG is for lines and regions in a plane x, y or z = constant",
                           "unsupported-file");
  DrawnPlane plane;
  plane.right = flat == 0 ? 1 : 0;
  plane.up = flat == 2 ? 1 : 2;
  plane.low = low[plane.up];
  plane.high = high[plane.up];
  return plane;
}

/// Sides that one face has, or two that run it the same way, joined head to tail: the outline of
/// the faces.
std::vector<std::vector<int>> outline(const PolygonSoup& soup) {
  std::map<std::pair<int, int>, int> sides;
  for (int f = 0; f < soup.n_faces(); ++f) {
    const auto face = soup.face(f);
    for (std::size_t k = 0; k < face.size(); ++k) {
      const std::pair side(face[k], face[(k + 1) % face.size()]);
      const auto back = sides.find({side.second, side.first});
      if (back != sides.end()) {
        if (--back->second == 0) sides.erase(back);
      } else if (side.first != side.second) {
        ++sides[side];
      }
    }
  }
  std::vector<std::vector<int>> loops;
  while (!sides.empty()) {
    std::vector<int> loop{sides.begin()->first.first};
    for (;;) {
      const auto next = sides.lower_bound({loop.back(), -1});
      if (next == sides.end() || next->first.first != loop.back()) break;
      loop.push_back(next->first.second);
      if (--next->second == 0) sides.erase(next);
    }
    loops.push_back(std::move(loop));
  }
  return loops;
}

std::string hex(const Rgb& colour) {
  constexpr const char* digits = "0123456789abcdef";
  std::string out = "#";
  for (const unsigned char byte : colour) {
    out += digits[byte / 16];
    out += digits[byte % 16];
  }
  return out;
}

void write_path(std::ostream& out, const PolygonSoup& soup, const DrawnPlane& plane,
                const std::vector<int>& line) {
  const bool closed = line.size() > 2 && line.front() == line.back();
  for (std::size_t k = 0; k + (closed ? 1 : 0) < line.size(); ++k)
    out << (k == 0 ? "M" : " L") << plane.point(soup.points.row(line[k]));
  out << (closed ? " Z" : "");
}

}  // namespace

void write_svg(std::ostream& out, const PolygonSoup& soup, const std::string&) {
  const DrawnPlane plane = plane_of(soup);
  const Eigen::RowVector3d low = soup.points.colwise().minCoeff(),
                           size = soup.points.colwise().maxCoeff() - low;
  const double width = size[plane.right], height = size[plane.up];
  const double margin = 0.02 * std::max(width, height);
  out << "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" "
         "viewBox=\""
      << exact_text(low[plane.right] - margin) << ' ' << exact_text(plane.low - margin) << ' '
      << exact_text(width + 2 * margin) << ' ' << exact_text(height + 2 * margin) << "\">\n"
      << "<g fill=\"none\" stroke=\"#000000\" stroke-width=\"1\" stroke-linejoin=\"round\">\n";
  constexpr const char* thin = "vector-effect=\"non-scaling-stroke\"";
  if (soup.n_faces() > 0) {
    out << "<path fill=\"" << hex(plain_colour) << "\" fill-rule=\"nonzero\" " << thin << " d=\"";
    for (const auto& loop : outline(soup)) write_path(out, soup, plane, loop);
    out << "\"/>\n";
  }
  const auto levels = soup.scalars.find("level");
  std::vector<Rgb> colours;
  if (levels != soup.scalars.end()) colours = value_colours(levels->second, "distance");
  for (const auto& line : soup.lines) {
    out << "<path ";
    if (!colours.empty())
      out << "data-level=\"" << exact_text(levels->second(line.front())) << "\" stroke=\""
          << hex(colours[line.front()]) << "\" ";
    out << thin << " d=\"";
    write_path(out, soup, plane, line);
    out << "\"/>\n";
  }
  out << "</g>\n</svg>\n";
}

}  // namespace littoral::io
