#include "cli/input/tet_input.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "api/space/isosurfaces.h"
#include "base/stopwatch.h"
#include "cli/input/surface_input.h"
#include "cli/input/volume_input.h"
#include "contour/isosurface.h"
#include "domain/tet/tet_locator.h"
#include "io/read.h"
#include "io/render/picture.h"
#include "io/render/scene.h"
#include "io/write.h"
#include "littoral/error.h"

namespace littoral::cli {

const std::vector<std::string> tet_outputs = {".vtk", ".vtu", ".csv", ".npy",  ".txt",
                                              ".ply", ".obj", ".vtp", ".html", ".png"};

namespace {

/// Triangles over some of the points, with the fields there.
PolygonSoup triangles_of(const io::TetFile& file, const MatX3i& triangles) {
  PolygonSoup soup;
  std::vector<int> number(static_cast<std::size_t>(file.mesh.n_vertices()), -1), kept;
  for (const int v : triangles.reshaped<Eigen::RowMajor>()) {
    int& n = number[static_cast<std::size_t>(v)];
    if (n < 0) {
      n = static_cast<int>(kept.size());
      kept.push_back(v);
    }
    soup.corners.push_back(n);
    if (soup.corners.size() % 3 == 0)
      soup.face_offsets.push_back(static_cast<int>(soup.corners.size()));
  }
  soup.points = file.mesh.points(kept, Eigen::all);
  for (const auto& [name, values] : file.scalars) soup.scalars[name] = values(kept);
  return soup;
}

/// All surfaces in one soup; clouds and meshes do not mix.
PolygonSoup read_sources_of(const std::vector<std::string>& files) {
  PolygonSoup all;
  for (const std::string& file : files) {
    const PolygonSoup more = io::read_surface(file);
    if (all.n_vertices() > 0 && (more.n_faces() > 0) != (all.n_faces() > 0))
      throw InputError("option --sources: " + file +
                       " is a cloud and others are meshes, or the other way round");
    const int first = all.n_vertices();
    const auto append = [first](MatX3& to, const MatX3& from) {
      to.conservativeResize(first + from.rows(), 3);
      to.bottomRows(from.rows()) = from;
    };
    append(all.points, more.points);
    if (more.n_faces() == 0) {
      if (more.normals.rows() == 0) throw InputError(file + " has neither faces nor normals");
      append(all.normals, more.normals);
    }
    for (int f = 0; f < more.n_faces(); ++f) {
      for (int v : more.face(f)) all.corners.push_back(first + v);
      all.face_offsets.push_back(static_cast<int>(all.corners.size()));
    }
  }
  return all;
}

TetSources gather(const TetArguments& arguments, const io::TetFile& file, Session& session) {
  TetSources sources;
  sources.vertices =
      checked_vertices(arguments.vertices, file.mesh.n_vertices(), arguments.domain, session);
  sources.boundary = arguments.boundary;
  sources.surface = read_sources_of(arguments.sources);
  if (sources.vertices.empty() && arguments.sources.empty() && !sources.boundary) {
    if (file.triangles.rows() == 0)
      throw InputError(
          "nothing to measure distance from: name --sources FILE, --vertex I or --boundary (" +
          arguments.domain + " has no triangles of its own)");
    sources.surface = triangles_of(file, file.triangles);
  }
  return sources;
}

}  // namespace

PolygonSoup boundary_of(const io::TetFile& file) {
  return triangles_of(file, boundary_faces(file.mesh));
}

namespace {

/// The boundary of tets on one side of a plane across an axis, in a soup that shares its points.
class CutBoundary {
 public:
  CutBoundary(const TetMesh& mesh, const VecX& values, int axis, double position)
      : mesh_(mesh), values_(values), axis_(axis), position_(position) {
    const MatX3i faces = boundary_faces(mesh);
    for (Eigen::Index f = 0; f < faces.rows(); ++f) add_face(faces.row(f));
  }

