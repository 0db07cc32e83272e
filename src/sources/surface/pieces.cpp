#include "sources/surface/pieces.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "base/counted.h"
#include "littoral/error.h"
#include "sources/curves/carry_sides.h"
#include "sources/curves/project_curves.h"
#include "sources/curves/trace.h"

namespace littoral {

namespace {

constexpr double leap = 5;  // times the usual distance between nodes

/// Similar warnings about many curves: the first few in full, then a count.
class Notes {
 public:
  explicit Notes(std::string code) : code_(std::move(code)) {}
  void add(const std::string& text) {
    if (++count_ <= shown) texts_.push_back(text);
  }
  void report_to(Report& report) const {
    for (const std::string& text : texts_) report.warn(code_, text);
    if (count_ > shown)
      report.warn(code_,
                  "the same holds for " + counted(count_ - shown, "more source", "more sources"));
  }

 private:
  static constexpr int shown = 8;
  std::string code_;
  int count_ = 0;
  std::vector<std::string> texts_;
};

class Preparation {
 public:
  explicit Preparation(const SurfaceMesh& mesh) : mesh_(mesh), tracer_(mesh) {}

  /// Appends one curve; `label` names it in messages.
  void add_curve(const std::vector<SurfacePoint>& nodes, bool is_signed, double value,
                 const std::string& label, const Task& task) {
    check_value(value, label);
    const int curve = out_.n_curves++;
    std::vector<SurfacePoint> placed;
    int empty_steps = 0;
    std::vector<double> lengths, traced;  // of segments; of those that leave their faces
    const std::size_t pieces_before = out_.pieces.size();
    lost_ = 0;
    try {
      placed.push_back(simplest(mesh_, nodes.front()));
      for (std::size_t i = 1; i < nodes.size(); ++i) {
        task.checkpoint();
        const SurfacePoint next = simplest(mesh_, nodes[i]);
        std::vector<SurfacePoint> way{placed.back(), next};
        const double length = (mesh_.position(next) - mesh_.position(placed.back())).stableNorm();
        if (length > 0) lengths.push_back(length);
        if (!share_face(mesh_, placed.back(), next)) {
          way = tracer_.trace(placed.back(), next, task);
          traced.push_back(length);
        }
        for (std::size_t k = 1; k < way.size(); ++k) {
          if (!add_piece(curve, is_signed, way[k - 1], way[k])) ++empty_steps;
          placed.push_back(way[k]);
        }
      }
    } catch (const InputError& error) {
      throw InputError(label + ": " + error.what(), error.code());
    }
    out_.nodes.push_back(std::move(placed));
    n_traced_ += static_cast<int>(traced.size());
    warn_of_leaps(lengths, traced, label);
    if (lost_ > 0)
      dropped_.add(counted(lost_, "piece of ", "pieces of ") + label +
                   " in faces that repeat a vertex" + (lost_ == 1 ? " was" : " were") +
                   " left out");
    for (std::size_t i = pieces_before; i < out_.pieces.size(); ++i) out_.pieces[i].value = value;
    if (empty_steps > 0)
      dropped_.add(counted(empty_steps, "zero-length step of ", "zero-length steps of ") + label +
                   (empty_steps == 1 ? " was" : " were") + " left out");
    if (out_.pieces.size() == pieces_before)
      vanished_.add(label + " has no length on the mesh and was left out");
  }

  void add_point(const SurfacePoint& point, double value, std::size_t number) {
    check_value(value, "point source " + std::to_string(number));
    try {
      out_.add_point(simplest(mesh_, point), value);
      const std::vector<int> faces = faces_at(mesh_, out_.points.back());
      if (std::none_of(faces.begin(), faces.end(),
                       [&](int f) { return mesh_.has_distinct_corners(f); }))
        dropped_.add("point source " + std::to_string(number) + " lies on " + element_name(point) +
                     ", whose faces all repeat a vertex: no distance is measured from it");
    } catch (const InputError& error) {
      throw InputError("point source " + std::to_string(number) + ": " + error.what(),
                       error.code());
    }
  }

  PlacedSources finish(Report& report) {
    if (n_traced_ > 0) report.sizes.emplace_back("traced segments", n_traced_);
    traced_.report_to(report);
    dropped_.report_to(report);
    vanished_.report_to(report);
    if (out_.pieces.empty() && out_.points.empty())
      throw InputError(
          "the sources hold nothing to measure distance from: no point and no curve of positive "
          "length",
          "nothing-given");
    return std::move(out_);
  }

