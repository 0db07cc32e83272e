#include "methods/geodesic/ray_bundle.h"

namespace littoral {

RayExit::RayExit(const TriangleAbove& triangle, double side_length, bool is_right,
                 bool starts_at_apex)
    : length(side_length), right(is_right), from_apex(starts_at_apex) {
  const Complex base = right ? triangle.length : 0.0;
  tail = from_apex ? triangle.apex : base;
  along = (from_apex ? base - triangle.apex : triangle.apex - base) / length;
  up = Complex(0, turned() ? -1 : 1) * along;
}

void RayBundle::use(const WindowBlock& windows) {
  windows_ = &windows;
  RayColumns& c = columns_;
  c.b0 = windows.column(WindowBlock::b0);
  c.b1 = windows.column(WindowBlock::b1);
  c.d0 = windows.column(WindowBlock::d0);
  c.d1 = windows.column(WindowBlock::d1);
  c.x = windows.column(WindowBlock::x);
  c.y = windows.column(WindowBlock::y);
  c.behind = windows.column(WindowBlock::behind);
  c.tag = windows.tags();
  double** const numbers[] = {&c.apex0,     &c.apex1, &c.to0,       &c.to1,
                              &c.to_d0,     &c.to_d1, &c.to_x,      &c.to_y,
                              &c.to_behind, &c.cut,   &c.cut_first, &c.cut_second};
  std::int64_t** const flags[] = {&c.covers, &c.goes, &c.ends, &c.meets, &c.follows};
  const std::size_t needed = windows.size() + 2 * RayColumns::spare;
  if (numbers_.size() >= needed * std::size(numbers)) return;
  // An odd number of lines of the cache, so that columns do not lie in the same places of it.
  const std::size_t room = (2 * needed / 8 | 1) * 8;
  numbers_.assign(room * std::size(numbers), 0);
  flags_.assign(room * std::size(flags), 0);
  for (std::size_t i = 0; i < std::size(numbers); ++i)
    *numbers[i] = numbers_.data() + i * room + RayColumns::spare;
  for (std::size_t i = 0; i < std::size(flags); ++i)
    *flags[i] = flags_.data() + i * room + RayColumns::spare;
}

void RayBundle::leave(const TriangleAbove& triangle, const RayExit& exit, const EdgeEnds& ends,
                      int first, int last) {
  kernels_.leave_through(
      columns_, first, last,
      {triangle.length, triangle.apex.real(), triangle.apex.imag(), exit.right, exit.from_apex,
       exit.length, exit.tail.real(), exit.tail.imag(), exit.along.real(), exit.along.imag(),
       exit.up.real(), exit.up.imag(), ends.tail, ends.head, ends.tail_slack, ends.head_slack,
       ends.length, ends.narrow(), slack_share});
}

}  // namespace littoral