  /// A point with its value appended; its number.
  int add_point(const Eigen::Vector4d& point) {
    points_.push_back(point);
    return static_cast<int>(points_.size()) - 1;
  }
  void add_polygon(const std::vector<int>& corners) {
    if (corners.size() >= 3) soup_.add_face(corners);
  }
  PolygonSoup soup(const std::string& field) {
    soup_.points.resize(static_cast<Eigen::Index>(points_.size()), 3);
    VecX at(soup_.points.rows());
    for (Eigen::Index i = 0; i < at.size(); ++i) {
      soup_.points.row(i) = points_[static_cast<std::size_t>(i)].head<3>();
      at[i] = points_[static_cast<std::size_t>(i)][3];
    }
    if (!field.empty()) soup_.scalars[field] = at;
    return std::move(soup_);
  }

 private:
  Eigen::Vector4d with_value(int v) const {
    return {mesh_.points(v, 0), mesh_.points(v, 1), mesh_.points(v, 2), values_[v]};
  }
  double beyond(int v) const { return mesh_.points(v, axis_) - position_; }

  void add_face(const Eigen::RowVector3i& face) {
    std::vector<int> corners;
    for (int k = 0; k < 3; ++k) {
      const int a = face[k], b = face[(k + 1) % 3];
      const double x = beyond(a), y = beyond(b);
      if (x <= 0) corners.push_back(number({a, a}, 0));
      if ((x < 0 && y > 0) || (x > 0 && y < 0))
        corners.push_back(a < b ? number({a, b}, x / (x - y)) : number({b, a}, y / (y - x)));
    }
    add_polygon(corners);
  }
  /// Of the point a share t of the way along an edge.
  int number(const std::pair<int, int>& edge, double t) {
    const auto [at, is_new] = number_of_.try_emplace(edge, static_cast<int>(points_.size()));
    if (is_new) add_point((1 - t) * with_value(edge.first) + t * with_value(edge.second));
    return at->second;
  }

