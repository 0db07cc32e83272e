#pragma once
// Tet meshes in the verbs that take surfaces and volumes too.

#include <string>
#include <vector>

#include "api/surface/mesh_info.h"
#include "api/tet/tet_domain.h"
#include "cli/input/method_options.h"
#include "cli/session.h"
#include "io/tet/tets.h"

namespace littoral::cli {

/// The extensions that a field on tets is written to.
extern const std::vector<std::string> tet_outputs;

/// littoral distance on a tet mesh.
struct TetArguments {
  std::string domain;
  AnyMethod method;
  std::vector<std::string> sources, out;
  std::vector<long long> vertices;
  bool boundary = false;
};
void distance_through_tets(const TetArguments& arguments, Session& session);

/// The boundary of tets as a surface with the fields of the file.
PolygonSoup boundary_of(const io::TetFile& file);

/// What is left of it on the far side of a plane across an axis, seen along that, and the section
/// of the tets there. Throws InputError if the plane misses the tets.
PolygonSoup cut_open(const io::TetFile& file, int axis, double position);

/// Writes a field on tets: whole as .vtk and .vtu, its values as .csv .npy .txt, or the boundary.
void write_tet_field(const std::string& file, const TetMesh& mesh, const VecX& values,
                     const std::string& field, const Session& session);

/// Facts about a tet mesh.
std::vector<InfoEntry> tet_info(const io::TetFile& file);

/// Level sets of a field on tets, one file for all or one for each.
void contour_tets(const std::string& file, const std::string& field,
                  const std::vector<double>& levels, const std::vector<std::string>& out,
                  Session& session);

}  // namespace littoral::cli
