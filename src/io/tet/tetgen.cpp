#include "io/tet/tetgen.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <map>
#include <set>
#include <system_error>
#include <vector>

#include "base/option_table.h"
#include "base/platform/child_process.h"
#include "base/platform/temporary_folder.h"
#include "io/read.h"
#include "io/tet/tets.h"
#include "io/write.h"
#include "littoral/error.h"

namespace littoral::io {

namespace {

constexpr const char* remedy = "; option tets lattice takes any surface";

struct Facets {
  std::vector<Vec3> points;
  std::vector<double> sizes;  // of tets at the points
  std::vector<std::vector<int>> faces;
};

/// Surface and box; vertices at one place become one, faces that collapse are left out.
Facets facets_of(const PolygonSoup& surface, const TetgenRequest& request) {
  Facets facets;
  std::map<std::array<double, 3>, int> place;
  std::set<std::array<int, 3>> seen;
  const auto vertex = [&](const Vec3& p, double size) {
    const auto [at, is_new] =
        place.try_emplace({p[0], p[1], p[2]}, static_cast<int>(facets.points.size()));
    if (is_new) {
      facets.points.push_back(p);
      facets.sizes.push_back(size);
    }
    return at->second;
  };
  for (int f = 0; f < surface.n_faces(); ++f) {
    std::vector<int> face;
    for (const int v : surface.face(f)) face.push_back(vertex(surface.points.row(v), request.fine));
    if (face[0] == face[1] || face[1] == face[2] || face[2] == face[0]) continue;
    std::array<int, 3> key{face[0], face[1], face[2]};
    std::sort(key.begin(), key.end());
    if (seen.insert(key).second) facets.faces.push_back(face);
  }
  std::array<int, 8> corner{};
  for (int w = 0; w < 8; ++w) {
    Vec3 p = request.low;
    for (int a = 0; a < 3; ++a)
      if ((w >> a & 1) != 0) p[a] = request.high[a];
    corner[w] = vertex(p, request.coarse);
  }
  constexpr std::size_t sides[6][4] = {{0, 2, 6, 4}, {1, 5, 7, 3}, {0, 4, 5, 1},
                                       {2, 3, 7, 6}, {0, 1, 3, 2}, {4, 6, 7, 5}};
  for (const auto& side : sides)
    facets.faces.push_back({corner[side[0]], corner[side[1]], corner[side[2]], corner[side[3]]});
  return facets;
}

/// in.poly and in.mtr, TetGen's piecewise linear complex and sizes.
void write_input(const std::filesystem::path& folder, const Facets& facets, const Task& task) {
  write_atomically(folder / "in.poly", [&](std::ostream& out) {
    out << facets.points.size() << " 3 0 0\n";
    for (std::size_t v = 0; v < facets.points.size(); ++v) {
      if (v % 4096 == 0) task.checkpoint();
      out << v;
      for (const double x : facets.points[v]) out << " " << number_text(x);
      out << "\n";
    }
    out << facets.faces.size() << " 0\n";
    for (const auto& face : facets.faces) {
      out << "1\n" << face.size();
      for (const int v : face) out << " " << v;
      out << "\n";
    }
    out << "0\n0\n";
  });
  write_atomically(folder / "in.mtr", [&](std::ostream& out) {
    out << facets.sizes.size() << " 1\n";
    for (const double size : facets.sizes) out << number_text(size) << "\n";
  });
}

[[noreturn]] void fail(const ChildEnd& end, const TetgenRequest& request) {
  const std::string name = "the program " + request.program;
  const std::string said = end.said.empty() ? "" : " (" + end.said + ")";
  if (end.timed_out)
    throw SolveError(name + " did not end within " + number_text(request.timeout) +
                         " s and was stopped; option tetgen-timeout allows it more" + remedy,
                     "tetgen-failed");
  if (end.signal != 0)
    throw SolveError(name + " was ended by signal " + std::to_string(end.signal) + ", " +
                         ::strsignal(end.signal) + said + remedy,
                     "tetgen-failed");
  if (end.status != 0)
    throw SolveError(name + " failed with status " + std::to_string(end.status) + said + remedy,
                     "tetgen-failed");
  throw SolveError(name + " wrote no tets" + said + remedy, "tetgen-failed");
}

}  // namespace

TetMesh run_tetgen(const PolygonSoup& surface, const TetgenRequest& request, const Task& task) {
  const auto program = find_program(request.program);
  if (!program)
    throw UnsupportedError("the program " + request.program +
                               " was not found; Debian's package tetgen has it" + remedy,
                           "tetgen-failed");
  std::string answer;
  {
    const TemporaryFolder folder("littoral-tetgen");
    write_input(folder.path(), facets_of(surface, request), task);
    // p: a complex; q: quality; m: sizes; g: answer as in.1.mesh, too. (Without the other files, by
    // N, E and F, version 1.5.0 writes fewer triangles there than it promises.)
    const ChildEnd end =
        run_child(*program, {"-pqmgQ", "in.poly"}, folder.path(), request.timeout, task);
    const std::filesystem::path file = folder.path() / "in.1.mesh";
    std::error_code error;
    if (end.timed_out || end.signal != 0 || end.status != 0 ||
        !std::filesystem::exists(file, error))
      fail(end, request);
    answer = read_bytes(file);
  }
  task.checkpoint();
  try {
    return read_tets_bytes(answer, ".mesh", "in.1.mesh").mesh;
  } catch (const InputError& e) {
    throw SolveError(
        "the answer of the program " + request.program + " is not a tet mesh: " + e.what() + remedy,
        "tetgen-failed");
  }
}

}  // namespace littoral::io
