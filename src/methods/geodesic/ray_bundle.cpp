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

void RayBundle::make_room() {
  RayColumns& c = columns_;
  double** const numbers[] = {&c.b0,   &c.b1,        &c.d0,       &c.d1,        &c.x,
                              &c.y,    &c.behind,    &c.parallel, &c.apex0,     &c.apex1,
                              &c.to0,  &c.to1,       &c.to_d0,    &c.to_d1,     &c.to_x,
                              &c.to_y, &c.to_behind, &c.cut,      &c.cut_first, &c.cut_second};
  std::int64_t** const flags[] = {&c.covers, &c.goes, &c.ends, &c.meets};
  const std::size_t needed = windows_.size() + RayColumns::spare;
  if (numbers_.size() >= needed * std::size(numbers)) return;
  const std::size_t room = 2 * needed;
  numbers_.assign(room * std::size(numbers), 0);
  flags_.assign(room * std::size(flags), 0);
  for (std::size_t i = 0; i < std::size(numbers); ++i) *numbers[i] = numbers_.data() + i * room;
  for (std::size_t i = 0; i < std::size(flags); ++i) *flags[i] = flags_.data() + i * room;
}

void RayBundle::look_at(const TriangleAbove& triangle, double tolerance) {
  make_room();
  const RayColumns& c = columns_;
  for (int i = 0; i < size(); ++i) {
    const Window& w = *windows_[i];
    c.b0[i] = w.b0;
    c.b1[i] = w.b1;
    c.d0[i] = w.d0;
    c.d1[i] = w.d1;
    c.x[i] = w.x;
    c.y[i] = w.y;
    c.behind[i] = w.behind;
    c.parallel[i] = w.parallel;
  }
  kernels_.look_at_apex(c, size(), triangle.apex.real(), triangle.apex.imag(), tolerance);
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
