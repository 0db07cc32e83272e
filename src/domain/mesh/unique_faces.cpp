#include "domain/mesh/unique_faces.h"

#include <algorithm>
#include <utility>

#include "base/index.h"
#include "base/same_rows.h"

namespace littoral {

UniqueFaces::UniqueFaces(std::shared_ptr<const SurfaceMesh> input) : mesh(std::move(input)) {
  const SurfaceMesh& all = *mesh;
  if (!all.is_triangle_mesh()) return;
  const std::vector<RepeatedRow> copies =
      repeated_faces(all.shared_side_edges().matrix(), [&](int f) {
        const auto at = all.edge_faces(all.side_edge(f, 0));
        return at.size() > 2 ? several_faces : at.size() < 2 ? no_face : at[0] == f ? at[1] : at[0];
      });
  if (copies.empty()) return;
  std::vector<int> first(std::size_t(all.n_faces()), -1);
  for (const RepeatedRow& copy : copies) first[copy.row] = copy.first;
  PolygonSoup soup;
  soup.points = all.points();
  soup.corners.reserve(all.soup().corners.size());
  face_of_input.resize(first.size());
  for (int f = 0; f < all.n_faces(); ++f) {
    if (first[f] >= 0) continue;
    face_of_input[f] = soup.n_faces();
    input_face.push_back(f);
    soup.add_face(all.face(f));
  }
  for (int f = 0; f < all.n_faces(); ++f)
    if (first[f] >= 0) face_of_input[f] = face_of_input[first[f]];
  // The edges of a copy were numbered and directed by the first.
  mesh = std::make_shared<const SurfaceMesh>(std::move(soup));
}

Sources UniqueFaces::on_mesh(const SurfaceMesh& input, Sources sources) const {
  if (!any_copies()) return sources;
  const auto move = [&](SurfacePoint& p) {
    if (p.on != SurfacePoint::On::face || p.element < 0 || p.element >= input.n_faces()) return;
    SurfacePoint there{p.on, face_of_input[p.element], {0, 0, 0}};
    const auto from = input.face(p.element), to = mesh->face(there.element);
    for (int k = 0; k < 3; ++k)
      there.b[std::size_t(std::find(to.begin(), to.end(), from[k]) - to.begin())] += p.b[k];
    p = there;
  };
  for (Curve& curve : sources.curves) std::for_each(curve.nodes.begin(), curve.nodes.end(), move);
  std::for_each(sources.points.begin(), sources.points.end(), move);
  return sources;
}

}  // namespace littoral
