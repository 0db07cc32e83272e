#include "methods/heat/strip_cells.h"

#include <algorithm>
#include <utility>

#include "base/index.h"

namespace littoral {

StripCells::StripCells(const Calculus& C, const std::vector<int>& row_of) : begin(1, 0) {
  const SpRows G = C.G.matrix();
  const auto n = std::size_t(C.A.size());
  std::vector<std::pair<int, int>> order(n, {int_size(row_of), 0});  // first row, cell
  for (std::size_t c = 0; c < n; ++c) {
    order[c].second = static_cast<int>(c);
    for (const auto at : {2 * index(c), 2 * index(c) + 1})
      for (SpRows::InnerIterator it(G, at); it; ++it)
        order[c].first = std::min(order[c].first, row_of[it.col()]);
  }
  std::sort(order.begin(), order.end());
  begin.reserve(n + 1);
  row.reserve(3 * n);
  slope.reserve(6 * n);
  area.reserve(n);
  place.resize(n);
  for (const auto& [first, c] : order) {
    place[c] = int_size(area);
    area.push_back(C.A[c]);
    SpRows::InnerIterator x(G, 2 * c), y(G, 2 * c + 1);
    while (x || y) {  // the nodes of both rows, ascending
      const auto node = x && y ? std::min(x.col(), y.col()) : x ? x.col() : y.col();
      const bool in_x = x && x.col() == node, in_y = y && y.col() == node;
      row.push_back(row_of[node]);
      slope.push_back(in_x ? x.value() : 0);
      slope.push_back(in_y ? y.value() : 0);
      if (in_x) ++x;
      if (in_y) ++y;
    }
    begin.push_back(int_size(row));
  }
}

}  // namespace littoral
