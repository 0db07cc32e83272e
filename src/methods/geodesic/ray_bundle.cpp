#include "methods/geodesic/ray_bundle.h"

#include <algorithm>
#include <array>

namespace littoral {

RayExit::RayExit(const TriangleAbove& triangle, double side_length, bool is_right,
                 bool starts_at_apex)
    : length(side_length), right(is_right), from_apex(starts_at_apex) {
  const Complex base = right ? triangle.length : 0.0;
  tail = from_apex ? triangle.apex : base;
  along = (from_apex ? base - triangle.apex : triangle.apex - base) / length;
  up = Complex(0, turned() ? -1 : 1) * along;
}

void RayBundle::look_at(const TriangleAbove& triangle) {
  const double px = triangle.apex.real(), py = triangle.apex.imag();
  const int n = (size() + lanes - 1) / lanes;
  if (blocks_.size() < std::size_t(n)) blocks_.resize(n);
  for (int i = 0; i < n; ++i) {
    Block& of = blocks_[i];
    std::array<const Window*, lanes> from;
    for (int lane = 0; lane < lanes; ++lane)
      from[lane] = windows_[std::min(lanes * i + lane, size() - 1)];
    const auto gather = [&](double Window::*member) {
      return Lanes(from[0]->*member, from[1]->*member, from[2]->*member, from[3]->*member);
    };
    of.b0 = gather(&Window::b0);
    of.b1 = gather(&Window::b1);
    of.x = gather(&Window::x);
    of.y = gather(&Window::y);
    of.behind = gather(&Window::behind);
    of.g0 = of.b0 - of.x;
    of.g1 = of.b1 - of.x;
    of.gy = -of.y;
    for (int lane = 0; lane < lanes; ++lane) {
      if (!from[lane]->parallel) continue;
      of.g0[lane] = of.g1[lane] = of.x[lane];
      of.gy[lane] = of.y[lane];
    }
    of.apex0 = of.g0 * py - of.gy * (px - of.b0);
    of.apex1 = of.g1 * py - of.gy * (px - of.b1);
  }
}

template <bool right>
void RayBundle::carry(const TriangleAbove& triangle, const RayExit& exit, Block& of) const {
  const double px = triangle.apex.real(), py = triangle.apex.imag(), L = triangle.length;
  const double base = right ? L : 0.0;
  // Where the rays at the ends leave, as shares of the way from the edge below to the apex. The
  // outer ray leaves nearer to the edge; the inner one may pass the apex.
  const auto share = [&](const Lanes& b, const Lanes& g) -> Lanes {
    return (of.gy * (base - b) / (g * py - of.gy * (px - base))).max(0.0).min(1.0);
  };
  Lanes share0 = share(of.b0, of.g0), share1 = share(of.b1, of.g1);
  if (right)
    share0 = (of.apex0 > 0).select(share0, Lanes::Ones());
  else
    share1 = (of.apex1 < 0).select(share1, Lanes::Ones());
  const double start = exit.from_apex ? exit.length : 0.0,
               step = exit.from_apex ? -exit.length : exit.length;
  const bool turned = exit.turned();
  of.to0 = start + step * (turned ? share1 : share0);
  of.to1 = start + step * (turned ? share0 : share1);
  const Lanes dx = of.x - exit.tail.real(), dy = of.y - exit.tail.imag();
  of.to_x = dx * exit.along.real() + dy * exit.along.imag();
  of.to_y = dx * exit.up.real() + dy * exit.up.imag();
  const Lanes y2 = of.to_y * of.to_y;
  of.to_d0 = of.behind + ((of.to0 - of.to_x).square() + y2).sqrt();
  of.to_d1 = of.behind + ((of.to1 - of.to_x).square() + y2).sqrt();
}

void RayBundle::leave(const TriangleAbove& triangle, const RayExit& exit, int first, int last) {
  for (int i = first / lanes; i * lanes < last; ++i) {
    if (exit.right)
      carry<true>(triangle, exit, blocks_[i]);
    else
      carry<false>(triangle, exit, blocks_[i]);
  }
}

void RayBundle::left_as(int i, const RayExit& exit, std::uint16_t page, Window& w) const {
  const Block& of = blocks_[i / lanes];
  const int lane = i % lanes;
  const Window& from = *windows_[i];
  w.b0 = of.to0[lane];
  w.b1 = of.to1[lane];
  w.source = from.source;
  w.page = page;
  w.depth = static_cast<std::uint8_t>(std::min(from.depth + 1, Window::deep));
  w.parallel = from.parallel;
  w.behind = from.behind;
  if (from.parallel) {
    const Complex direction(from.x, from.y);
    w.behind += (std::conj(direction) * exit.tail).real();
    w.x = (std::conj(direction) * exit.along).real();
    w.y = (std::conj(direction) * exit.up).real();
    w.measure_ends();
  } else {
    w.x = of.to_x[lane];
    w.y = of.to_y[lane];
    w.d0 = of.to_d0[lane];
    w.d1 = of.to_d1[lane];
  }
}

}  // namespace littoral
