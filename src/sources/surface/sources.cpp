#include "littoral/sources.h"

#include <algorithm>

namespace littoral {

Sources& Sources::add(const Sources& other) {
  const auto append = [](auto& to, const auto& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  append(curves, other.curves);
  for (std::size_t i = 0; i < other.points.size(); ++i) add(other.points[i], other.point_value(i));
  append(space_curves, other.space_curves);
  append(chains, other.chains);
  return *this;
}

Sources Sources::reversed() const {
  Sources out = *this;
  for (Curve& curve : out.curves)
    if (curve.is_signed) std::reverse(curve.nodes.begin(), curve.nodes.end());
  for (SpaceCurve& curve : out.space_curves)
    if (curve.is_signed) curve.points = curve.points.colwise().reverse().eval();
  for (FaceChain& chain : out.chains) std::reverse(chain.faces.begin(), chain.faces.end());
  return out;
}

}  // namespace littoral
