#pragma once
// What a page or a picture shows: a surface, a field on it, and what distance was measured from.

#include <array>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "domain/mesh/surface_mesh.h"
#include "littoral/polygon_soup.h"
#include "littoral/report.h"
#include "littoral/sources.h"
#include "littoral/types.h"
#include "littoral/volume.h"

namespace littoral::io {

/// A source polyline in space.
struct SceneCurve {
  MatX3 points{0, 3};  // nodes x 3, in the direction of travel
  bool is_signed = true;
};

/// A volume on show, see volume_scene.h.
struct SceneVolume {
  Volume thin;               // what pages move through
  double low = 0, high = 0;  // least and greatest finite value
  bool infinite = false;     // are there infinite values?
  int axis = 2;              // of the slice
  int slice = 0;             // number of the layer of nodes
  double position = 0.5;     // of the slice, 0..1 along the box
  double level = 0;          // of the isosurface
  bool isosurface = true;
};

/// A point cloud as pages trace it.
struct TracedCloud {
  std::string operation;  // unite, intersect or subtract
  /// Point, spacing; touching point, log of weight; normal, curvature k1; direction e1, curvature
  /// k2 (methods/tori/torus.h).
  Eigen::Matrix<double, Eigen::Dynamic, 16, Eigen::RowMajor> tori;
  VecX samples;  // its distance on the scene's volume, as thinned for pages [length]; without, it
                 // is the volume's
};

/// A surface that is asked ray by ray instead of being made of triangles.
struct SceneTrace {
  /// Where a ray origin + t direction (unit) first meets it in [from, to], to a small part of a
  /// pixel [length], and the unit normal there, either side; infinity if nowhere. Asked from
  /// several threads.
  std::function<double(const Vec3& origin, const Vec3& direction, double from, double to,
                       double pixel, Vec3& normal)>
      hit;
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();  // nothing is outside of this box
  double level = 0;                              // the field's value on the surface
  MatX3i triangles{0, 3};  // of the scene's points: the surface on the grid, for how open it is
  double steepness = 1;    // of the field at most
  /// What pages trace; without clouds they show the isosurface.
  std::vector<TracedCloud> clouds;
  double blend = 0, offset = 0;  // of the clouds together [length] (methods/implicit/combined.h)
};

/// How a surface is lit: with the normals of its vertices, of its faces, or as smooth and darker
/// where less of the sky is seen (openness.h).
enum class Shading { smooth, flat, occluded };

/// The colours of values; automatic: sequential, or diverging where values are negative somewhere.
enum class ColourMap { automatic, sequential, diverging, grey, heat, viridis, cividis };

/// A further field of a scene's surface, for pages to choose.
struct SceneField {
  std::string name;
  VecX values;  // as those of the scene
};

/// What numbers of vertices and faces name: places of the input, its vertices alone, or nothing.
enum class SceneNodes { none, vertices, faces };

/// Everything on show. All texts are plain UTF-8; pages escape them.
struct Scene {
  MatX3 points{0, 3};      // vertices x 3; those of triangles must be finite
  MatX3i triangles{0, 3};  // triangles x 3
  std::vector<unsigned char>
      inner_sides;         // triangles: bit k set if side k is inside a polygon; or empty
  std::vector<int> faces;  // triangles: the face each is a part of; or empty: as numbered
  SceneNodes nodes = SceneNodes::none;
  VecX values;   // vertices, may be infinite, never NaN; or empty: no field
  VecX weights;  // vertices, 0..1: values are interpolated as sum b w v / sum b w; or empty: all 1
  std::string field_name = "distance";
  std::vector<SceneField> more;                    // further fields
  Eigen::Matrix<double, Eigen::Dynamic, 4> discs;  // vertices: normal and radius of the disc that
                                                   // stands for it (show_as_discs); or empty
  Shading shading = Shading::smooth;
  std::vector<SceneCurve> curves;
  MatX3 source_points{0, 3};   // isolated source points x 3
  std::vector<double> levels;  // isolines at these values; empty: evenly spaced ones
  int isolines = 20;           // about how many evenly spaced ones; 0: none
  ColourMap colour_map = ColourMap::automatic;
  std::optional<std::array<double, 2>> colour_range{};  // values at its ends; or what there is
  std::optional<Vec3> towards_eye{}, up{};    // of the first view; or what suits the shape
  std::shared_ptr<const SceneVolume> volume;  // the triangles are then a slice and a surface
  std::shared_ptr<const SceneTrace> trace;    // beside the triangles
  std::string title;
  std::vector<std::pair<std::string, std::string>> facts, options;  // shown as tables
  std::vector<std::string> warnings;                                // shown before them
  std::shared_ptr<const Scene> beside;  // pages show it beside this one, with the same camera
};

/// A scene of a surface: polygons cut into fans, the soup's scalar `field` as values where it has
/// one, its scalar "weight" as weights, other scalars without NaN as further fields.
Scene make_scene(const PolygonSoup& soup, const std::string& field = "distance");

/// Adds the sources of a problem on `mesh`; nodes of one curve are joined by straight segments.
/// Where the scene shows the vertices of the mesh, its nodes are from then on those of the mesh.
void add_sources(Scene& scene, const SurfaceMesh& mesh, const Sources& sources);

/// The title, facts about the run that made the scene before and after those it has, its options
/// and its warnings.
void describe(Scene& scene, const std::string& title, const Report& report);

/// Throws InputError naming the element if the scene has no triangle, a triangle refers to a vertex
/// that is missing or not finite, there is not one value per vertex in each field, a value is NaN,
/// or a source, level or isoline count is not finite or negative; or for the scene beside it.
void check_scene(const Scene& scene);

/// Writes one HTML file that shows the scene in a browser, from disk and offline. Throws what
/// check_scene throws, IoError if the file cannot be written, and UnsupportedError if the library
/// was built without the viewer (LITTORAL_VIEWER=OFF or no npm).
void write_page(const std::filesystem::path& path, const Scene& scene);

/// True if write_page works in this build.
bool has_viewer();

}  // namespace littoral::io
