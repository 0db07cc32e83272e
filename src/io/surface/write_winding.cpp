#include "io/surface/write_winding.h"

#include "io/surface/surface_writers.h"
#include "io/write.h"

namespace littoral::io {

namespace {

void write_point(std::ostream& out, const Eigen::RowVector3d& p) {
  out << "v " << exact_text(p[0]) << ' ' << exact_text(p[1]) << ' ' << exact_text(p[2]) << '\n';
}

}  // namespace

void write_homogeneous_obj(const std::filesystem::path& path, const PolygonSoup& soup,
                           const std::string& value, const std::string& weight) {
  const VecX &values = soup.scalars.at(value), &weights = soup.scalars.at(weight);
  write_atomically(path, [&](std::ostream& out) {
    for (int v = 0; v < soup.n_vertices(); ++v) write_point(out, soup.points.row(v));
    for (int v = 0; v < soup.n_vertices(); ++v)
      out << "vt " << exact_text(values[v] * weights[v]) << ' ' << exact_text(weights[v]) << '\n';
    for (int f = 0; f < soup.n_faces(); ++f) {
      out << 'f';
      for (int v : soup.face(f)) out << ' ' << v + 1 << '/' << v + 1;
      out << '\n';
    }
  });
}

void write_polylines(const std::filesystem::path& path,
                     const std::vector<std::pair<std::string, const std::vector<MatX3>*>>& groups) {
  write_atomically(path, [&](std::ostream& out) {
    long long next = 1;
    for (const auto& [name, lines] : groups) {
      out << "o " << name << '\n';
      for (const MatX3& line : *lines) {
        for (Eigen::Index i = 0; i < line.rows(); ++i) write_point(out, line.row(i));
        out << 'l';
        for (Eigen::Index i = 0; i < line.rows(); ++i) out << ' ' << next++;
        out << '\n';
      }
    }
  });
}

}  // namespace littoral::io
