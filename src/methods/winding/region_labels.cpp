#include <cmath>
#include <cstdlib>
#include <map>
#include <numbers>

#include "methods/winding/surface_winding.h"
#include "solve/network/l1_integration.h"

namespace littoral {

std::vector<CurveSample> samples_on_edges(const JumpCalculus& J, const CornerFunction& w,
                                          const VecX& curve) {
  std::vector<CurveSample> samples;
  for (int e = 0; e < J.n_edges; ++e) {
    const double times = std::round(std::abs(curve[e]));
    if (times == 0 || !J.interior(e)) continue;
    double sum = 0;
    int count = 0;
    for (const JumpCalculus::Side& s : J.sides[e])
      for (const int corner : J.ends(s)) {
        if (w.open[J.node(s.face, corner)]) continue;
        sum += w.u(s.face, corner);
        ++count;
      }
    if (count == 0) continue;
    const double even = std::fmod(times, 2) == 0 ? 0.5 : 0;
    samples.push_back({J.component[J.sides[e][0].face], sum / count + even, J.length[e] * times});
  }
  return samples;
}

VecX contour_shift(const JumpCalculus& J, const std::vector<CurveSample>& samples,
                   Contour contour) {
  constexpr double turn = 2 * std::numbers::pi;
  constexpr int bins = 10;
  std::vector<Complex> circular(J.n_components, 0);
  std::vector<std::array<double, bins>> histogram(J.n_components);
  VecX sum = VecX::Zero(J.n_components), length = sum, shift = sum;
  for (const auto& [c, value, weight] : samples) {
    circular[c] += weight * std::polar(1.0, turn * value);
    const double part = value - std::floor(value);
    histogram[c][std::min(bins - 1, static_cast<int>(bins * part))] += weight;
    sum[c] += weight * value;
    length[c] += weight;
  }
  for (int c = 0; c < J.n_components; ++c) {
    if (length[c] == 0) continue;
    double value = std::arg(circular[c]) / turn;
    if (contour == Contour::mean) value = sum[c] / length[c];
    if (contour == Contour::frequent) {
      int best = 0;
      for (int b = 1; b < bins; ++b)
        if (histogram[c][b] > histogram[c][best]) best = b;
      value = (best + 0.5) / bins;
    }
    shift[c] = 0.5 - value;
  }
  return shift;
}

VecXi rounded_labels(const JumpCalculus& J, const CornerFunction& w, const VecX& shift) {
  VecXi region(J.n_faces);
  for (int f = 0; f < J.n_faces; ++f)
    region[f] = static_cast<int>(std::lround(w.u.row(f).mean() + shift[J.component[f]]));
  return region;
}

VecXi cut_labels(const JumpCalculus& J, const VecX& jump, const std::vector<FacePair>& pairs,
                 const VecX& weight, const Task& task, Report& report) {
  L1Integration problem;
  problem.n = J.n_faces;
  std::vector<double> c, w;
  const auto arc = [&](int left, int right, double step, double cost) {
    if (left == right) return;
    problem.f.push_back(left);
    problem.g.push_back(right);
    c.push_back(-std::round(step));
    w.push_back(cost);
  };
  for (int e = 0; e < J.n_edges; ++e)
    if (J.interior(e)) arc(J.sides[e][0].face, J.sides[e][1].face, jump[e], weight[e]);
  for (const FacePair& p : pairs) arc(p.left, p.right, p.jump, weight[p.edge]);
  problem.c = Eigen::Map<const VecX>(c.data(), c.size());
  problem.w = Eigen::Map<const VecX>(w.data(), w.size());
  const L1Solution solution = integrate_l1(problem, {}, task, report);
  VecXi region(J.n_faces);
  for (int f = 0; f < J.n_faces; ++f) region[f] = static_cast<int>(std::lround(solution.s[f]));
  return region;
}

void label_outside_zero(const JumpCalculus& J, VecXi& region) {
  std::vector<std::map<int, double>> area(J.n_components);
  for (int f = 0; f < J.n_faces; ++f) area[J.component[f]][region[f]] += J.area[f];
  std::vector<int> outside(J.n_components, 0);
  for (int c = 0; c < J.n_components; ++c) {
    double largest = 0;
    for (const auto& [label, a] : area[c]) {
      const bool tie = std::abs(a - largest) <= 1e-9 * a;
      if (tie ? std::abs(label) < std::abs(outside[c]) : a > largest) {
        outside[c] = label;
        largest = a;
      }
    }
  }
  for (int f = 0; f < J.n_faces; ++f) region[f] -= outside[J.component[f]];
}

}  // namespace littoral
