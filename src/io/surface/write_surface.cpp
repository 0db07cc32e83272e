// Surfaces as text and STL.

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>

#include "io/binary.h"
#include "io/formats.h"
#include "io/surface/surface_writers.h"
#include "io/text_scan.h"
#include "io/write.h"
#include "littoral/error.h"

namespace littoral::io {
namespace {

void write_row(std::ostream& out, const char* record, const MatX3& values, Eigen::Index row) {
  out << record << exact_text(values(row, 0)) << ' ' << exact_text(values(row, 1)) << ' '
      << exact_text(values(row, 2)) << '\n';
}

void check_lengths(const std::string& name, const PolygonSoup& soup) {
  const auto check = [&](Eigen::Index length, const std::string& what) {
    if (length == soup.points.rows()) return;
    throw InputError("cannot write " + name + ": " + std::to_string(length) + " " + what + " for " +
                         std::to_string(soup.points.rows()) + " points",
                     "cannot-write");
  };
  if (soup.normals.rows() > 0) check(soup.normals.rows(), "normals");
  for (const auto& [field, values] : soup.scalars)
    check(values.size(), "values of '" + field + "'");
}

void check_stl(const PolygonSoup& soup) {
  if (soup.n_faces() == 0 && soup.n_vertices() > 0)
    throw UnsupportedError(
        "there are points and no faces, STL holds triangles only; .ply and .obj hold points",
        "unsupported-file");
  for (int f = 0; f < soup.n_faces(); ++f) {
    if (soup.face(f).size() != 3) {
      throw UnsupportedError(
          "face " + std::to_string(f) + " has " + std::to_string(soup.face(f).size()) +
              " corners, STL holds triangles only; .obj, .ply and .off hold polygons",
          "unsupported-file");
    }
  }
  for (int f = 0; f < soup.n_faces(); ++f) {
    for (int v : soup.face(f)) {
      const double largest = soup.points.row(v).cwiseAbs().maxCoeff();
      if (largest <= std::numeric_limits<float>::max()) continue;
      throw UnsupportedError(
          "vertex " + std::to_string(v) +
              " is beyond STL's single precision; .obj, .ply and .off hold doubles",
          "unsupported-file");
    }
  }
}

}  // namespace

std::string exact_text(double value) {
  std::array<char, 32> text;
  const auto result = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), result.ptr};
}

void write_obj(std::ostream& out, const PolygonSoup& soup, const std::string& field) {
  const auto found = soup.scalars.find(field);
  const VecX* u = found == soup.scalars.end() ? nullptr : &found->second;
  const bool normals = soup.normals.rows() > 0;
  for (Eigen::Index v = 0; v < soup.points.rows(); ++v) write_row(out, "v ", soup.points, v);
  for (Eigen::Index v = 0; u && v < u->size(); ++v) out << "vt " << exact_text((*u)(v)) << " 0\n";
  for (Eigen::Index v = 0; v < soup.normals.rows(); ++v) write_row(out, "vn ", soup.normals, v);
  for (int f = 0; f < soup.n_faces(); ++f) {
    out << 'f';
    for (int v : soup.face(f)) {
      out << ' ' << v + 1;
      if (u || normals) out << '/';
      if (u) out << v + 1;
      if (normals) out << '/' << v + 1;
    }
    out << '\n';
  }
  // Isolines are groups by their level.
  const auto levels = soup.scalars.find("level");
  for (std::size_t i = 0; i < soup.lines.size(); ++i) {
    const auto& line = soup.lines[i];
    if (levels != soup.scalars.end()) {
      const double level = levels->second(line.front());
      if (i == 0 || level != levels->second(soup.lines[i - 1].front()))
        out << "g level_" << exact_text(level) << '\n';
    }
    out << 'l';
    for (int v : line) out << ' ' << v + 1;
    out << '\n';
  }
}

void write_off(std::ostream& out, const PolygonSoup& soup, const std::string&) {
  const bool normals = soup.normals.rows() > 0;
  out << (normals ? "NOFF\n" : "OFF\n") << soup.n_vertices() << ' ' << soup.n_faces() << " 0\n";
  for (Eigen::Index v = 0; v < soup.points.rows(); ++v) {
    for (int k = 0; k < 3; ++k) out << (k ? " " : "") << exact_text(soup.points(v, k));
    for (int k = 0; k < 3 && normals; ++k) out << ' ' << exact_text(soup.normals(v, k));
    out << '\n';
  }
  for (int f = 0; f < soup.n_faces(); ++f) {
    out << soup.face(f).size();
    for (int v : soup.face(f)) out << ' ' << v;
    out << '\n';
  }
}

void write_stl(std::ostream& out, const PolygonSoup& soup, const std::string&) {
  check_stl(soup);
  std::array<char, 80> header{"binary STL written by littoral"};
  out.write(header.data(), header.size());
  store_little(out, static_cast<std::uint32_t>(soup.n_faces()));
  constexpr std::size_t size = 12 * sizeof(float) + sizeof(std::uint16_t);
  store_records(
      out, std::size_t(soup.n_faces()), [](std::size_t f) { return size * f; },
      [&](std::size_t f, char* to) {
        const auto face = soup.face(int(f));
        const Vec3 a = soup.points.row(face[0]), b = soup.points.row(face[1]),
                   c = soup.points.row(face[2]);
        // Scaled first: the cross product of huge or tiny sides leaves even the doubles.
        const Vec3 ab = (b - a).stableNormalized(), ac = (c - a).stableNormalized();
        const Vec3 normal = ab.cross(ac).stableNormalized();
        for (double x : normal) to = put_little(to, static_cast<float>(std::isfinite(x) ? x : 0.0));
        for (const Vec3& p : {a, b, c})
          for (double x : p) to = put_little(to, static_cast<float>(x));
        put_little(to, std::uint16_t{0});
      });
}

void write_surface(const std::filesystem::path& path, const PolygonSoup& soup,
                   const std::string& field) {
  const Format& format = format_to_write(path, {Kind::surface});
  check_lengths(path.string(), soup);
  try {
    write_atomically(path, [&](std::ostream& out) { format.write_surface(out, soup, field); });
  } catch (const UnsupportedError& e) {
    throw UnsupportedError("cannot write " + path.string() + ": " + e.what(), e.code());
  }
}

}  // namespace littoral::io
