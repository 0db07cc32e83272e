#include "io/sources/write_sources.h"

#include <nlohmann/json.hpp>

#include "io/surface/surface_writers.h"
#include "littoral/error.h"
#include "sources/surface/surface_points.h"

namespace littoral::io {

namespace {

using OrderedJson = nlohmann::ordered_json;

bool is_same(const SurfacePoint& a, const SurfacePoint& b) {
  if (a.on != b.on || a.element != b.element) return false;
  return a.on == SurfacePoint::On::vertex || a.b == b.b;
}

/// Vertices of clouds belong to no face.
void check_exists(const SurfaceMesh& mesh, const SurfacePoint& p) {
  const bool vertex = p.on == SurfacePoint::On::vertex;
  if (!vertex || p.element < 0 || p.element >= mesh.n_vertices()) check_element(mesh, p);
}

std::string node_line(const SurfacePoint& p, const SurfaceMesh& mesh) {
  check_exists(mesh, p);
  const std::string element = std::to_string(p.element);
  if (p.on == SurfacePoint::On::vertex) return "v " + element + "\n";
  if (p.on == SurfacePoint::On::edge)
    return "e " + std::to_string(mesh.edges()(p.element, 0)) + " " +
           std::to_string(mesh.edges()(p.element, 1)) + " " + exact_text(p.b[1]) + "\n";
  return "f " + element + " " + exact_text(p.b[0]) + " " + exact_text(p.b[1]) + " " +
         exact_text(p.b[2]) + "\n";
}

OrderedJson node_json(const SurfacePoint& p, const SurfaceMesh& mesh) {
  check_exists(mesh, p);
  if (p.on == SurfacePoint::On::vertex) return {{"v", p.element}};
  if (p.on == SurfacePoint::On::edge)
    return {{"e", {mesh.edges()(p.element, 0), mesh.edges()(p.element, 1)}}, {"t", p.b[1]}};
  return {{"f", p.element}, {"b", p.b}};
}

OrderedJson curve_json(bool is_signed, bool is_closed, double value, const char* key,
                       OrderedJson nodes) {
  if (is_closed) nodes.erase(nodes.end() - 1);
  OrderedJson out{{"signed", is_signed}, {"closed", is_closed}, {key, std::move(nodes)}};
  if (value != 0) out["value"] = value;
  return out;
}

std::string keyword_line(const char* keyword, double value) {
  return keyword + (value != 0 ? " value " + exact_text(value) : std::string()) + "\n";
}

std::string chains_txt(const Sources& sources) {
  if (!sources.curves.empty() || !sources.points.empty())
    throw UnsupportedError("chains of faces are written to a file of their own",
                           "unsupported-file");
  std::string out = "#offset 0\n";
  for (const FaceChain& chain : sources.chains) {
    out += "c";
    for (const int face : chain.faces) out += " " + std::to_string(face);
    out += "\n";
  }
  return out;
}

}  // namespace

std::string sources_txt(const Sources& sources, const SurfaceMesh& mesh) {
  if (!sources.space_curves.empty())
    throw UnsupportedError("a .txt file does not hold curves in space; .json does",
                           "unsupported-file");
  if (!sources.chains.empty()) return chains_txt(sources);
  std::string out;
  for (const Curve& curve : sources.curves) {
    out += keyword_line(curve.is_signed ? "signed_curve" : "unsigned_curve", curve.value);
    for (const SurfacePoint& node : curve.nodes) out += node_line(node, mesh);
  }
  for (std::size_t i = 0; i < sources.points.size(); ++i) {
    if (i == 0 || sources.point_value(i) != sources.point_value(i - 1))
      out += keyword_line("unsigned_point", sources.point_value(i));
    out += node_line(sources.points[i], mesh);
  }
  return out;
}

std::string sources_json(const Sources& sources, const SurfaceMesh& mesh) {
  if (!sources.chains.empty())
    throw UnsupportedError("a .json file does not hold chains of faces; .txt does",
                           "unsupported-file");
  OrderedJson curves = OrderedJson::array(), points = OrderedJson::array();
  for (const Curve& curve : sources.curves) {
    OrderedJson nodes = OrderedJson::array();
    for (const SurfacePoint& node : curve.nodes) nodes.push_back(node_json(node, mesh));
    // Written as closed only where two nodes are left: with fewer it would not be read again.
    const bool closed = curve.nodes.size() > 2 && is_same(curve.nodes.front(), curve.nodes.back());
    curves.push_back(curve_json(curve.is_signed, closed, curve.value, "nodes", std::move(nodes)));
  }
  for (const SpaceCurve& curve : sources.space_curves) {
    OrderedJson nodes = OrderedJson::array();
    for (const auto& x : curve.points.rowwise()) nodes.push_back({x[0], x[1], x[2]});
    const Eigen::Index last = curve.points.rows() - 1;
    const bool closed = last >= 2 && curve.points.row(0) == curve.points.row(last);
    curves.push_back(curve_json(curve.is_signed, closed, curve.value, "points", std::move(nodes)));
  }
  for (std::size_t i = 0; i < sources.points.size(); ++i) {
    points.push_back(node_json(sources.points[i], mesh));
    if (sources.point_value(i) != 0) points.back()["value"] = sources.point_value(i);
  }
  return OrderedJson{{"curves", curves}, {"points", points}}.dump(1) + "\n";
}

}  // namespace littoral::io
