#include "methods/heat/cell_field.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/index.h"
#include "base/parallel.h"

namespace littoral {

namespace {
constexpr std::size_t field_grain = 8192;
}

CellField no_field(Eigen::Index cells) {
  CellField out{VecX(2 * cells), VecX(cells)};
  parallel_for(std::size_t(cells), field_grain, [&](std::size_t begin, std::size_t end) {
    const auto first = index(begin), n = index(end - begin);
    out.Y.segment(2 * first, 2 * n).setZero();
    out.log_length.segment(first, n).setConstant(-infinity);
  });
  return out;
}

CellField cell_field(const LinearMap& map, const ScaledField<double>& field) {
  // A cell has dofs in one layer or in two that follow each other: what it has in the first
  // and, in its units, in the second.
  constexpr double negligible = 1e-290;
  CellField out = no_field(map.rows / 2);
  const int n_layers = field.scale.size();
  double log_scale = 0;
  VecX y = n_layers > 0 ? map.apply(n_layers == 1 ? field.x : field.in_layer(0)) : VecX(), next;
  for (int p = 0; p < n_layers; ++p, std::swap(y, next)) {
    log_scale += std::log(field.scale[p]);
    const bool last = p + 1 == n_layers;
    if (!last) next = map.apply(field.in_layer(p + 1));
    parallel_for(out.log_length.size(), field_grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t s = begin; s < end; ++s) {
        const auto c = index(s);
        if (std::isfinite(out.log_length[c])) continue;
        Eigen::Vector2d v = y.segment<2>(2 * c);
        if (!(v.cwiseAbs().maxCoeff() > negligible)) continue;
        if (!last) v += field.scale[p + 1] * next.segment<2>(2 * c);
        const double m = v.cwiseAbs().maxCoeff();
        if (!(m > negligible)) continue;
        v /= m;
        const double length = v.norm();
        out.Y.segment<2>(2 * c) = v / length;
        out.log_length[c] = log_scale + std::log(m * length);
      }
    });
  }
  return out;
}

void restore_units(ScaledField<double>& field, const HeatSource<double>& b,
                   const std::vector<int>& piece) {
  const Eigen::Index block = b.block();
  const std::vector<double> largest = largest_of_pieces(b, piece);
  const double top = largest.empty() ? 0 : *std::max_element(largest.begin(), largest.end());
  if (!(top > 0)) return;
  field.scale[0] *= top;
  if (std::all_of(largest.begin(), largest.end(), [top](double m) { return m == top; })) return;
  for (std::size_t i = 0; i < piece.size(); ++i)
    if (piece[i] >= 0)  // bounded: fields of different pieces are never compared
      field.x.segment(index(i) * block, block) *= std::max(1e-20, largest[piece[i]] / top);
}

void take_longer(CellField& field, const CellField& other, double log_factor) {
  parallel_for(field.log_length.size(), field_grain, [&](std::size_t begin, std::size_t end) {
    for (Eigen::Index c = index(begin); c < index(end); ++c) {
      if (!(other.log_length[c] + log_factor > field.log_length[c])) continue;
      field.log_length[c] = other.log_length[c] + log_factor;
      field.Y.segment<2>(2 * c) = other.Y.segment<2>(2 * c);
    }
  });
}

VecX normalize(VecX Y) {
  parallel_for(Y.size() / 2, field_grain, [&](std::size_t begin, std::size_t end) {
    for (Eigen::Index c = index(begin); c < index(end); ++c) {
      const double m = Y.segment<2>(2 * c).cwiseAbs().maxCoeff();
      if (!(m > 0)) continue;
      Y.segment<2>(2 * c) /= m;
      Y.segment<2>(2 * c).normalize();
    }
  });
  return Y;
}

}  // namespace littoral
