#pragma once
// Generalized winding number of triangles or oriented points in space.

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "base/task.h"
#include "littoral/types.h"
#include "spatial/cluster_tree.h"
#include "spatial/crossing_number.h"
#include "spatial/dipole_moments.h"
#include "spatial/winding_kernels.h"

namespace littoral {

/// Sum of signed solid angles over 4 pi: 1 inside a closed surface whose normals point outward, 0
/// outside, in between where it is broken. Exact where the triangles' boundary has no edges or few
/// (crossing_number.h), or where that is faster. Otherwise far clusters are expanded
/// (Barill et al., "Fast winding numbers for soups and clouds", 2018; here to the fourth order of
/// the distance from their centres: dipole_moments.h); near triangles count exactly (van Oosterom
/// and Strackee 1983), near points as dipoles. Immutable, may be evaluated from several threads.
class WindingNumber {
 public:
  static constexpr double usual_accuracy = 2.6;
  /// For comparisons with 1/2, to which errors of 3e-3 do not matter.
  static constexpr double sign_accuracy = 1.7;

  /// Whether `at` is asked for, which takes 40 bytes more for every triangle or point.
  enum class Queries { single, together };

  /// points: n x 3; faces: m x 3, rows index points, no order or connection needed. Faces with a
  /// corner that is not finite count as nothing.
  WindingNumber(const MatX3& points, const MatX3i& faces, Queries queries = Queries::single);

  /// points, normals: n x 3, normals of unit length; areas: n. All finite.
  WindingNumber(const MatX3& points, const MatX3& normals, const VecX& areas,
                Queries queries = Queries::single);

  /// `accuracy` is the distance from which a cluster is expanded, in radii of the cluster: 2.6
  /// keeps the error near 1e-4, 1.7 below 3e-3; infinity sums exactly.
  double operator()(const Vec3& query, double accuracy = usual_accuracy) const;

  /// The same at points (queries x 3), to the usual accuracy, sooner for `Queries::together`
  /// (winding_cells.cpp): then what one point is given depends on how many are near it, within that
  /// accuracy. Throws Cancelled.
  VecX at(const MatX3& queries, const Task& task) const;

  /// Whether values are exact whatever the accuracy.
  bool exact() const { return exact_; }

 private:
  friend class WindingCells;
  static constexpr double four_pi = 4 * M_PI;

  // A cluster from far away.
  struct Expansion {
    Vec3 low, high;  // box of its items
    Vec3 centre;     // middle of the box
    double radius = 0;
    DipoleMoments moments;  // of the vector area, about the centre
  };
  using Triangle = std::array<Vec3, 3>;

  // Up to eight clusters of the binary tree under one of their ancestors.
  struct Node {
    ClusterLanes moments;
    std::array<int, winding_lanes> child;  // another node, -1 - leaf, or `none`
  };
  static constexpr int none = std::numeric_limits<int>::min();

  // Items in the order of the tree; coordinates are relative to origin_, in units of unit_.
  struct Items {
    ClusterTree tree;
    std::vector<Triangle> triangles;  // empty for points
    std::vector<Vec3> centres, areas;
  };

  void set_frame(const MatX3& points);
  void build(const Items& items, Queries queries);
  static GroupCluster expanded(const Expansion& expansion, int child);
  int add_leaf(const Items& items, const Cluster& cluster, const Expansion& expansion);
  int add_node(const Items& items, const std::vector<Expansion>& expansions, int root);
  double leaf_sum(int leaf, const double* q, bool exactly) const;
  /// What a sum over clusters looks at.
  struct Work {
    int nodes = 0, leaves = 0;
  };
  double clustered_sum(const Vec3& q, double accuracy, Work* work = nullptr) const;
  double nanoseconds_of_clusters(const Vec3& half) const;

  Vec3 origin_ = Vec3::Zero();
  double unit_ = 1;
  Vec3 total_ = Vec3::Zero();  // vector area
  bool exact_ = false;
  CrossingNumber crossing_;  // one of the two: this, or the tree below
  int root_ = none;
  std::vector<Node> nodes_;
  std::vector<GroupCluster> clusters_;  // the tree of two children each, of which nodes are made
  std::vector<TriangleLanes> triangle_leaves_;  // one of the two
  std::vector<NarrowTriangleLanes> narrow_leaves_;
  std::vector<DipoleLanes> dipole_leaves_;
};

/// The same, one solid angle after the other in extended precision: what the fast sum is tested
/// against.
double winding_number_brute_force(const MatX3& points, const MatX3i& faces, const Vec3& query);

}  // namespace littoral
