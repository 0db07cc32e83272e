#include "domain/intrinsic/lengthened_sides.h"

#include <string>

#include "base/counted.h"

namespace littoral {

int lengthen_sides(IntrinsicTriangulation& T, double margin) {
  int n = 0;
  for (int f = 0; f < T.n_faces(); ++f) {
    auto l = T.length.row(f).array();
    const double longest = l.maxCoeff() > 0 ? l.maxCoeff() : T.mean_edge_length;
    const double slack = l.sum() - 2 * l.maxCoeff();
    if (!(slack < margin * longest)) continue;
    l += margin * longest - slack;
    ++n;
  }
  return n;
}

IntrinsicTriangulation without_needles(IntrinsicTriangulation T, Report& report) {
  const int n = lengthen_sides(T, 1e-6);
  if (n > 0)
    report.warn("degenerate-faces", counted(n, "thin face", "thin faces") +
                                        " had their sides lengthened by up to a millionth");
  return T;
}

}  // namespace littoral