 private:
  static void check_value(double value, const std::string& label) {
    if (!std::isfinite(value))
      throw InputError(label + " has a value that is not finite", "not-finite");
  }
  /// Nodes that share no face are as good as others. But where they are much farther apart than the
  /// curve's nodes are elsewhere, some may be missing.
  void warn_of_leaps(std::vector<double> lengths, const std::vector<double>& traced,
                     const std::string& label) {
    if (lengths.size() < 3) return;
    const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
    std::nth_element(lengths.begin(), middle, lengths.end());
    const auto leaps = static_cast<int>(std::count_if(
        traced.begin(), traced.end(), [&](double length) { return length > leap * *middle; }));
    if (leaps > 0)
      traced_.add(counted(leaps, "segment of ", "segments of ") + label +
                  (leaps == 1 ? " joins" : " join") +
                  " nodes that share no face and are far apart, by a path traced over the mesh; "
                  "to leave a gap there, end the curve and begin another");
  }

  /// Appends the piece between two points that share a face; false if it has no length.
  bool add_piece(int curve, bool is_signed, const SurfacePoint& from, const SurfacePoint& to) {
    CurvePiece piece;
    piece.curve = curve;
    piece.is_signed = is_signed;
    piece.length = (mesh_.position(to) - mesh_.position(from)).stableNorm();
    if (!(piece.length > 0)) return false;
    piece.edge = common_edge(mesh_, from, to);
    piece.face = piece.edge >= 0 ? face_beside(piece.edge) : common_face(mesh_, from, to);
    if (!mesh_.has_distinct_corners(piece.face)) {  // counts as no surface
      ++lost_;
      return true;
    }
    piece.a = barycentrics_in(mesh_, from, piece.face).value();
    piece.b = barycentrics_in(mesh_, to, piece.face).value();
    out_.pieces.push_back(piece);
    return true;
  }

  int face_beside(int edge) const {
    for (int f : mesh_.edge_faces(edge))
      if (mesh_.has_distinct_corners(f)) return f;
    return mesh_.edge_faces(edge)[0];
  }

  const SurfaceMesh& mesh_;
  Tracer tracer_;
  PlacedSources out_;
  int lost_ = 0;  // pieces of the curve that faces with repeated vertices hold
  int n_traced_ = 0;
  Notes traced_{"curve-leaps"}, dropped_{"pieces-left-out"}, vanished_{"pieces-left-out"};
};

std::string curve_label(std::size_t index, const std::string& origin) {
  std::string label = "curve " + std::to_string(index + 1);
  if (!origin.empty()) label += " (" + origin + ")";
  return label;
}

}  // namespace

PlacedSources place_sources(const SurfaceMesh& mesh, const Sources& sources, Report& report,
                            const Task& task, SidesBy sides) {
  if (!sources.chains.empty())
    throw UnsupportedError(
        (sources.chains[0].origin.empty() ? "" : sources.chains[0].origin + ": ") +
        "chains of faces say where winding numbers jump; distance is measured "
        "from curves and points");
  Preparation preparation(mesh);
  auto check_count = [](Eigen::Index nodes, const std::string& label) {
    if (nodes < 2)
      throw InputError(label + " has " + (nodes == 1 ? "one node" : "no nodes") +
                       "; a curve needs at least two");
  };
  std::size_t index = 0;
  for (const Curve& curve : sources.curves) {
    const std::string label = curve_label(index++, curve.origin);
    check_count(curve.nodes.size(), label);
    preparation.add_curve(curve.nodes, curve.is_signed, curve.value, label, task);
  }
  std::optional<CurveProjector> projector;
  for (const SpaceCurve& curve : sources.space_curves) {
    const std::string label = curve_label(index++, curve.origin);
    check_count(curve.points.rows(), label);
    if (!projector) projector.emplace(mesh);
    const ProjectedCurve projected = projector->project(curve, report, task);
    for (const Curve& part : projected.curves)
      preparation.add_curve(part.nodes, part.is_signed, curve.value, label, task);
  }
  for (std::size_t i = 0; i < sources.points.size(); ++i)
    preparation.add_point(sources.points[i], sources.point_value(i), i + 1);
  PlacedSources placed = preparation.finish(report);
  if (sides == SidesBy::faces) carry_sides(mesh, placed, report);
  return placed;
}

}  // namespace littoral
