#pragma once
// Pulling a way through tets taut without leaving them.

#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "domain/tet/tet_sight.h"
#include "methods/geodesic/taut_way.h"

namespace littoral {

/// From a point of a face of the source over turns to a vertex.
struct WayInTets {
  int face = -1, from = -1;  // from: the vertex of the mesh that the face is, -1: none
  Vec3 start = Vec3::Zero();
  std::vector<EdgeTurn> turns{};
  double length = 0;
};

/// The point of a face of the source that is nearest to x; of all faces that ways from there may
/// also come from, with its face.
using SourceFoot = std::function<std::pair<int, Vec3>(int face, const Vec3& x, bool of_all)>;

/// Pulls ways taut: every step replaces a way within the tets by a shorter one within them, so that
/// no way is ever too short. A turn that is taken out or moved sweeps triangles, and the way goes
/// round those edges in them at which the boundary is reentrant. Each thread has its own.
class TautInTets {
 public:
  /// reentrant: vertex -> the other ends of the edges where ways may turn, sorted.
  TautInTets(const TetMesh& mesh, const TetSight& sight,
             const std::vector<std::vector<int>>& reentrant, const SourceFoot& foot);

  /// way: one within the tets to `vertex`.
  void pull(WayInTets& way, int vertex);

 private:
  /// A point of a way: a turn, or where it starts, without an edge (a < 0) within a face.
  struct Node {
    Vec3 at;
    EdgeTurn turn{-1, -1};
  };
  using Nodes = std::vector<Node>;

  Vec3 point(int v) const { return mesh_.points.row(v); }
  Node node(const EdgeTurn& turn) const { return {place_of(mesh_.points, turn), turn}; }

  bool sees(const Node& from, const Node& to);
  std::optional<Nodes> round(const Node& p, const Node& c, const Node& q);
  Nodes edges_in(const Node& p, const Node& c, const Node& q);
  void open_tets(const Node& at);
  bool is_needed(const Node& p, const Node& c, const Node& q);
  bool drop(Nodes& way, std::size_t i);
  void pass_corners(Nodes& way);
  bool replace(Nodes& way, std::size_t i, const Node& over);
  void start_nearer(WayInTets& way, Nodes& nodes);
  void turn_onto_edges(Nodes& way) const;
  Nodes taut_places(int face, const Nodes& way) const;
  Nodes moved(const Nodes& way, const Nodes& to, double share);

  const TetMesh& mesh_;
  const TetSight& sight_;
  const std::vector<std::vector<int>>& reentrant_;
  const SourceFoot& foot_;
  TetSight::Walk walk_;
  std::vector<unsigned> seen_;  // tets
  unsigned stamp_ = 0;
  std::vector<int> open_;
};

}  // namespace littoral
