#pragma once
// Nodes of source files, checked against the mesh, and curves made of them.

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "domain/mesh/surface_mesh.h"
#include "littoral/sources.h"

namespace littoral::io {

/// Turns indices and parameters as they are written in a file into surface points. Every function
/// throws InputError, beginning with where(), for an index out of range, a parameter outside [0,
/// 1], barycentric coordinates that are negative or do not add up to 1, and places that are not
/// finite.
class NodeMaker {
 public:
  /// `where` says what is being read ("name:line"); it is only called when something is wrong.
  NodeMaker(const SurfaceMesh& mesh, std::function<std::string()> where)
      : mesh_(mesh), where_(std::move(where)) {}

  /// Vertex `index`, counted from `base`.
  SurfacePoint vertex(std::int64_t index, int base) const;
  /// (1-t) tail + t head of an edge in the mesh's numbering, counted from `base`.
  SurfacePoint edge(std::int64_t index, double t, int base) const;
  /// (1-t) i + t j on the edge between two vertices.
  SurfacePoint edge(std::int64_t i, std::int64_t j, double t, int base) const;
  /// Barycentric coordinates in a triangle; what is off by no more than `barycentric_slack` is put
  /// right.
  SurfacePoint face(std::int64_t index, std::array<double, 3> b, int base) const;

  /// Face `index`, counted from `base`.
  int whole_face(std::int64_t index, int base) const;

  [[noreturn]] void fail(const std::string& text) const;

 private:
  int in_range(std::int64_t index, int base, int count, const char* what) const;
  void check_parameter(double t) const;
  void check_finite(int vertex) const;

  const SurfaceMesh& mesh_;
  std::function<std::string()> where_;
};

/// A directed segment between two numbered points.
using Segment = std::pair<int, int>;

/// Joins segments head to tail into polylines: through a point where exactly one segment ends and
/// one begins, and nowhere else. Every segment appears once, in its own direction; a closed
/// polyline repeats its first point. The order follows the segments'.
std::vector<std::vector<int>> chain(std::span<const Segment> segments, int n_points);

/// Signed-heat .txt or surface-winding-number .txt, told apart by the presence of a keyword line.
Sources read_sources_txt(std::string_view bytes, const std::string& name, const SurfaceMesh& mesh,
                         std::optional<int> index_base);

/// The .json format described at read_sources.
Sources read_sources_json(std::string_view bytes, const std::string& name, const SurfaceMesh& mesh,
                          std::optional<int> index_base);

}  // namespace littoral::io
