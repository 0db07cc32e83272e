#pragma once
// Broken signed curves on triangle meshes, made whole so that they have sides.

#include <functional>
#include <memory>

#include "api/surface/discretization.h"
#include "base/lazy.h"
#include "littoral/options.h"
#include "methods/winding/shortest_completion.h"

namespace littoral {

/// Sources, made whole, and which side of them each vertex is on.
struct WholeSources {
  PlacedSources sources;  // as given, then what completes them as unsigned curves
  VecX sign;              // vertices, +1 or -1; +1 on components without signed curves
  Completion by = Completion::none;
};

/// Completes curves on one mesh, each component by itself; for several threads.
class WholeCurves {
 public:
  /// heat: what signed heat is solved on, with the same vertices: the triangles themselves, or the
  /// cloud they are made from.
  WholeCurves(SurfaceDomain triangles, std::shared_ptr<const IntrinsicTriangulation> T,
              SurfaceDomain heat, SolveHint hint);

  /// Curves that bound stay as they are and integer winding numbers give their sides. Where pieces
  /// are reversed but nothing is missing, the shortest completion overrules them. Curves with ends
  /// are completed by the zero set of the signed heat method, solved near them where that settles
  /// it.
  /// Reports lengths: given, of completions, and of the curve that these overrule. Throws
  /// InputError if Completion::none is asked for and the curves do not bound.
  WholeSources complete(const Sources& given, const PlacedSources& placed, Completion how,
                        Task task, Report& report) const;

 private:
  struct Labelled;
  Labelled labelled(const std::vector<CurvePiece>& pieces, Complete which, const Task& task) const;
  /// Do curves have ends wherever they are, so that no integer winding numbers settle their sides?
  bool all_have_ends(const PlacedSources& placed, Completion how, Report& report) const;
  std::vector<char> settle(const PlacedSources& placed, Completion how, WholeSources& whole,
                           Task task, Report& report) const;
  bool straighten_completion(const Labelled& zigzag, const std::vector<char>& settled,
                             WholeSources& whole, const Task& task) const;
  void add_sides(const Labelled& on, const std::vector<char>& settled, WholeSources& whole) const;
  /// The signed curves alone, without values: others would draw the zero set to themselves.
  Sources with_sides(const Sources& given, const PlacedSources& placed) const;
  /// A function whose zero set completes the signed curves of open components; +inf or anything on
  /// the others.
  VecX zero_on(const Sources& given, const PlacedSources& placed, const PlacedSources& sided,
               const std::vector<char>& open, Task task) const;
  void complete_by_heat(const Sources& given, const PlacedSources& placed,
                        const std::vector<char>& open, WholeSources& whole, Task task,
                        Report& report) const;
  int component_of(int face) const;

  SurfaceDomain domain_;
  std::shared_ptr<const IntrinsicTriangulation> T_;
  SurfaceDomain on_heat_;
  SolveHint hint_;
  bool has_regions_ = true;  // sides of triangles are those of the input
  Kept<JumpSurface> uncut_;
  Kept<std::function<VecX(const Sources&, Task, Report&)>> heat_;
};

}  // namespace littoral
