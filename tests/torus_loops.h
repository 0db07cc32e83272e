#pragma once
// Loops on the torus of test_meshes.h with nu x nv quads, by vertex.

#include <vector>

namespace littoral::test {

inline constexpr int nu = 24, nv = 16;

/// Loops round the tube of a torus at station i, or along it at j.
inline std::vector<int> meridian(int i) {
  std::vector<int> loop;
  for (int j = 0; j <= nv; ++j) loop.push_back(i * nv + j % nv);
  return loop;
}
inline std::vector<int> longitude(int j) {
  std::vector<int> loop;
  for (int i = 0; i <= nu; ++i) loop.push_back((i % nu) * nv + j);
  return loop;
}
/// A disk of the torus between stations, counter-clockwise.
inline std::vector<int> disk(int i0, int i1, int j0, int j1) {
  std::vector<int> loop;
  for (int i = i0; i < i1; ++i) loop.push_back(i * nv + j0);
  for (int j = j0; j < j1; ++j) loop.push_back(i1 * nv + j);
  for (int i = i1; i > i0; --i) loop.push_back(i * nv + j1);
  for (int j = j1; j >= j0; --j) loop.push_back(i0 * nv + j);
  return loop;
}

}  // namespace littoral::test
