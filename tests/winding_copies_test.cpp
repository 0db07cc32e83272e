// Surface winding numbers on meshes that hold some faces twice: as on the mesh that holds them
// once.

#include <gtest/gtest.h>

#include <vector>

#include "one_call.h"
#include "test_meshes.h"
#include "torus_loops.h"

namespace littoral {
namespace {

TEST(WindingOfDoubledFaces, CopiesOfFacesChangeNothing) {
  const PolygonSoup plain = test::torus_soup(test::nu, test::nv);
  PolygonSoup doubled;
  doubled.points = plain.points;
  std::vector<int> once, copy(std::size_t(plain.n_faces()), -1);
  for (int f = 0; f < plain.n_faces(); ++f) {
    const auto c = plain.face(f);
    once.push_back(doubled.n_faces());
    test::add_triangle(doubled, c[0], c[1], c[2]);
    if (f % 3 == 2) continue;
    copy[f] = doubled.n_faces();
    if (f % 3 == 0)
      test::add_triangle(doubled, c[1], c[2], c[0]);
    else
      test::add_triangle(doubled, c[2], c[1], c[0]);
  }
  // A disk with a gap, a loop that bounds nothing, and a triangle inside faces.
  std::vector<int> open = test::disk(3, 9, 2, 7);
  open.erase(open.begin(), open.begin() + 2);
  const auto sources_on = [&](bool copies) {
    Sources sources;
    sources.curves = {Curve::along_vertices(open), Curve::along_vertices(test::meridian(15)), {}};
    for (const int f : {600, 601, 640, 600}) {
      const int g = copies && copy[f] >= 0 ? copy[f] : f;
      SurfacePoint p = SurfacePoint::in_face(copies ? g == f ? once[f] : g : f, 0.2, 0.3, 0.5);
      if (g != f && f % 3 == 0) p.b = {0.3, 0.5, 0.2};
      if (g != f && f % 3 == 1) p.b = {0.5, 0.3, 0.2};
      sources.curves.back().nodes.push_back(p);
    }
    return sources;
  };
  const SurfaceMesh mesh(plain), twice(doubled);
  const auto compare = [&](const Sources& given, const Sources& on_copies,
                           const SurfaceWinding& options) {
    Report report;
    const WindingAnswer expected = test::surface_winding(mesh, given, options, report);
    const WindingAnswer answer = test::surface_winding(twice, on_copies, options, report);
    EXPECT_GT(expected.region.maxCoeff() - expected.region.minCoeff(), 0);
    for (int f = 0; f < mesh.n_faces(); ++f) {
      EXPECT_EQ(answer.region[once[f]], expected.region[f]) << f;
      if (copy[f] >= 0) {
        EXPECT_EQ(answer.region[copy[f]], expected.region[f]) << f;
      }
    }
    EXPECT_EQ(answer.bounding, expected.bounding);
    EXPECT_EQ(answer.nonbounding, expected.nonbounding);
    EXPECT_EQ(answer.completed, expected.completed);
    EXPECT_EQ(answer.shown.scalars, expected.shown.scalars);
    for (std::size_t v = 0; v < answer.cut.point.size(); ++v)
      EXPECT_EQ(twice.position(answer.cut.point[v]), mesh.position(expected.cut.point[v])) << v;
    for (std::size_t f = 0; f < answer.cut.parent_face.size(); ++f)
      EXPECT_EQ(answer.cut.parent_face[f], once[expected.cut.parent_face[f]]) << f;
  };
  for (const Formulation formulation :
       {Formulation::primal, Formulation::dual, Formulation::nonconforming}) {
    SurfaceWinding options;
    options.formulation = formulation;
    compare(sources_on(false), sources_on(true), options);
  }
  // Steps from face to face, in the numbers of the input.
  Sources chain, chain_on_copies;
  for (int i = 3; i < 9; ++i) {
    const int f = 2 * (i * test::nv + 5), g = f + 1;
    chain.chains.push_back({{f, g}, "chain"});
    chain_on_copies.chains.push_back({{copy[f] < 0 ? once[f] : copy[f], once[g]}, "chain"});
  }
  compare(chain, chain_on_copies, {});
}

}  // namespace
}  // namespace littoral
