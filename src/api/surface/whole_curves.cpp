#include "api/surface/whole_curves.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

#include "api/surface/edge_chains.h"
#include "api/surface/heat_near_curves.h"
#include "api/surface/heat_surface.h"
#include "base/groups.h"
#include "base/option_table.h"
#include "base/stopwatch.h"
#include "littoral/error.h"
#include "methods/winding/shortest_completion.h"
#include "sources/curves/completed_curves.h"
#include "sources/curves/conform.h"
#include "sources/curves/curve_ends.h"
#include "sources/curves/straighten.h"
#include "sources/surface/source_values.h"
#include "sources/surface/surface_points.h"

namespace littoral {

namespace {

// A jump that contradicts the curve costs less on the curve than beside it: reversed pieces are
// evidence of a boundary, too.
constexpr double weight_on_curve = 0.7;

/// Appends chains of vertices of the cut mesh as unsigned curves on the mesh it was cut from.
void append_chains(const SurfaceMesh& mesh, const CutMesh& cut,
                   const std::vector<std::vector<int>>& chains, PlacedSources& to) {
  for (const std::vector<int>& chain : chains) {
    bool goes_on = false;
    for (std::size_t i = 0; i + 1 < chain.size(); ++i)
      goes_on = append_step(mesh, simplest(mesh, cut.point[chain[i]]),
                            simplest(mesh, cut.point[chain[i + 1]]), goes_on, to);
  }
}

void report_lengths(double given, int ends, double added, double overruled, Report& report) {
  report.sizes.emplace_back("given_length", given);
  report.sizes.emplace_back("curve_ends", ends);
  report.sizes.emplace_back("shortest_completion_length", added);
  report.sizes.emplace_back("overruled_length", overruled);
}

}  // namespace

/// Integer winding numbers on the mesh cut along curves.
struct WholeCurves::Labelled {
  ConformingCurves curves;
  std::shared_ptr<const JumpSurface> on;
  ShortestCompletion labels;
  std::vector<int> component;  // triangles -> component of the input, -1: none

