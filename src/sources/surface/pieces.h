#pragma once
// Sources on a surface, cut into straight pieces that operators can integrate.

#include <array>
#include <vector>

#include "base/task.h"
#include "domain/mesh/surface_mesh.h"
#include "littoral/report.h"
#include "littoral/sources.h"

namespace littoral {

/// A straight part of a curve inside one face or along one edge, in the direction of travel.
struct CurvePiece {
  int curve = 0;                   // row of PlacedSources::nodes
  bool is_signed = true;           // has sides: phi > 0 on one, < 0 on the other
  bool left = true;                // phi > 0 to the left of travel as `face` lies, or to the right
  int face = 0;                    // contains the piece; along an edge, one of the edge's faces
  std::array<double, 3> a{}, b{};  // start and end: barycentrics in `face`, in its corner order
  int edge = -1;                   // the edge the piece runs along (third barycentric exactly 0)
  double length = 0;               // [length], positive
  double value = 0;                // of its curve [length]
};

/// Sources ready to be turned into right-hand sides and constraints.
struct PlacedSources {
  std::vector<CurvePiece> pieces;                // by curve, in the direction of travel
  std::vector<SurfacePoint> points;              // isolated points, in their simplest form
  std::vector<double> point_values;              // of the first points; those beyond have 0
  std::vector<std::vector<SurfacePoint>> nodes;  // per curve; consecutive nodes share a face
  int n_curves = 0;                              // = nodes.size()

  void add_point(const SurfacePoint& point, double value) {
    if (value != 0) {
      point_values.resize(points.size(), 0);
      point_values.push_back(value);
    }
    points.push_back(point);
  }
  double point_value(std::size_t i) const { return i < point_values.size() ? point_values[i] : 0; }
};

/// What tells left from right: faces, from which sides are carried along curves
/// (sources/curves/carry_sides.h), or normals that the surface has besides.
enum class SidesBy { faces, normals };

/// Traces gaps across the mesh, projects space curves onto it and cuts all curves into pieces.
///
/// Surface curves come first, in order, then space curves (one split between components counts as
/// several). Warnings with counts tell of traced gaps, zero-length steps left out and curves that
/// vanish. Throws UnsupportedError if the mesh has faces that are not triangles; InputError if an
/// index is out of range, a curve has fewer than two nodes or spans two components (naming curve
/// and element), or nothing remains.
PlacedSources place_sources(const SurfaceMesh& mesh, const Sources& sources, Report& report,
                            const Task& task = {}, SidesBy sides = SidesBy::faces);

}  // namespace littoral
