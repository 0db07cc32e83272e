#pragma once
// Generalized winding number of triangles or oriented points in space.

#include <array>
#include <vector>

#include "littoral/base/types.h"
#include "littoral/spatial/cluster_tree.h"

namespace littoral {

/// Sum of signed solid angles over 4 pi: 1 inside a closed surface whose normals point outward, 0
/// outside, in between where it is broken. Far clusters are expanded to second order (Barill et
/// al., "Fast winding numbers for soups and clouds", 2018); near triangles count exactly (van
/// Oosterom and Strackee 1983), near points as dipoles. Immutable, may be evaluated from several
/// threads.
class WindingNumber {
 public:
  /// points: n x 3; faces: m x 3, rows index points, no order or connection needed. Faces with a
  /// corner that is not finite count as nothing.
  WindingNumber(const MatX3& points, const MatX3i& faces);

  /// points, normals: n x 3, normals of unit length; areas: n. All finite.
  WindingNumber(const MatX3& points, const MatX3& normals, const VecX& areas);

  /// `accuracy` is the distance from which a cluster is expanded, in radii of the cluster: 3 keeps
  /// the error below 1e-3, 2.3 below 3e-3; infinity sums exactly.
  double operator()(const Vec3& query, double accuracy = 3) const;

 private:
  // Moments of the vector area about the centre, contracted as the expansion needs them.
  struct Moments {
    Vec3 centre;
    double radius = 0;
    Vec3 area = Vec3::Zero();        // sum of vector areas a
    double trace = 0;                // of the first moment, sum of a d^T
    std::array<double, 6> first{};   // its symmetric part: xx yy zz xy yz zx
    Vec3 second = Vec3::Zero();      // 2 sum Q_iik + sum Q_kjj, Q = sum of a (d d^T)
    std::array<double, 10> cubic{};  // Q r r r by monomial
  };
  using Triangle = std::array<Vec3, 3>;

  void add(Moments& m, std::size_t item) const;
  double expand(const Moments& m, const Vec3& query) const;
  double near_sum(int begin, int end, const Vec3& query) const;
  void build(const MatX3& centres, const std::vector<Vec3>& areas);

  ClusterTree tree_;
  std::vector<Moments> moments_;       // per cluster
  std::vector<Triangle> triangles_;    // by place; empty for points
  std::vector<Vec3> centres_, areas_;  // by place
};

/// The same, one solid angle after the other in extended precision: what the fast sum is tested
/// against.
double winding_number_brute_force(const MatX3& points, const MatX3i& faces, const Vec3& query);

}  // namespace littoral
