#pragma once
// What is in a file, and what is wrong with it.

#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "domain/mesh/surface_mesh.h"
#include "io/formats.h"
#include "littoral/polygon_soup.h"
#include "littoral/report.h"
#include "littoral/sources.h"

namespace littoral {

using InfoValue = std::variant<bool, double, std::string, std::vector<double>,
                               std::vector<std::pair<std::string, std::vector<double>>>>;

/// One fact: a key such as "boundary_edges" and a value.
struct InfoEntry {
  std::string key;
  InfoValue value;
};

/// Facts about a surface, also about one with numbers that are not finite: faces with such a vertex
/// are counted and left out of everything about connectivity and shape. Angles are in degrees,
/// lengths in the file's unit. Degenerate faces repeat a vertex or have an area of at most 1e-14 of
/// the squared diagonal of the bounding box. `orientable` disregards edges of three or more faces.
std::vector<InfoEntry> surface_info(const PolygonSoup& soup);

/// Facts about what a file holds: a surface as above; of a volume nodes, box, spacing and values;
/// of tets counts, volume, box and fields.
std::vector<InfoEntry> content_info(const io::Content& content);

/// Facts about sources on a mesh: curves, nodes, points, and the length of the curves once placed.
/// Throws what `prepare` throws.
std::vector<InfoEntry> sources_info(const SurfaceMesh& mesh, const Sources& sources,
                                    Report& report);

/// One "key: value" a line, with blanks for the keys' underscores.
std::string info_text(const std::vector<InfoEntry>& entries);

}  // namespace littoral
