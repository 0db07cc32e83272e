#pragma once
// How much of the sky is seen from a surface: what makes corners readable.

#include "littoral/types.h"

namespace littoral::io {

/// Of each vertex four numbers b (3), a: the part of the sky that is seen in direction d is about
/// a + b . d, the projection of what is seen to linear functions of d. Light from everywhere then
/// reaches a side with normal n in the part open_part(): 1 where nothing stands above it. It needs
/// no orientation: either side of either face may be asked, also where faces disagree.
using Openness = Eigen::Matrix<float, Eigen::Dynamic, 4, Eigen::RowMajor>;

/// Asks in 64 directions, each by a picture of heights with 256 or, from 50,000 vertices on, 512
/// pixels across the surface: what is closer together than two of them is not told apart. Vertices
/// of no triangle count as open. Vertices of triangles must be finite. The same for any thread
/// count.
Openness openness(const MatX3& points, const MatX3i& triangles);

/// The integral of (a + b . d) (n . d)+ / pi over the directions d, between 0 and 1.
float open_part(const Eigen::Vector4f& openness, const Vec3& normal);

/// By how much a side is darker for it, .3 to 1.
inline float occlusion(const Eigen::Vector4f& openness, const Vec3& normal) {
  return 0.3f + 0.7f * open_part(openness, normal);
}

}  // namespace littoral::io
