#include "domain/intrinsic/lengthened_sides.h"

#include <memory>
#include <string>
#include <utility>

#include "base/counted.h"

namespace littoral {

namespace {

/// What the sides of a face lack [units].
double lacking(const IntrinsicTriangulation& T, int face, double margin) {
  const auto l = T.length.row(face);
  const double longest = l.maxCoeff() > 0 ? l.maxCoeff() : T.mean_edge_length;
  const double slack = l.sum() - 2 * l.maxCoeff();
  return slack < margin * longest ? margin * longest - slack : 0;
}

}  // namespace

int lengthen_sides(IntrinsicTriangulation& T, double margin) {
  int n = 0;
  for (int f = 0; f < T.n_faces(); ++f)
    if (const double by = lacking(T, f, margin); by > 0) {
      T.length.row(f).array() += by;
      ++n;
    }
  return n;
}

std::shared_ptr<const IntrinsicTriangulation> without_needles(
    std::shared_ptr<const IntrinsicTriangulation> T, Report& report) {
  constexpr double margin = 1e-6;
  int f = 0;
  while (f < T->n_faces() && !(lacking(*T, f, margin) > 0)) ++f;
  if (f == T->n_faces()) return T;
  auto thicker = std::make_shared<IntrinsicTriangulation>(*T);
  const int n = lengthen_sides(*thicker, margin);
  report.warn("degenerate-faces", counted(n, "thin face", "thin faces") +
                                      " had their sides lengthened by up to a millionth");
  return thicker;
}

}  // namespace littoral
