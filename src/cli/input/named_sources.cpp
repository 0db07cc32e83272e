// Sources given as options, without a file.

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "api/space/input_queries.h"
#include "base/option_table.h"
#include "cli/input/numbers.h"
#include "cli/input/surface_input.h"
#include "littoral/error.h"
#include "spatial/finite_box.h"

namespace littoral::cli {

namespace {

/// Whole numbers at the beginning of a list, as vertices or faces of the mesh.
int checked_element(const std::string& option, double number, int count, const std::string& file,
                    const Session& session) {
  const int base = session.index_base.value_or(0);
  if (number != std::floor(number) || number < base || number - base >= count)
    throw InputError("option " + option + ": there is no element " + number_text(number) + "; " +
                         file + " has " + std::to_string(count) + ", counted from " +
                         std::to_string(base),
                     "no-such-element");
  return static_cast<int>(number) - base;
}

SurfacePoint in_named_face(const std::string& text, const SurfaceMesh& mesh,
                           const std::string& file, const Session& session) {
  const std::vector<double> n = parse_numbers("face", text);
  if (n.size() != 4)
    throw InputError("option face takes a face and three barycentric coordinates: I,a,b,c",
                     "option-value");
  const int face = checked_element("face", n[0], mesh.n_faces(), file, session);
  const double sum = n[1] + n[2] + n[3];
  if (n[1] < 0 || n[2] < 0 || n[3] < 0 || std::abs(sum - 1) > 1e-6)
    throw InputError("option face: barycentric coordinates are not negative and add up to 1, " +
                         text + " has " + number_text(sum),
                     "option-value");
  return SurfacePoint::in_face(face, n[1] / sum, n[2] / sum, n[3] / sum);
}

SurfacePoint on_named_edge(const std::string& text, const SurfaceMesh& mesh,
                           const std::string& file, const Session& session) {
  const std::vector<double> n = parse_numbers("edge", text);
  if (n.size() != 3 || n[2] < 0 || n[2] > 1)
    throw InputError("option edge takes two vertices and the place between them, 0 to 1: I,J,t",
                     "option-value");
  const int i = checked_element("edge", n[0], mesh.n_vertices(), file, session);
  const int j = checked_element("edge", n[1], mesh.n_vertices(), file, session);
  const int edge = mesh.find_edge(i, j);
  if (edge < 0)
    throw InputError("option edge: " + file + " has no edge from " + number_text(n[0]) + " to " +
                         number_text(n[1]),
                     "no-such-element");
  return SurfacePoint::on_edge(edge, mesh.edges()(edge, 0) == i ? n[2] : 1 - n[2]);
}

/// The nearest point of triangles; of polygons and clouds the nearest vertex.
SurfacePoint nearest_to(const std::string& text, const SurfaceMesh& mesh,
                        const NearestOnInput& nearest, Session& session) {
  const Vec3 x = parse_position("at", text);
  const NearestPoints found = nearest.at(x.transpose(), session.task());
  const double size = points_size(mesh.soup().points);
  const auto warn_if_far = [&](double distance, const std::string& from) {
    if (distance > 0.01 * size)
      session.report.warn("source-moved",
                          "option at: " + text + " is " + rounded_text(distance) + " from " + from);
  };
  warn_if_far(found.distances[0], "the surface; its nearest point there is taken");
  const int face = found.elements[0];
  const auto b = found.barycentric.row(0);
  if (mesh.n_faces() > 0 && mesh.face(face).size() == 3)
    return SurfacePoint::in_face(face, b[0], b[1], b[2]);
  const Vec3 there = found.points.row(0);
  const auto corners = mesh.n_faces() > 0 ? mesh.face(face) : std::span(&face, 1);
  const int vertex = *std::ranges::min_element(
      corners, {}, [&](int v) { return (Vec3(mesh.point(v)) - there).norm(); });
  if (mesh.n_faces() > 0)
    warn_if_far((Vec3(mesh.point(vertex)) - there).norm(),
                "vertex " + std::to_string(vertex + session.index_base.value_or(0)) +
                    ", which is taken: sources lie inside triangles only, and face " +
                    std::to_string(face + session.index_base.value_or(0)) + " has " +
                    std::to_string(corners.size()) + " corners");
  return SurfacePoint::at_vertex(vertex);
}

}  // namespace

void add_named_curves(CLI::App& verb, NamedSources& named) {
  add_repeated_option(verb, "--curve-vertices", named.curves,
                      "a signed curve through these vertices, from 0; closed where the last is the "
                      "first; may be repeated")
      ->type_name("I,J,...");
}

void add_named_sources(CLI::App& verb, NamedSources& named) {
  add_repeated_option(verb, "--vertex", named.vertices,
                      "a source vertex, from 0; several as 1,5,9 or repeated")
      ->delimiter(',')
      ->check(whole_number(std::numeric_limits<long long>::min(),
                           std::numeric_limits<long long>::max()))
      ->type_name("I[,I...]");
  add_repeated_option(verb, "--at", named.at,
                      "the point of the surface nearest to a place; may be repeated")
      ->type_name("X,Y,Z");
  add_repeated_option(verb, "--face", named.faces,
                      "a point of a face, from 0, by barycentric coordinates; may be repeated")
      ->type_name("I,A,B,C");
  add_repeated_option(verb, "--edge", named.edges,
                      "a point of an edge: t = 0 is the first vertex, 1 the other; may be repeated")
      ->type_name("I,J,T");
  add_named_curves(verb, named);
}

Sources named_sources(const NamedSources& named, const SurfaceMesh& mesh, const std::string& file,
                      Session& session) {
  Sources sources;
  for (const int v : checked_vertices(named.vertices, mesh.n_vertices(), file, session))
    sources.add(SurfacePoint::at_vertex(v));
  if (!named.at.empty()) {
    const NearestOnInput nearest(mesh.soup());
    for (const std::string& text : named.at) sources.add(nearest_to(text, mesh, nearest, session));
  }
  for (const std::string& text : named.faces) sources.add(in_named_face(text, mesh, file, session));
  for (const std::string& text : named.edges) sources.add(on_named_edge(text, mesh, file, session));
  for (const std::string& text : named.curves) {
    std::vector<int> vertices;
    for (const double v : parse_numbers("curve-vertices", text))
      vertices.push_back(checked_element("curve-vertices", v, mesh.n_vertices(), file, session));
    if (vertices.size() < 2)
      throw InputError("option curve-vertices takes at least two vertices", "option-value");
    sources.add(Curve::along_vertices(vertices));
  }
  return sources;
}

}  // namespace littoral::cli
