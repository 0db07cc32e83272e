// Meshes that hold some faces twice are as the mesh that holds them once.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "one_call.h"
#include "test_meshes.h"
#include "torus_loops.h"

namespace littoral {
namespace {

/// A torus, and the same with two faces in three doubled, some of these the other way round.
struct CopiesOfFaces : testing::Test {
  CopiesOfFaces() : copy(std::size_t(plain.n_faces()), -1) {
    doubled.points = plain.points;
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
  }
  /// The same place in a face or, if there is one, in its copy.
  SurfacePoint inside(int f, bool copies) const {
    const int g = copies && copy[f] >= 0 ? copy[f] : f;
    SurfacePoint p = SurfacePoint::in_face(copies ? g == f ? once[f] : g : f, 0.2, 0.3, 0.5);
    if (g != f && f % 3 == 0) p.b = {0.3, 0.5, 0.2};
    if (g != f && f % 3 == 1) p.b = {0.5, 0.3, 0.2};
    return p;
  }

  const PolygonSoup plain = test::torus_soup(test::nu, test::nv);
  PolygonSoup doubled;
  std::vector<int> once, copy;
};

TEST_F(CopiesOfFaces, ChangeNoWindingNumber) {
  // A disk with a gap, a loop that bounds nothing, and a triangle inside faces.
  std::vector<int> open = test::disk(3, 9, 2, 7);
  open.erase(open.begin(), open.begin() + 2);
  const auto sources_on = [&](bool copies) {
    Sources sources;
    sources.curves = {Curve::along_vertices(open), Curve::along_vertices(test::meridian(15)), {}};
    for (const int f : {600, 601, 640, 600})
      sources.curves.back().nodes.push_back(inside(f, copies));
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

TEST_F(CopiesOfFaces, ChangeNoDistance) {
  const std::vector<int> whole = test::disk(3, 9, 2, 7);
  const std::vector<int> with_gap(whole.begin() + 4, whole.end());
  std::vector<int> turned(whole.begin(), whole.begin() + 5);
  std::reverse(turned.begin(), turned.end());
  const std::vector<int> rest(whole.begin() + 4, whole.end());
  const std::map<std::string, std::vector<Curve>> cases = {
      {"none", {Curve::along_vertices(whole)}},
      {"shortest", {Curve::along_vertices(turned), Curve::along_vertices(rest)}},
      {"heat", {Curve::along_vertices(with_gap)}}};
  const SurfaceMesh mesh(plain), twice(doubled);
  for (const auto& [completion, curves] : cases) {
    Sources sources;
    sources.curves = curves;
    Sources on_copies = sources;
    sources.points = {inside(600, false), inside(601, false)};
    on_copies.points = {inside(600, true), inside(601, true)};
    Report report, of_copies;
    const VecX expected = test::surface_answer(mesh, sources, Automatic{}, report).values;
    const VecX values = test::surface_answer(twice, on_copies, Automatic{}, of_copies).values;
    EXPECT_THAT(report.options, testing::Contains(testing::Pair("completion", completion)));
    EXPECT_THAT(of_copies.options, testing::Contains(testing::Pair("completion", completion)));
    EXPECT_LT(expected.minCoeff(), 0) << completion;
    EXPECT_EQ(values, expected) << completion;
  }
}

}  // namespace
}  // namespace littoral
