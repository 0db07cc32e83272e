#include "api/space/volume_meaning.h"

#include <algorithm>
#include <cmath>

#include "base/index.h"
#include "base/option_table.h"
#include "contour/isosurface.h"
#include "littoral/error.h"

namespace littoral {

namespace {

constexpr double least_slope = 0.7, largest_slope = 1.4;  // of what is taken for distance
constexpr std::size_t most_sampled_cells = 4'000'000;
constexpr double mostly = 0.5, nearly_all = 0.9;  // of the nodes on a volume's border
constexpr double more_than_within = 1.1;

/// What is seen of values without knowing what they are.
struct ValueTraits {
  double low = infinity, high = -low;
  bool zero_and_another = true;  // no other values than 0 and one more
  double zero_slope = 0;         // median over the cells that the zero set passes
  double near_one = 0;           // share of the cells that are not flat, with a slope near 1
};

bool is_near_one(double slope) { return slope >= least_slope && slope <= largest_slope; }

void look_at_values(const Volume& volume, ValueTraits& seen) {
  double other = 0;
  for (const double value : volume.values) {
    if (!std::isfinite(value)) {
      seen.zero_and_another = false;
      continue;
    }
    seen.low = std::min(seen.low, value);
    seen.high = std::max(seen.high, value);
    if (value == 0 || value == other) continue;
    if (other != 0) seen.zero_and_another = false;
    other = value;
  }
}

/// Slope at the middle of a cell, and whether values of both signs are at its corners; nothing
/// where a corner is not finite.
std::optional<std::pair<double, bool>> cell_slope(const Volume& volume, int i, int j, int k) {
  Vec3 slope = Vec3::Zero();
  double low = infinity, high = -low;
  for (int c = 0; c < 8; ++c) {
    const int a[3] = {c & 1, c >> 1 & 1, c >> 2};
    const double value = volume.values[index(volume.grid.node(i + a[0], j + a[1], k + a[2]))];
    if (!std::isfinite(value)) return std::nullopt;
    low = std::min(low, value);
    high = std::max(high, value);
    for (int d = 0; d < 3; ++d) slope[d] += (a[d] ? value : -value) / 4;
  }
  return std::pair(slope.cwiseQuotient(volume.grid.spacing).norm(), low <= 0 && high > 0);
}

void look_at_slopes(const Volume& volume, ValueTraits& seen) {
  const auto& n = volume.grid.n;
  const std::size_t step = 1 + volume.grid.n_nodes() / most_sampled_cells;
  constexpr double flat = 0.05;
  std::vector<double> at_zero;
  std::size_t cells = 0, near = 0, at = 0;
  for (int k = 0; k + 1 < n[2]; ++k)
    for (int j = 0; j + 1 < n[1]; ++j)
      for (int i = 0; i + 1 < n[0]; ++i) {
        if (at++ % step != 0) continue;
        const auto cell = cell_slope(volume, i, j, k);
        if (!cell) continue;
        if (cell->second) at_zero.push_back(cell->first);
        if (cell->first < flat) continue;
        ++cells;
        near += is_near_one(cell->first);
      }
  if (cells > 0) seen.near_one = static_cast<double>(near) / static_cast<double>(cells);
  if (at_zero.empty()) return;
  const auto middle = at_zero.begin() + static_cast<std::ptrdiff_t>(at_zero.size() / 2);
  std::nth_element(at_zero.begin(), middle, at_zero.end());
  seen.zero_slope = *middle;
}

[[noreturn]] void throw_unclear(const ValueTraits& seen) {
  const bool both = seen.low < 0 && seen.high > 0;
  std::string text =
      "the values go from " + rounded_text(seen.low) + " to " + rounded_text(seen.high);
  if (both)
    text += ", have a slope of about " + rounded_text(seen.zero_slope) +
            " where they are 0, and near 1 in " + rounded_text(std::round(100 * seen.near_one)) +
            " % of the cells";
  throw InputError(
      text +
          ", which is neither a mask (0 and one other value) nor signed distance "
          "(both signs, slope 1). Say what they are: option as distance (taken as it is, "
          "negative inside), option as mask (not 0 is inside), option as density (larger "
          "than option threshold is inside), or option redistance (measured from where "
          "they are 0, negative inside)",
      "volume-meaning");
}

/// Shares of the nodes that are inside: of all, and of those on the border of the box.
struct InsideShares {
  double all = 0, border = 0;
};

InsideShares inside_shares(const Volume& mask, bool flip) {
  const auto& n = mask.grid.n;
  double inside = 0, at_border = 0, border = 0;
  for (int k = 0; k < n[2]; ++k)
    for (int j = 0; j < n[1]; ++j)
      for (int i = 0; i < n[0]; ++i) {
        const double value = mask.values[index(mask.grid.node(i, j, k))];
        const bool is_inside = (value != 0) != flip;
        const bool is_border =
            i == 0 || j == 0 || k == 0 || i + 1 == n[0] || j + 1 == n[1] || k + 1 == n[2];
        inside += is_inside;
        border += is_border;
        at_border += is_border && is_inside;
      }
  return {inside / static_cast<double>(mask.grid.n_nodes()), at_border / border};
}

Volume with_border(const Volume& mask, bool flip) {
  Volume out;
  for (int d = 0; d < 3; ++d) out.grid.n[d] = mask.grid.n[d] + 2;
  out.grid.spacing = mask.grid.spacing;
  out.grid.origin = mask.grid.origin - mask.grid.spacing;
  out.values = VecX::Ones(index(out.grid.n_nodes()));
  for (int k = 0; k < mask.grid.n[2]; ++k)
    for (int j = 0; j < mask.grid.n[1]; ++j)
      for (int i = 0; i < mask.grid.n[0]; ++i)
        if ((mask.values[index(mask.grid.node(i, j, k))] != 0) != flip)
          out.values[index(out.grid.node(i + 1, j + 1, k + 1))] = 0;
  return out;
}

Shape shape_of_mask(const Volume& mask, bool flip) {
  if (!mask.values.allFinite())
    throw InputError("a mask needs finite values, 0 outside", "not-finite");
  const double low = mask.values.minCoeff(), high = mask.values.maxCoeff();
  if (low < high && (mask.values.array() != 0).all())
    throw InputError("no value of the mask is 0, so that nothing is outside: they run from " +
                         rounded_text(low) + " to " + rounded_text(high) +
                         ". Option as density takes as inside what is larger than option threshold",
                     "volume-meaning");
  const Volume bordered = with_border(mask, flip);
  Report unheard;
  Shape shape;
  shape.surface = isosurface(bordered.grid, bordered.values, 0.5, {}, unheard);
  if (shape.surface.n_faces() == 0)
    throw InputError(
        flip ? "nothing is inside: no value is 0" : "nothing is inside: all values are 0",
        "no-inside");
  return shape;
}

Shape shape_of_density(Volume density, std::optional<double> threshold) {
  ValueTraits seen;
  look_at_values(density, seen);
  if (!(seen.low < seen.high))
    throw InputError("a density needs values that differ", "nothing-there");
  const double level = threshold.value_or((seen.low + seen.high) / 2);
  if (!(level >= seen.low && level < seen.high))
    throw InputError("option threshold: no surface at " + rounded_text(level) +
                         "; values run from " + rounded_text(seen.low) + " to " +
                         rounded_text(seen.high),
                     "nothing-there");
  density.values = -density.values;
  return shape_at_level(density, -level);
}

}  // namespace

VolumeMeaning meaning_of(const Volume& volume) {
  ValueTraits seen;
  look_at_values(volume, seen);
  if (!(seen.low <= seen.high)) throw InputError("the volume has no finite values", "empty-input");
  if (seen.zero_and_another && seen.low < seen.high) return VolumeMeaning::mask;
  look_at_slopes(volume, seen);
  const bool both = seen.low < 0 && seen.high > 0;
  if (both && is_near_one(seen.zero_slope) && 3 * seen.near_one >= 1)
    return VolumeMeaning::distance;
  throw_unclear(seen);
}

void check_side_of_mask(const Volume& mask, bool flip) {
  const InsideShares shares = inside_shares(mask, flip);
  if (shares.all == 1 || shares.border <= mostly) return;
  if (shares.border < nearly_all && shares.border <= more_than_within * shares.all) return;
  const std::string inside = flip ? "0" : "not 0";
  throw InputError("what is " + inside + " fills " + percent_text(shares.border) +
                       " of the border of the volume, as the outside of a shape does. Say which "
                       "side is inside: option as mask takes what is not 0" +
                       (flip ? "; with option flip, what is 0" : ", option flip what is 0"),
                   "volume-meaning");
}

Shape shape_of(Volume volume, VolumeMeaning meaning, std::optional<double> threshold, bool flip) {
  if (meaning == VolumeMeaning::automatic) {
    meaning = meaning_of(volume);
    if (meaning == VolumeMeaning::mask) check_side_of_mask(volume, flip);
  }
  if (threshold && meaning != VolumeMeaning::density)
    throw InputError("option threshold goes with option as density", "options-conflict");
  if (meaning == VolumeMeaning::mask) return shape_of_mask(volume, flip);
  Shape shape;
  if (meaning == VolumeMeaning::density)
    shape = shape_of_density(std::move(volume), threshold);
  else
    shape.field = std::move(volume);
  shape.request.flip = flip;
  return shape;
}

}  // namespace littoral
