#include "methods/heat/heat_strips.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/index.h"
#include "base/now_and_then.h"
#include "methods/heat/time_scale.h"

namespace littoral {

namespace {

constexpr int points_at_once = strip_width;
using PerPoint = std::array<double, strip_width>;

/// Components of the rows; -1 for those of nodes that are left out.
std::vector<int> components_of_rows(const Calculus& C, const std::vector<int>& row_of,
                                    const std::vector<char>* without) {
  std::vector<int> component(C.component.size(), -1);
  for (std::size_t i = 0; i < component.size(); ++i)
    if (!without || !(*without)[i]) component[row_of[i]] = C.component[i];
  return component;
}

}  // namespace

struct HeatStrips::Work {
  ScaledStrip u, other;  // heat by Neumann's and by Dirichlet's conditions
  Strip b, x, spare;
  std::vector<char> apart;  // cells that are done one by one
  std::vector<int> slot;    // rows: their place among those where a distance is known; -1
  PerPoint longest{};
  std::array<PerPoint, 3> shares{};  // areas of cells: with directions, against, off unit
};

struct HeatStrips::NearPoints {
  std::vector<int> rows;           // where a distance is known beforehand
  std::vector<PerPoint> distance;  // there [units]; 0 from other points
  std::vector<int> cells;          // with such a corner or between two layers, ascending
  std::vector<std::array<char, strip_width>> holds;  // those: 1 next to the point
  std::vector<std::array<Vec2, strip_width>> direction;
};

StripParts::StripParts(std::shared_ptr<const Operators> operators, const ScalarHeat& heat,
                       const Poisson& equation)
    : ops(std::move(operators)),
      row_of(heat.kept()->neumann->factor()->structure()->new_of),
      component(components_of_rows(ops->scalar, row_of, nullptr)),
      cells(ops->scalar, row_of),
      poisson(equation, row_of) {
  cells_begin.assign(row_of.size() + 1, 0);
  for (const int row : cells.row) ++cells_begin[row];
  int sum = 0;
  for (int& begin : cells_begin) sum += std::exchange(begin, sum);
  cells_at.resize(cells.row.size());
  std::vector<int> at = cells_begin;
  for (int c = 0; c < cells.size(); ++c)
    for (int e = cells.begin[c]; e < cells.begin[c + 1]; ++e) cells_at[at[cells.row[e]]++] = c;
}

std::shared_ptr<const StripParts> HeatStrips::parts(std::shared_ptr<const Operators> ops,
                                                    const ScalarHeat& heat,
                                                    const Poisson& poisson) {
  const ScalarHeat::Systems* const kept = heat.kept();
  const bool factors = kept && kept->neumann->factor() &&
                       (!kept->dirichlet || kept->dirichlet->factor()) &&
                       poisson.system().exact_factor();
  return factors ? std::make_shared<const StripParts>(std::move(ops), heat, poisson) : nullptr;
}

HeatStrips::HeatStrips(std::shared_ptr<const StripParts> parts, const ScalarHeat& heat)
    : parts_(std::move(parts)),
      neumann_(heat.kept()->neumann, parts_->row_of, parts_->component,
               parts_->ops->scalar.n_components) {
  const Calculus& C = parts_->ops->scalar;
  if (heat.kept()->dirichlet)
    dirichlet_ = std::make_unique<const StripHeat>(
        heat.kept()->dirichlet, parts_->row_of, components_of_rows(C, parts_->row_of, &C.boundary),
        C.n_components);
}

HeatStrips::~HeatStrips() = default;

bool HeatStrips::takes(const SourceSystem& system) {
  return system.only_points && system.u0.cols() == 1 && system.value.size() == 1 &&
         system.value[0] == 0 && system.mean_value.size() == 1 && system.mean_value[0] == 0 &&
         std::count(system.reached.begin(), system.reached.end(), 1) == 1;
}

std::unique_ptr<HeatStrips::Work> HeatStrips::taken_work() const {
  {
    const std::lock_guard lock(mutex_);
    if (!idle_.empty()) {
      auto work = std::move(idle_.back());
      idle_.pop_back();
      return work;
    }
  }
  auto work = std::make_unique<Work>();
  const auto n = index(parts_->row_of.size());
  work->u.x.resize(n, points_at_once);
  work->b.resize(n, points_at_once);
  work->x.resize(n, points_at_once);
  work->apart.assign(parts_->cells.area.size(), 0);
  work->slot.assign(parts_->row_of.size(), -1);
  return work;
}

void HeatStrips::diffuse(const std::vector<const SourceSystem*>& systems, Work& work,
                         const Task& task) const {
  const Calculus& C = parts_->ops->scalar;
  std::array<double, points_at_once> largest;  // of what was put for each
  const auto put = [&](ScaledStrip& field, bool inside_only) {
    std::vector<int> given;
    largest.fill(0);
    field.x.setZero(index(parts_->row_of.size()), points_at_once);
    for (std::size_t k = 0; k < systems.size(); ++k)
      for (SpMat::InnerIterator it(systems[k]->u0, 0); it; ++it) {
        if (!(C.M[it.row()] > 0) || (inside_only && C.boundary[it.row()])) continue;
        double& put_there = field.x(parts_->row_of[it.row()], index(k));
        put_there += it.value();
        largest[k] = std::max(largest[k], std::abs(put_there));
        given.push_back(parts_->row_of[it.row()]);
      }
    std::sort(given.begin(), given.end());
    given.erase(std::unique(given.begin(), given.end()), given.end());
    return given;
  };
  neumann_.solve(work.u, put(work.u, false), false, work.spare, task);
  if (!dirichlet_) return;
  // The mean of both where they are on the same scale, within the first layer, as in ScalarHeat.
  // Each solution is in units of the largest entry of what was put.
  auto unit = largest;
  dirichlet_->solve(work.other, put(work.other, true), true, work.spare, task);
  for (int k = 0; k < points_at_once; ++k) unit[k] = unit[k] > 0 ? largest[k] / unit[k] : 0;
  for (Eigen::Index i = 0; i < work.u.x.rows(); ++i)
    for (int k = 0; k < points_at_once; ++k)
      if (work.u.layer_at(i, k) == 0)
        work.u.x(i, k) = 0.5 * (work.u.x(i, k) + unit[k] * work.other.x(i, k));
}

void HeatStrips::find_near(const std::vector<const SourceSystem*>& systems, NearPoints& near,
                           Work& work) const {
  for (std::size_t k = 0; k < systems.size(); ++k) {
    const VecX& d0 = systems[k]->d0;
    for (Eigen::Index i = 0; i < d0.size(); ++i) {
      if (d0[i] == 0) continue;
      int& slot = work.slot[parts_->row_of[i]];
      if (slot < 0) {
        slot = int_size(near.rows);
        near.rows.push_back(parts_->row_of[i]);
        near.distance.emplace_back().fill(0);
      }
      near.distance[slot][k] = d0[i];
    }
  }
  const auto add = [&](int c) {
    if (std::exchange(work.apart[c], 1) == 0) near.cells.push_back(c);
  };
  for (const int row : near.rows)
    for (int at = parts_->cells_begin[row]; at < parts_->cells_begin[row + 1]; ++at)
      add(parts_->cells_at[at]);
  for (const SourceSystem* system : systems)
    for (const int c : system->near) add(parts_->cells.place[c]);
  if (!work.u.layer.empty())
    for (int c = 0; c < parts_->cells.size(); ++c) {
      const auto layers = [&](int e) {
        return work.u.layer.begin() + index(parts_->cells.row[e]) * points_at_once;
      };
      for (int e = parts_->cells.begin[c] + 1; e < parts_->cells.begin[c + 1]; ++e)
        if (!std::equal(layers(e), layers(e) + points_at_once, layers(parts_->cells.begin[c])))
          add(c);
    }
  std::sort(near.cells.begin(), near.cells.end());
  near.holds.assign(near.cells.size(), {});
  for (std::size_t k = 0; k < systems.size(); ++k)
    for (const int c : systems[k]->near) {
      const int place = parts_->cells.place[c];
      const auto at = std::lower_bound(near.cells.begin(), near.cells.end(), place);
      near.holds[std::size_t(at - near.cells.begin())][k] = 1;
    }
}

/// As cell_field finds it: in the units of the first layer that the cell has something in.
Vec2 HeatStrips::direction(const ScaledStrip& u, int cell, int column) const {
  const auto in_layer = [&](int p) {
    Vec2 g = Vec2::Zero();
    for (int e = parts_->cells.begin[cell]; e < parts_->cells.begin[cell + 1]; ++e)
      if (u.layer_at(parts_->cells.row[e], column) == p)
        g += u.x(parts_->cells.row[e], column) *
             Vec2(parts_->cells.slope[2 * e], parts_->cells.slope[2 * e + 1]);
    return g;
  };
  const auto& scale = u.scale[column];
  for (int p = 0; p < int_size(scale); ++p) {
    Vec2 g = in_layer(p);
    if (!(g.cwiseAbs().maxCoeff() > no_gradient)) continue;
    if (p + 1 < int_size(scale)) g += scale[p + 1] * in_layer(p + 1);
    const double m = g.cwiseAbs().maxCoeff();
    if (!(m > no_gradient)) continue;
    g /= m;
    return -g / g.norm();
  }
  return Vec2::Zero();
}

void HeatStrips::add_flow(NearPoints& near, Work& work) const {
  near.direction.resize(near.cells.size());
  for (std::size_t at = 0; at < near.cells.size(); ++at) {
    const int c = near.cells[at];
    for (int k = 0; k < points_at_once; ++k) {
      Vec2 g0 = Vec2::Zero();  // of the distance that is known
      for (int e = parts_->cells.begin[c]; e < parts_->cells.begin[c + 1]; ++e)
        if (const int s = work.slot[parts_->cells.row[e]]; s >= 0)
          g0 += near.distance[s][k] *
                Vec2(parts_->cells.slope[2 * e], parts_->cells.slope[2 * e + 1]);
      const Vec2 Y = near.holds[at][k] ? g0 : direction(work.u, c, k);
      near.direction[at][k] = Y;
      work.longest[k] = std::max(work.longest[k], Y.cwiseAbs().maxCoeff());
      const Vec2 flow = parts_->cells.area[c] * (Y - g0);
      for (int e = parts_->cells.begin[c]; e < parts_->cells.begin[c + 1]; ++e)
        work.b(parts_->cells.row[e], k) +=
            flow[0] * parts_->cells.slope[2 * e] + flow[1] * parts_->cells.slope[2 * e + 1];
    }
  }
}

void HeatStrips::add_shares(const NearPoints& near, Work& work) const {
  for (std::size_t at = 0; at < near.cells.size(); ++at) {
    const int c = near.cells[at];
    for (int k = 0; k < points_at_once; ++k) {
      const Vec2& Y = near.direction[at][k];
      if (Y.isZero(0)) continue;
      Vec2 g = Vec2::Zero();
      for (int e = parts_->cells.begin[c]; e < parts_->cells.begin[c + 1]; ++e) {
        const int row = parts_->cells.row[e], s = work.slot[row];
        const double phi = work.x(row, k) + (s < 0 ? 0 : near.distance[s][k]);
        g += phi * Vec2(parts_->cells.slope[2 * e], parts_->cells.slope[2 * e + 1]);
      }
      work.shares[0][k] += parts_->cells.area[c];
      if (!(Y.dot(g) > 0)) work.shares[1][k] += parts_->cells.area[c];
      if (!(std::abs(g.norm() - 1) <= off_unit_by)) work.shares[2][k] += parts_->cells.area[c];
    }
  }
}

void HeatStrips::write_values(const std::vector<const SourceSystem*>& systems, Values kind,
                              const NearPoints& near, const Work& work,
                              std::vector<StripDistance>& out) const {
  const std::size_t n = parts_->row_of.size();
  const Calculus& C = parts_->ops->scalar;
  const double unit = parts_->ops->unit;
  // What is subtracted in each component, so that distance is 0 at its point.
  std::vector<PerPoint> at_point(std::size_t(C.n_components));
  for (PerPoint& of : at_point) of.fill(-infinity);
  std::array<double*, strip_width> to{};
  for (std::size_t k = 0; k < systems.size(); ++k) {
    double weight = 0, sum = 0;
    for (SpMat::InnerIterator it(systems[k]->u0, 0); it; ++it) {
      weight += it.value();
      sum += it.value() * work.x(parts_->row_of[it.row()], index(k));
    }
    for (std::size_t c = 0; c < at_point.size(); ++c)
      if (systems[k]->reached[c]) at_point[c][k] = sum / weight;
    out[k].values.resize(index(n));
    to[k] = out[k].values.data();
  }
  const double least = kind == Values::not_negative ? 0 : -infinity;
  for (std::size_t i = 0; i < n; ++i) {
    const int row = parts_->row_of[i], c = C.component[i], s = work.slot[row];
    const double* x = work.x.data() + index(row) * points_at_once;
    for (std::size_t k = 0; k < systems.size(); ++k) {
      const double d = c < 0 ? infinity : x[k] - at_point[c][k] + (s < 0 ? 0 : near.distance[s][k]);
      to[k][i] = unit * std::max(d, least);
    }
  }
}

std::vector<StripDistance> HeatStrips::solve(const std::vector<const SourceSystem*>& systems,
                                             Values values_are, const Task& task) const {
  constexpr int cells_between_stops = 1 << 16;
  auto work = taken_work();
  diffuse(systems, *work, task);
  NearPoints near;
  find_near(systems, near, *work);
  const StripCellKernels& kernels = strip_cell_kernels();
  const auto over_cells = [&](const auto& pass) {
    for (int c = 0; c < parts_->cells.size(); c += cells_between_stops) {
      stop_if_cancelled(task);
      pass(c, std::min(parts_->cells.size(), c + cells_between_stops));
    }
  };
  work->longest.fill(0);
  work->b.setZero();
  over_cells([&](int first, int end) {
    kernels.divergence(parts_->cells, first, end, work->apart.data(), work->u.x.data(),
                       work->b.data(), work->longest.data());
  });
  add_flow(near, *work);
  const auto residual = parts_->poisson.solve(work->b, work->x, work->spare, task);
  for (PerPoint& areas : work->shares) areas.fill(0);
  over_cells([&](int first, int end) {
    kernels.shares(parts_->cells, first, end, work->apart.data(), work->u.x.data(), work->x.data(),
                   work->shares[0].data());
  });
  add_shares(near, *work);

  std::vector<StripDistance> out(systems.size());
  for (std::size_t k = 0; k < systems.size(); ++k) {
    StripDistance& d = out[k];
    const double all = work->shares[0][k];
    d.misaligned = all > 0 ? work->shares[1][k] / all : 0;
    d.off_unit = all > 0 ? work->shares[2][k] / all : 0;
    d.passes = work->u.passes[k];
    d.residual = residual[k];
    d.found =
        work->u.missed[k] == 0 && work->longest[k] > no_gradient && std::isfinite(residual[k]);
  }
  write_values(systems, values_are, near, *work, out);
  for (const int c : near.cells) work->apart[c] = 0;
  for (const int row : near.rows) work->slot[row] = -1;
  const std::lock_guard lock(mutex_);
  idle_.push_back(std::move(work));
  return out;
}

}  // namespace littoral
