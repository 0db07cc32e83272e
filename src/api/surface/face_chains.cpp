#include "api/surface/face_chains.h"

#include <algorithm>
#include <iterator>
#include <string>

#include "base/counted.h"
#include "littoral/error.h"

namespace littoral {

namespace {

/// The function rises by one from triangle f to triangle g.
bool add_step(int f, int g, const JumpCalculus& J, DualCurve& curve) {
  for (int k = 0; k < 3; ++k) {
    const int e = J.edge(f, k);
    if (J.manifold[e]) {
      if (J.across(f, k).face != g || f == g) continue;
      curve.edge[e] += J.sides[e][0].face == g ? 1 : -1;
      return true;
    }
    for (FacePair& p : curve.pairs)
      if (p.edge == e && std::minmax(p.left, p.right) == std::minmax(f, g)) {
        p.jump += p.left == g ? 1 : -1;
        return true;
      }
  }
  return false;
}

}  // namespace

void add_chains(const std::vector<FaceChain>& chains, const JumpCalculus& J,
                const FaceTriangles& triangle_of_face, DualCurve& curve) {
  for (std::size_t c = 0; c < chains.size(); ++c) {
    const FaceChain& chain = chains[c];
    const auto label = [&] {
      return chain.origin.empty() ? "chain " + std::to_string(c + 1) : chain.origin;
    };
    if (chain.faces.size() < 2)
      throw InputError(label() + " has " + counted(chain.faces.size(), "face", "faces") +
                       ", at least 2 are needed");
    for (const int face : chain.faces)
      if (face < 0 || face >= triangle_of_face.size())
        throw InputError(label() + ": there is no face " + std::to_string(face) +
                             "; the mesh has " + std::to_string(triangle_of_face.size()) +
                             ", counted from 0",
                         "no-such-element");
    for (std::size_t i = 0; i + 1 < chain.faces.size(); ++i) {
      const int f = triangle_of_face[chain.faces[i]], g = triangle_of_face[chain.faces[i + 1]];
      if (f < 0 || g < 0 || !add_step(f, g, J, curve))
        throw InputError(label() + ": faces " + std::to_string(chain.faces[i]) + " and " +
                         std::to_string(chain.faces[i + 1]) +
                         " (counted from 0) share no edge; a chain goes from face to neighbour");
    }
  }
}

}  // namespace littoral
