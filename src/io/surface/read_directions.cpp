#include "io/surface/read_directions.h"

#include <cmath>
#include <string>

#include "base/index.h"
#include "io/read.h"
#include "io/text_scan.h"
#include "littoral/error.h"

namespace littoral::io {

FaceDirections read_directions(const std::filesystem::path& path, int n_faces) {
  const FileBytes file(path);
  const std::string_view bytes = file.view();
  const std::string name = path.string();
  LineScanner scan(without_byte_order_mark(bytes, name), name, '#');
  FaceDirections out;
  std::vector<Vec3> rows;
  while (scan.next()) {
    std::vector<std::string_view> words;
    for (std::string_view word = scan.word(); !word.empty(); word = scan.word())
      words.push_back(word);
    const bool sparse = words[0] == "f";
    if (words.size() != (sparse ? 5U : 3U)) scan.fail("expected 'x y z' or 'f I x y z'");
    Vec3 v;
    for (int i = 0; i < 3; ++i) {
      const std::string_view text = words[words.size() - 3 + std::size_t(i)];
      const auto number = parse_double(text);
      if (!number || !std::isfinite(*number))
        scan.fail(in_quotes(text) + " is not a finite number" + decimal_comma_hint(text));
      v[i] = *number;
    }
    if (!sparse) {
      if (static_cast<int>(rows.size()) == n_faces)
        scan.fail("more directions than the mesh has faces, " + std::to_string(n_faces));
      rows.push_back(v);
      continue;
    }
    const auto f = parse_integer(words[1]);
    if (!f || *f < 0 || *f >= n_faces)
      scan.fail("there is no face " + in_quotes(words[1]) + "; the mesh has " +
                std::to_string(n_faces) + ", counted from 0");
    if (!(v.cwiseAbs().maxCoeff() > 0)) scan.fail("a direction of length 0");
    out.sparse.emplace_back(static_cast<int>(*f), v / v.cwiseAbs().maxCoeff());
  }
  if (!rows.empty() && !out.sparse.empty())
    throw InputError(name + ": lines 'x y z' and 'f I x y z' are mixed; write one kind",
                     "bad-file");
  if (rows.empty() && out.sparse.empty())
    throw InputError(name + ": holds no direction", "bad-file");
  if (!rows.empty() && static_cast<int>(rows.size()) != n_faces)
    throw InputError(name + ": " + std::to_string(rows.size()) + " directions for " +
                         std::to_string(n_faces) + " faces",
                     "bad-file");
  out.all.resize(index(rows.size()), 3);
  for (std::size_t i = 0; i < rows.size(); ++i) out.all.row(index(i)) = rows[i];
  return out;
}

}  // namespace littoral::io
