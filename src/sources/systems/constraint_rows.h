#pragma once
// What is constrained at a source: its nodes, its connected parts, and rows on the vertices.

#include <algorithm>
#include <array>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include "base/disjoint_sets.h"
#include "sources/surface/surface_points.h"
#include "sources/systems/source_system.h"

namespace littoral {

/// A matrix of few entries for its size, those at one place added in the order they come:
/// setFromTriplets passes over all rows and columns several times.
SpMat matrix_of_few(Triplets entries, Eigen::Index rows, Eigen::Index columns);

/// Nodes of a source, each place once. Joined nodes belong to one connected part.
class SourceNodes {
 public:
  int id(const SurfacePoint& p);
  void join(int a, int b) { joined_.join(a, b); }
  int root(int a) { return joined_.find(a); }
  std::vector<SurfacePoint> points;
  std::vector<double> weight;  // length that the node's value stands for, mean edge lengths
  std::vector<double> value;   // the least of the sources' there [units]; +inf: of none yet

 private:
  std::map<std::tuple<int, int, std::array<double, 3>>, int> ids_;
  DisjointSets joined_;
};

/// Hat functions at a point in its simplest form: (vertex, value).
std::vector<std::pair<int, double>> hats(const SurfaceMesh& mesh, const SurfacePoint& p);

/// Constraint rows. A curve along edges, and every point, holds values at its nodes. A curve
/// through faces holds means over stretches of about 2.5 edge lengths: as many conditions as
/// crossed edges would leave a linear function on the crossed triangles no choice but zero at all
/// their corners.
class ConstraintRowBuilder {
 public:
  /// h: mean edge length.
  explicit ConstraintRowBuilder(double h) : h_(h) {}

  /// A piece inside a face: hat functions at its middle, its length, one of its nodes, its value.
  void add_piece(const std::vector<std::pair<int, double>>& middle, double length, int node,
                 double value) {
    run_.push_back({middle, length / h_, node, value});
  }
  /// Ends a stretch of consecutive pieces inside faces.
  void end_run();
  /// Ends the last stretch, adds the nodes that have weight and writes A, value, weight, group
  /// and n_groups.
  void write(const SurfaceMesh& mesh, SourceNodes& nodes, SourceSystem& system);

 private:
  struct Row {
    std::vector<std::pair<int, double>> entries;  // vertex, coefficient; may repeat a vertex
    double weight = 0;                            // length, mean edge lengths
    int node = 0;                                 // a node of the same connected part
    double value = 0;                             // times the weight while rows are summed
  };
  double h_;
  std::vector<Row> run_, rows_;
};

}  // namespace littoral