  /// Jumps on the curve or off it (edges), on the components whose labels are taken.
  VecX jumps(const std::vector<char>& settled, bool on_curve) const {
    VecX out = VecX::Zero(labels.jump.size());
    for (int e = 0; e < out.size(); ++e) {
      if (labels.jump[e] == 0 || (curves.times[e] != 0) != on_curve) continue;
      const int c = component[on->J->sides[e][0].face];
      if (c >= 0 && settled[c]) out[e] = labels.jump[e];
    }
    return out;
  }
};

WholeCurves::WholeCurves(SurfaceDomain triangles, std::shared_ptr<const IntrinsicTriangulation> T,
                         SurfaceDomain heat, SolveHint hint)
    : domain_(std::move(triangles)), T_(std::move(T)), on_heat_(std::move(heat)), hint_(hint) {
  if (on_heat_.mesh == domain_.mesh) return;
  // Where the local triangles of a cloud overlap they have no regions.
  const auto overlaps = [](int n) { return n > 2; };
  has_regions_ = std::none_of(T_->edge_use.begin(), T_->edge_use.end(), overlaps);
}

int WholeCurves::component_of(int face) const {
  return domain_.mesh->vertex_component()[domain_.mesh->face(face)[0]];
}

WholeCurves::Labelled WholeCurves::labelled(const std::vector<CurvePiece>& pieces, Complete which,
                                            const Task& task) const {
  Report quiet;  // the mesh has been spoken of
  Labelled out{conform(*domain_.mesh, pieces), {}, {}, {}};
  const CutMesh& cut = out.curves.cut;
  const auto made = [&] { return std::make_shared<const JumpSurface>(cut.mesh, quiet); };
  out.on = out.curves.is_cut ? made() : uncut_.get(made);
  out.labels =
      shortest_completion(*out.on->J, out.curves.times, which, weight_on_curve, task, quiet);
  out.component.assign(std::size_t(out.on->J->n_faces), -1);
  for (int f = 0; f < cut.mesh.n_faces(); ++f)
    if (const int t = out.on->T.triangle_of_face[f]; t >= 0)
      out.component[t] = component_of(cut.parent_face[f]);
  return out;
}

WholeSources WholeCurves::complete(const Sources& given, const PlacedSources& placed,
                                   Completion how, Task task, Report& report) const {
  WholeSources whole{placed, VecX::Ones(domain_.mesh->n_vertices()), Completion::none};
  if (pieces_with_sides(placed).empty()) return whole;
  const ValueRange values = signed_value_range(given);
  const auto finish = [&] {
    if (whole.by == Completion::none) return whole;
    if (!values.same())
      throw UnsupportedError(
          "signed curves of different values that do not bound, one by one, cannot be completed; "
          "method signed-heat takes them");
    for (std::size_t i = placed.pieces.size(); i < whole.sources.pieces.size(); ++i)
      whole.sources.pieces[i].value = values.low;
    return whole;
  };
  const Stopwatch watch(report, "completion");
  std::vector<char> settled(std::size_t(domain_.mesh->n_components()), 0);
  if (how != Completion::heat && has_regions_ && !all_have_ends(placed, how, report))
    settled = settle(placed, how, whole, task.stage(0.4, "integer winding numbers"), report);
  std::vector<char> open(settled.size(), 0);
  for (const CurvePiece& piece : placed.pieces) {
    const int c = component_of(piece.face);
    if (piece.is_signed && c >= 0 && !settled[c]) open[c] = 1;
  }
  if (std::find(open.begin(), open.end(), 1) == open.end()) return finish();
  if (how == Completion::none)
    throw InputError(
        "option completion: none needs curves that bound; these have gaps, reversed "
        "pieces or no inside",
        "no-inside");
  complete_by_heat(given, placed, open, whole, task.stage(0.6, "signed heat"), report);
  whole.by = Completion::heat;
  return finish();
}

bool WholeCurves::all_have_ends(const PlacedSources& placed, Completion how, Report& report) const {
  if (how != Completion::automatic) return false;
  const std::optional<CurveEnds> ends = curve_ends(*domain_.mesh, *T_, placed);
  if (!ends) return false;
  for (const CurvePiece& piece : placed.pieces)
    if (piece.is_signed && ends->of_component[component_of(piece.face)] == 0) return false;
  report_lengths(ends->length,
                 std::accumulate(ends->of_component.begin(), ends->of_component.end(), 0), 0, 0,
                 report);
  return true;
}

std::vector<char> WholeCurves::settle(const PlacedSources& placed, Completion how,
                                      WholeSources& whole, Task task, Report& report) const {
  std::vector<char> settled(std::size_t(domain_.mesh->n_components()), 1);
  const std::optional<Labelled> maybe = [&]() -> std::optional<Labelled> {
    try {
      return labelled(pieces_with_sides(placed),
                      how == Completion::shortest    ? Complete::all
                      : how == Completion::automatic ? Complete::without_ends
                                                     : Complete::none,
                      task.stage(0.6, "shortest completion"));
    } catch (const UnsupportedError&) {  // a curve where three faces meet; heat does without
      return {};
    }
  }();
  if (!maybe) return std::vector<char>(settled.size(), 0);
  const Labelled& found = *maybe;
  const double unit = found.on->T.unit;
  double given = 0, added = 0, overruled = 0;
  int ends = 0;
  for (const ShortestCompletion::Part& part : found.labels.parts) {
    given += part.given * unit;
    ends += part.ends;
    if (!part.solved) continue;
    added += part.added * unit;
    overruled += part.overruled * unit;
  }
  report_lengths(given, ends, added, overruled, report);
  std::vector<char> completed(found.labels.parts.size(), 0);
  for (int t = 0; t < found.on->J->n_faces; ++t) {
    const int part = found.labels.part[t];
    const ShortestCompletion::Part& p = found.labels.parts[part];
    if (p.given > 0 && (p.largest != 1 || !p.solved) && found.component[t] >= 0)
      settled[found.component[t]] = 0;
    completed[part] = !p.bounds();
  }
  bool any = false;
  for (int t = 0; t < found.on->J->n_faces; ++t)
    any = any || (completed[found.labels.part[t]] && found.component[t] >= 0 &&
                  settled[found.component[t]]);
  whole.by = any ? Completion::shortest : Completion::none;
  if (any && straighten_completion(found, settled, whole, task.stage(1, "straightening")))
    return settled;
  add_sides(found, settled, whole);
  const CutMesh& cut = found.curves.cut;
  append_chains(*domain_.mesh, cut, edge_chains(cut.mesh, found.jumps(settled, false)),
                whole.sources);
  return settled;
}

/// Completions run along edges; shortened, they end as geodesics. The labels follow. False if these
/// then take more than two values, where a geodesic crosses the curve.
bool WholeCurves::straighten_completion(const Labelled& zigzag, const std::vector<char>& settled,
                                        WholeSources& whole, const Task& task) const {
  const SurfaceMesh& mesh = *domain_.mesh;
  const CutMesh& cut = zigzag.curves.cut;
  PlacedSources boundary, completion;
  append_chains(mesh, cut, edge_chains(cut.mesh, zigzag.jumps(settled, true)), boundary);
  for (const auto& chain : edge_chains(cut.mesh, zigzag.jumps(settled, false))) {
    SurfacePath path;
    for (const int v : chain) path.nodes.push_back(simplest(mesh, cut.point[v]));
    for (std::size_t i = 0; i + 1 < chain.size(); ++i)
      path.faces.push_back(common_face(mesh, path.nodes[i], path.nodes[i + 1]));
    if (std::find(path.faces.begin(), path.faces.end(), -1) != path.faces.end()) return false;
    straighten(mesh, path, 1 / T_->unit, task);
    bool goes_on = false;
    for (std::size_t i = 0; i + 1 < path.nodes.size(); ++i) {
      append_step(mesh, path.nodes[i], path.nodes[i + 1], goes_on, completion);
      goes_on = append_step(mesh, path.nodes[i], path.nodes[i + 1], goes_on, boundary);
    }
  }
  for (CurvePiece& piece : boundary.pieces) piece.is_signed = true;
  const Labelled straight = labelled(boundary.pieces, Complete::none, task);
  for (int t = 0; t < straight.on->J->n_faces; ++t) {
    const ShortestCompletion::Part& part = straight.labels.parts[straight.labels.part[t]];
    const int c = straight.component[t];
    if (c >= 0 && settled[c] && part.given > 0 && !(part.bounds() && part.largest == 1))
      return false;
  }
  add_sides(straight, settled, whole);
  for (CurvePiece piece : completion.pieces) {
    piece.curve += whole.sources.n_curves;
    whole.sources.pieces.push_back(piece);
  }
  whole.sources.n_curves += completion.n_curves;
  whole.sources.nodes.insert(whole.sources.nodes.end(), completion.nodes.begin(),
                             completion.nodes.end());
  return true;
}

void WholeCurves::add_sides(const Labelled& on, const std::vector<char>& settled,
                            WholeSources& whole) const {
  const JumpCalculus& J = *on.on->J;
  const auto& faces = on.on->T.faces;
  const int n = domain_.mesh->n_vertices();
  const auto for_vertices = [&](int t, const auto& call) {
    for (int k = 0; k < 3; ++k)  // those of the input come first
      if (const int v = faces(t, k); v < n) call(v);
  };
  std::vector<char> sides(std::size_t(n), 0);  // 1: inside, 2: outside, 3: on a curve
  std::vector<char> known(on.labels.parts.size(), 0);
  bool all_known = true;
  for (int t = 0; t < J.n_faces; ++t) {
    const int c = on.component[t], part = on.labels.part[t];
    if (c < 0 || !settled[c]) continue;
    if (on.labels.parts[part].largest == 0) {
      known[part] = on.labels.parts[part].given > 0;
      all_known = all_known && known[part];
      continue;
    }
    known[part] = 1;
    const bool outside = on.labels.region[t] <= 0;
    for_vertices(t, [&](int v) {
      sides[v] |= outside ? 2 : 1;
      if (outside) whole.sign[v] = -1;
    });
  }
  if (all_known) return;

  // What hangs on by vertices alone is on their side: the way there leads through them.
  const auto is_open = [&](int t) {
    const int c = on.component[t];
    return c >= 0 && settled[c] && !known[on.labels.part[t]];
  };
  const auto open_at = groups_of<int>(std::size_t(n), [&](const auto& put) {
    for (int t = 0; t < J.n_faces; ++t)
      if (is_open(t)) for_vertices(t, [&](int v) { put(v, t); });
  });
  const auto open_of = groups_of<int>(known.size(), [&](const auto& put) {
    for (int t = 0; t < J.n_faces; ++t)
      if (is_open(t)) put(on.labels.part[t], t);
  });
  std::vector<int> todo;
  for (int v = 0; v < n; ++v)
    if (sides[v] != 0 && sides[v] != 3 && !open_at.at(v).empty()) todo.push_back(v);
  for (std::size_t next = 0; next < todo.size(); ++next)
    for (const int t : open_at.at(todo[next])) {
      const int part = on.labels.part[t];
      if (std::exchange(known[part], 1)) continue;
      for (const int other : open_of.at(part))
        for_vertices(other, [&](int v) {
          if (sides[v] != 0) return;
          sides[v] = sides[todo[next]];
          whole.sign[v] = sides[v] == 2 ? -1 : 1;
          todo.push_back(v);
        });
    }
}

Sources WholeCurves::with_sides(const Sources& given, const PlacedSources& placed) const {
  Sources out;
  if (on_heat_.mesh == domain_.mesh) {  // where curves in space lie on it has been found
    std::set<int> curves;
    for (const CurvePiece& piece : pieces_with_sides(placed)) curves.insert(piece.curve);
    for (const int c : curves) out.curves.push_back({placed.nodes[c]});
    return out;
  }
  for (const Curve& curve : given.curves)
    if (curve.is_signed) out.curves.push_back(curve.with_value(0));
  for (SpaceCurve curve : given.space_curves) {
    curve.value = 0;
    if (curve.is_signed) out.space_curves.push_back(std::move(curve));
  }
  return out;
}

VecX WholeCurves::zero_on(const Sources& given, const PlacedSources& placed,
                          const PlacedSources& sided, const std::vector<char>& open,
                          Task task) const {
  if (on_heat_.mesh == domain_.mesh) {
    PlacedSources broken{{}, {}, {}, sided.nodes, sided.n_curves};
    for (const CurvePiece& piece : sided.pieces)
      if (const int c = component_of(piece.face); c >= 0 && open[c]) broken.pieces.push_back(piece);
    if (auto near = signed_heat_near(*domain_.mesh, *T_, broken, task.stage(0.3, "signed heat")))
      return std::move(*near);
  }
  Report quiet;  // mesh and sources have been spoken of
  const auto heat = heat_.get([&] {
    return unchecked_signed_heat(on_heat_, on_heat_.mesh == domain_.mesh ? T_ : nullptr, {}, hint_,
                                 task.stage(0.6, "factoring"), quiet);
  });
  return (*heat)(with_sides(given, placed), task.stage(0.4, "solving"), quiet);
}

void WholeCurves::complete_by_heat(const Sources& given, const PlacedSources& placed,
                                   const std::vector<char>& open, WholeSources& whole, Task task,
                                   Report& report) const {
  const SurfaceMesh& mesh = *domain_.mesh;
  PlacedSources sided = placed;
  sided.points.clear();
  sided.pieces = pieces_with_sides(placed);
  const VecX phi = zero_on(given, placed, sided, open, std::move(task));
  const PlacedSources completed = completed_curves(mesh, sided, phi);
  const VecX sign = CurveSides(mesh, *T_, placed, phi).at_vertices();
  for (int v = 0; v < mesh.n_vertices(); ++v)
    if (const int c = mesh.vertex_component()[v]; c >= 0 && open[c]) whole.sign[v] = sign[v];
  double added = 0;
  int curve = -1;
  for (std::size_t i = sided.pieces.size(); i < completed.pieces.size(); ++i) {
    CurvePiece piece = completed.pieces[i];
    const int c = component_of(piece.face);
    if (c < 0 || !open[c]) continue;
    added += piece.length;
    if (piece.curve != curve) {
      curve = piece.curve;
      whole.sources.nodes.push_back(completed.nodes[curve]);
      ++whole.sources.n_curves;
    }
    piece.curve = whole.sources.n_curves - 1;
    whole.sources.pieces.push_back(piece);
  }
  report.sizes.emplace_back("heat_completion_length", added);
  double length = 0;
  for (const CurvePiece& piece : placed.pieces)
    if (const int c = component_of(piece.face); piece.is_signed && c >= 0 && open[c])
      length += piece.length;
  if (added > length)
    report.warn("completion-guessed",
                "more of the zero set completes the curves (" + rounded_text(added) +
                    ") than they make up themselves (" + rounded_text(length) +
                    "): which side is which is a guess there; option confidence shows where");
}

}  // namespace littoral
