#pragma once
// Oriented samples in clusters, each with what is needed to sum the Yukawa kernel over it from
// afar.

#include <vector>

#include "sources/space/oriented_points.h"

namespace littoral {

/// Places relative to the tree's origin; areas A in units of their mean.
struct YukawaSample {
  float x, y, z;
  float nx, ny, nz;  // A n
  float area;
};

/// Where a cluster is: what a search looks at most.
struct YukawaBox {
  float low[3], high[3];
  int child;       // two of them, at child and child + 1; -1: a leaf
  int begin, end;  // samples
};

/// What a cluster holds. d: from its centre to a sample. Symmetric matrices: xx, yy, zz, xy, xz,
/// yz.
struct YukawaMoments {
  float centre[3];     // mean of its samples by area
  float area;          // sum A
  float spread[6];     // sum A d d^T / sum A [length^2]
  float normal[3];     // sum A n
  float first[3][3];   // sum A n_i d_j
  float second[3][6];  // sum A n_i d d^T
};

/// Parents stand before their children, the root first. Immutable.
struct YukawaTree {
  std::vector<YukawaBox> boxes;  // clusters
  std::vector<YukawaMoments> moments;
  std::vector<YukawaSample> samples;
  Vec3 origin = Vec3::Zero();
};

/// Of n >= 1 samples, in clusters of `leaf` at most.
YukawaTree yukawa_tree(const OrientedPoints& source, int leaf);

}  // namespace littoral
