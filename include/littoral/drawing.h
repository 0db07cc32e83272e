#pragma once
// For programs that show surfaces and let people draw curves on them.

#include <string>
#include <string_view>
#include <vector>

#include "littoral/context.h"
#include "littoral/distance.h"
#include "littoral/mesh.h"
#include "littoral/methods.h"
#include "littoral/report.h"
#include "littoral/sources.h"
#include "littoral/space.h"

namespace littoral {

/// Triangles that show a surface.
struct Triangulation {
  MatX3i corners{0, 3};  // triangles x 3, by vertex
  VecXi polygons;        // triangles: the face that each was cut from
};

/// Polygons cut into triangles on their own corners; none for clouds.
Triangulation triangulation(const PolygonSoup& surface);

/// No format says which way is up: z where the points stand on z = 0 and not on y = 0, otherwise y.
bool z_is_up(const MatX3& points);

/// Nodes joined in their order by locally shortest paths: neighbours in the answer share a face.
/// Throws InputError for points that are not on the mesh and for neighbours in different
/// components, UnsupportedError unless faces are triangles, Cancelled.
std::vector<SurfacePoint> path_through(const Mesh& mesh, const std::vector<SurfacePoint>& nodes,
                                       const Context& context = {});

/// The lines of one level.
struct LevelCurves {
  double level = 0;          // [length]
  std::vector<MatX3> lines;  // nodes x 3, a closed line's first node repeated at the end
};

/// The curves at the given distances from the region on the negative side of (broken) curves
/// [length]. Throws InputError where none of them is met, and as `solve`.
std::vector<LevelCurves> offset_curves(const DistanceSolver& solver, const Sources& curves,
                                       const std::vector<double>& distances,
                                       const Morphology& morphology = {},
                                       const Context& context = {});

/// What the bytes of a source file hold; the extension of `name`, which messages begin with, says
/// how to read them. Throws InputError.
Sources parse_sources(std::string_view bytes, const std::string& name, const Mesh& mesh);

/// Sources as the text of a source file, ".txt" or ".json" by the extension of `name`; reading it
/// gives the same numbers. Throws UnsupportedError for other extensions and for what the format
/// does not hold: .txt curves in space, and chains of faces beside anything else; .json chains.
std::string sources_text(const Sources& sources, const std::string& name, const Mesh& mesh);

/// Facts about a surface as a JSON object, as `littoral info --json` prints them.
std::string info_json(const Mesh& mesh);
/// What is unusual about a surface and may matter to who measures on it, one sentence each.
std::vector<std::string> oddities(const Mesh& mesh);
/// One object with method, domain, status, options, sizes, timings [s], iterations, residuals,
/// warnings and unreachable_components. Stages named twice are added up; numbers that are not
/// finite become the texts "inf", "-inf", "nan"; bytes that are not UTF-8 are replaced.
std::string report_json(const Report& report);
/// All methods as a JSON list, as `littoral methods --json` prints them.
std::string methods_json(const std::vector<MethodFamily>& families);

/// The extensions of the files that are read: as curves and points on a mesh, as volumes.
std::string sources_extensions();
std::string volume_extensions();

}  // namespace littoral
