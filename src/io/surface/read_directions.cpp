#include "io/surface/read_directions.h"

#include <cmath>
#include <fstream>
#include <sstream>
#include <string>

#include "base/index.h"
#include "littoral/error.h"

namespace littoral::io {

FaceDirections read_directions(const std::filesystem::path& path, int n_faces) {
  std::ifstream file(path);
  if (!file) throw IoError("cannot open " + path.string(), "cannot-read");
  FaceDirections out;
  std::vector<Vec3> rows;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    const auto fail = [&](const std::string& what) {
      throw InputError(path.string() + ":" + std::to_string(number) + ": " + what, "bad-file");
    };
    std::istringstream words(line.substr(0, line.find('#')));
    std::vector<std::string> word;
    for (std::string w; words >> w;) word.push_back(w);
    if (word.empty()) continue;
    const bool sparse = word[0] == "f";
    if (word.size() != (sparse ? 5U : 3U)) fail("expected 'x y z' or 'f I x y z'");
    Vec3 v;
    for (int i = 0; i < 3; ++i) {
      const std::string& text = word[word.size() - 3 + std::size_t(i)];
      char* end = nullptr;
      v[i] = std::strtod(text.c_str(), &end);
      if (end != text.c_str() + text.size() || !std::isfinite(v[i]))
        fail("'" + text + "' is not a finite number");
    }
    if (!sparse) {
      if (static_cast<int>(rows.size()) == n_faces)
        fail("more directions than the mesh has faces, " + std::to_string(n_faces));
      rows.push_back(v);
      continue;
    }
    char* end = nullptr;
    const long long f = std::strtoll(word[1].c_str(), &end, 10);
    if (end != word[1].c_str() + word[1].size() || f < 0 || f >= n_faces)
      fail("there is no face " + word[1] + "; the mesh has " + std::to_string(n_faces) +
           ", counted from 0");
    if (!(v.cwiseAbs().maxCoeff() > 0)) fail("a direction of length 0");
    out.sparse.emplace_back(static_cast<int>(f), v / v.cwiseAbs().maxCoeff());
  }
  if (!rows.empty() && !out.sparse.empty())
    throw InputError(path.string() + ": lines 'x y z' and 'f I x y z' are mixed; write one kind",
                     "bad-file");
  if (rows.empty() && out.sparse.empty())
    throw InputError(path.string() + ": holds no direction", "bad-file");
  if (!rows.empty() && static_cast<int>(rows.size()) != n_faces)
    throw InputError(path.string() + ": " + std::to_string(rows.size()) + " directions for " +
                         std::to_string(n_faces) + " faces",
                     "bad-file");
  out.all.resize(index(rows.size()), 3);
  for (std::size_t i = 0; i < rows.size(); ++i) out.all.row(index(i)) = rows[i];
  return out;
}

}  // namespace littoral::io
