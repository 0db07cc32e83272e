#pragma once
// Triples of numbers that are there more than once; none is negative.

#include <algorithm>
#include <array>
#include <vector>

#include "base/index.h"
#include "base/parallel.h"
#include "littoral/types.h"

namespace littoral {

/// Places of the first of each key, ascending.
std::vector<int> first_of_each(const std::vector<std::array<int, 3>>& keys);

/// Of some rows, ascending, those that hold the same three numbers, in any order, as an earlier one
/// of them.
struct RepeatedRow {
  int row, first;
};
std::vector<RepeatedRow> repeated_rows(const Eigen::Ref<const MatX3i>& rows,
                                       const std::vector<int>& some);

/// Where there is no single face across a side.
constexpr int no_face = -1, several_faces = -2;

/// The same of faces by the edges of their three sides. across(f): the other face at side 0 of face
/// f, `no_face` or `several_faces`; a copy lies across every side, so that few faces are compared.
template <class Across>
std::vector<RepeatedRow> repeated_faces(const Eigen::Ref<const MatX3i>& edges,
                                        const Across& across) {
  constexpr std::size_t grain = 8192;
  const auto sorted = [&](int f) {
    std::array<int, 3> key{edges(f, 0), edges(f, 1), edges(f, 2)};
    std::sort(key.begin(), key.end());
    return key;
  };
  std::vector<char> may_be(std::size_t(edges.rows()), 0);
  parallel_for(may_be.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const int f = static_cast<int>(i), other = across(f);
      may_be[i] = other == several_faces || (other >= 0 && sorted(f) == sorted(other));
    }
  });
  std::vector<int> some;
  for (int f = 0; f < int_size(may_be); ++f)
    if (may_be[f]) some.push_back(f);
  return repeated_rows(edges, some);
}

}  // namespace littoral
