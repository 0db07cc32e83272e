#pragma once
// What verbs write, and how they end.

#include <functional>
#include <string>
#include <vector>

#include "api/surface/level_lines.h"
#include "cli/session.h"
#include "io/formats.h"
#include "io/render/scene.h"
#include "littoral/error.h"
#include "littoral/polygon_soup.h"
#include "littoral/tet_mesh.h"

namespace littoral::cli {

/// A result that cannot be written; known before anything is computed.
class OutputError : public IoError {
 public:
  using IoError::IoError;
};

/// Runs `check` of an output, before anything is computed: its IoErrors become OutputErrors.
template <class Check>
void check_before(const Check& check) {
  try {
    check();
  } catch (const IoError& e) {
    throw OutputError(e.what(), e.code());
  }
}

/// Throws UnsupportedError unless each file can be written as one of the kinds, OutputError where
/// its folder is not there or cannot be written to.
void check_outputs(const std::vector<std::string>& files, const io::Kinds& kinds);

/// Throws InputError where confidence beside a field at vertices could not be written to a file.
void check_holds_confidence(const std::string& file);

/// Adds -o for one file, which must be given.
void add_output_option(CLI::App& verb, std::string& file, const std::string& help);
/// Adds -o, which must be given and may be several times.
void add_output_option(CLI::App& verb, std::vector<std::string>& files, const std::string& help);

/// The title of a scene, from the name of the input.
std::string title_of(const std::string& input);

/// Gives a scene of a surface or volume whose view nobody chose the axis that is up in the input:
/// z for STL, whose objects stand on a plane of x and y.
void keep_upright(io::Scene& scene, const std::string& input);

/// Writes a field on a surface, or a page or picture of it that says how it was made; `add` draws
/// more.
void write_result(const std::string& file, const PolygonSoup& result, const std::string& field,
                  const std::string& input, const Report& report,
                  const std::function<void(io::Scene&)>& add = {});
/// The same for distance on tets: whole, its values alone, or its boundary, which is drawn cut open
/// where it is the source.
void write_tet_result(const std::string& file, const TetMesh& mesh, const VecX& values,
                      const std::string& input, const Report& report);

/// Writes the files one after the other and says what a verb says at its end.
void finish(const std::vector<std::string>& files, const Task& task, Session& session,
            const std::function<void(const std::string&)>& write);

/// Throws unless there is one file or one for each of the levels, all of one of the kinds.
void check_level_outputs(const std::vector<std::string>& out, std::size_t levels,
                         const io::Kinds& kinds);

/// Writes lines: all into one file, or each level into its own.
void write_lines(const std::vector<std::string>& out, const SurfaceMesh& mesh,
                 const std::vector<LevelLines>& levels);

}  // namespace littoral::cli