  const TetMesh& mesh_;
  const VecX& values_;
  int axis_;
  double position_;
  std::map<std::pair<int, int>, int> number_of_;  // vertices (twice the same) and cut edges
  std::vector<Eigen::Vector4d> points_;
  PolygonSoup soup_;
};

}  // namespace

PolygonSoup cut_open(const io::TetFile& file, int axis, double position) {
  const TetMesh& mesh = file.mesh;
  const std::string field = file.scalars.empty() ? "" : file.scalars.begin()->first;
  const VecX values = field.empty() ? VecX::Zero(mesh.n_vertices()) : file.scalars.at(field);
  CutBoundary out(mesh, values, axis, position);
  // The section, with the value of the tet that holds each of its corners.
  Report unread;
  const VecX height = mesh.points.col(axis).array() - position;
  const PolygonSoup section = isosurface(mesh, height, 0, unread);
  if (section.n_faces() == 0) throw InputError("the plane of --slice misses the tets");
  const TetLocator locator(mesh);
  std::vector<int> number;
  for (int v = 0; v < section.n_vertices(); ++v) {
    const TetPoint p = locator.locate(section.points.row(v));
    double value = 0;
    for (int k = 0; k < 4 && p.tet >= 0; ++k)
      value += p.barycentric[static_cast<std::size_t>(k)] * values[mesh.tets(p.tet, k)];
    number.push_back(p.tet < 0 ? -1
                               : out.add_point({section.points(v, 0), section.points(v, 1),
                                                section.points(v, 2), value}));
  }
  for (int f = 0; f < section.n_faces(); ++f) {
    std::vector<int> corners;
    for (const int v : section.face(f))
      if (number[static_cast<std::size_t>(v)] >= 0)
        corners.push_back(number[static_cast<std::size_t>(v)]);
    out.add_polygon(corners);
  }
  return out.soup(field);
}

void write_tet_field(const std::string& file, const TetMesh& mesh, const VecX& values,
                     const std::string& field, const Session& session) {
  const std::string extension = extension_of(file);
  if (extension == ".vtk" || extension == ".vtu") return io::write_tets(file, mesh, values, field);
  if (extension == ".csv" || extension == ".npy" || extension == ".txt") {
    PolygonSoup points;
    points.points = mesh.points;
    points.scalars[field] = values;
    return io::write_field(file, points, field);
  }
  const PolygonSoup boundary = boundary_of({mesh, {}, {{field, values}}});
  if (extension != ".html" && extension != ".png") return io::write_field(file, boundary, field);
  io::Scene scene = io::make_scene(boundary, field);
  scene.title = std::filesystem::path(file).stem().string();
  scene.facts = {{"domain", "tet mesh"}, {"tets", std::to_string(mesh.n_tets())}};
  for (const auto& option : session.report.options) scene.facts.push_back(option);
  extension == ".html" ? io::write_page(file, scene) : io::write_picture(file, scene);
}

void distance_through_tets(const TetArguments& arguments, Session& session) {
  for (const std::string& file : arguments.out) check_output(file, tet_outputs, "a field on tets");
  check_method<TetDomain>(arguments.method);
  const auto [file, sources] = [&] {
    const Stopwatch watch(session.report, "read");
    io::TetFile read = io::read_tets(arguments.domain);
    TetSources from = gather(arguments, read, session);
    from.flip = session.flip;
    return std::pair(std::move(read), std::move(from));
  }();
  session.reading = false;
  Task task = session.task();
  const TetDomain domain{std::make_shared<const TetMesh>(file.mesh)};
  const VecX values = solve_once<TetDomain>(arguments.method, domain, sources,
                                            task.stage(0.95, "distance"), session.report);
  {
    const Stopwatch watch(session.report, "write");
    for (const std::string& out : arguments.out) {
      task.checkpoint(0.95);
      write_tet_field(out, file.mesh, values, "distance", session);
    }
  }
  session.print_report();
}

std::vector<InfoEntry> tet_info(const io::TetFile& file) {
  const TetMesh& mesh = file.mesh;
  double flat = 0, inverted = 0, volume = 0, not_finite = 0;
  std::vector<char> used(static_cast<std::size_t>(mesh.n_vertices()), 0);
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const auto& tet : mesh.tets.rowwise()) {
    Eigen::Matrix3d edges;
    for (int k = 0; k < 3; ++k)
      edges.row(k) = mesh.points.row(tet[k + 1]) - mesh.points.row(tet[0]);
    for (const int v : tet) {
      used[static_cast<std::size_t>(v)] = 1;
      low = low.cwiseMin(mesh.points.row(v).transpose());
      high = high.cwiseMax(mesh.points.row(v).transpose());
    }
    const double signed_volume = edges.determinant() / 6;
    if (!std::isfinite(signed_volume)) {
      ++not_finite;
    } else if (!(std::abs(signed_volume) >
                 1e-14 * std::pow(edges.rowwise().norm().maxCoeff(), 3))) {
      ++flat;
    } else {
      volume += std::abs(signed_volume);
      if (signed_volume < 0) ++inverted;
    }
  }
  const MatX3i boundary = boundary_faces(mesh);
  std::string fields;
  for (const auto& [name, values] : file.scalars) fields += (fields.empty() ? "" : ", ") + name;
  return {{"vertices", double(mesh.n_vertices())},
          {"tets", double(mesh.n_tets())},
          {"triangles", double(file.triangles.rows())},
          {"boundary_faces", double(boundary.rows())},
          {"unused_vertices", double(std::count(used.begin(), used.end(), 0))},
          {"flat_tets", flat},
          {"inverted_tets", inverted},
          {"tets_with_numbers_not_finite", not_finite},
          {"volume", volume},
          {"bounding_box", std::vector<double>{low[0], low[1], low[2], high[0], high[1], high[2]}},
          {"fields", fields.empty() ? "none" : fields}};
}

void contour_tets(const std::string& name, const std::string& field,
                  const std::vector<double>& levels, const std::vector<std::string>& out,
                  Session& session) {
  check_level_outputs(out, levels.size(), surface_outputs, "a surface");
  const io::TetFile file = io::read_tets(name);
  PolygonSoup fields;
  fields.scalars = file.scalars;
  const VecX& values = file.scalars.at(choose_field(fields, field, name));
  session.reading = false;
  std::vector<Isosurface> surfaces;
  for (const double level : levels)
    surfaces.push_back(
        {level, isosurface(file.mesh, values, level, session.report, session.task())});
  session.print_warnings();
  write_isosurfaces(out, surfaces);
}

}  // namespace littoral::cli
