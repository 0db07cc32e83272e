#pragma once
// What the verbs about distance in space share: the input, the method, the grid.

#include <string>
#include <vector>

#include "api/space/csg.h"
#include "cli/input/lengths.h"
#include "cli/input/method_options.h"
#include "cli/session.h"
#include "littoral/error.h"

namespace littoral::cli {

/// What `call` returns; its InputErrors begin with the name of the file.
template <class Call>
auto naming(const std::string& file, const Call& call) {
  try {
    return call();
  } catch (const InputError& e) {
    throw InputError(file + ": " + e.what(), e.code());
  }
}

/// As given.
struct SpaceArguments {
  std::string input, field;  // field: of a volume
  MethodArguments method;
  bool estimate_normals = false;
  int resolution = 0;  // 0: not given
  std::string spacing;
  std::string bounds;
  double padding = GridOptions().padding;
  std::vector<std::string> unite, intersect, subtract;
  std::string operand_method;
  std::string blend, offset;
  std::string values;
  bool redistance = false;
  std::string meaning = "auto", threshold;  // of volumes
};

/// Adds INPUT, --estimate-normals and --flip.
void add_space_input(CLI::App& verb, SpaceArguments& texts, Session& session,
                     const io::Kinds& kinds = {io::Kind::surface, io::Kind::cloud,
                                               io::Kind::volume});
/// Adds --method and the options of the methods that run on a domain, "set of points" where a verb
/// asks anywhere.
void add_space_method(CLI::App& verb, SpaceArguments& texts, const std::string& domain = "grid");
/// Adds what makes one shape of several, and --redistance. The verb `offset` has offsets of its
/// own.
void add_shape_options(CLI::App& verb, SpaceArguments& texts, bool with_offset = true);
/// Adds --values, what distance is counted from.
void add_values_option(CLI::App& verb, SpaceArguments& texts);
/// Adds --confidence.
void add_confidence_option(CLI::App& verb, bool& confidence);
/// How sure inside and outside are at points (n x 3), 0 to 1. Throws InputError unless there is one
/// input.
VecX confidence_at(const CsgShapes& shapes, const MatX3& points, Session& session);
/// Adds --resolution, --spacing, --bounds and --padding.
void add_grid_options(CLI::App& verb, SpaceArguments& texts, const GridOptions& defaults = {});

/// The request that was given, checked.
SpaceRequest space_request(const SpaceArguments& texts, const Session& session);
/// The grid that was asked for.
GridOptions grid_request(const SpaceArguments& texts, const InputSize& size);
/// Reads INPUT and what it is combined with, checks the options.
CsgShapes read_shapes(SpaceArguments& texts, Session& session);
/// A warning for a file whose format has no place for a volume's box.
void warn_without_box(const std::string& file, Session& session);

/// Adds --smoothing of winding numbers in space; `when` says what it goes with.
void add_smoothing_option(CLI::App& verb, std::string& smoothing, const std::string& when);

}  // namespace littoral::cli
