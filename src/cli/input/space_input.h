#pragma once
// What the verbs about distance in space share: the input, the method, the grid.

#include <filesystem>
#include <string>
#include <vector>

#include "api/space/csg.h"
#include "cli/input/method_options.h"
#include "cli/session.h"

namespace littoral::cli {

/// As given.
struct SpaceArguments {
  std::string input;
  MethodArguments method;
  bool estimate_normals = false;
  int resolution = 0;  // 0: not given
  double spacing = 0;  // 0: not given
  std::string bounds;
  double padding = GridOptions().padding;
  std::vector<std::string> unite, intersect, subtract;
  std::string operand_method;
  double blend = 0, offset = 0;
  bool redistance = false;
  double at_level = 0;  // of a volume that is redistanced
};

/// Adds INPUT, --estimate-normals and --flip.
void add_space_input(CLI::App& verb, SpaceArguments& texts, Session& session);
/// Adds --method and the methods' options; `fallback` says what is used without.
void add_space_method(CLI::App& verb, SpaceArguments& texts, const std::string& fallback);
/// Adds what makes one shape of several, and --redistance. The verb `offset` has offsets of its
/// own.
void add_shape_options(CLI::App& verb, SpaceArguments& texts, bool with_offset = true);
/// Adds --resolution, --spacing, --bounds and --padding.
void add_grid_options(CLI::App& verb, SpaceArguments& texts);

/// The request that was given, checked; `fallback` is the method where none is named.
SpaceRequest space_request(const SpaceArguments& texts, const AnyMethod& fallback,
                           const Session& session);
/// The grid that was asked for.
GridOptions grid_request(const SpaceArguments& texts);
/// Reads INPUT and what it is combined with, chooses methods where none is named (`plain` for one
/// mesh, soup or cloud, otherwise method_for_points), checks the options.
CsgShapes read_shapes(SpaceArguments& texts, const Session& session, const AnyMethod& plain);

/// Adds --points and -o, for verbs that answer at points.
void add_query_files(CLI::App& verb, std::string& points, std::vector<std::string>& out);
/// Points of any surface or cloud file, or the first three columns of a .csv or .txt file.
MatX3 read_queries(const std::string& file);

/// Columns of numbers under names, one row a point.
struct Table {
  std::vector<std::string> names;
  Eigen::MatrixXd columns;
};
/// Writes .csv with a head, .txt, .npy (rows x columns), or .ply with the points.
void write_query_table(const std::vector<std::string>& out, const MatX3& points,
                       const Table& table);

}  // namespace littoral::cli
