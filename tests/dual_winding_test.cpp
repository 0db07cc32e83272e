// The dual formulation of surface winding numbers, and chains of faces.

#include <gtest/gtest.h>

#include <cmath>

#include "io/read.h"
#include "io/sources/source_nodes.h"
#include "littoral/error.h"
#include "one_call.h"
#include "shared_data.h"
#include "space_helpers.h"
#include "test_meshes.h"

namespace littoral {
namespace {

WindingAnswer dual(const SurfaceMesh& mesh, const Sources& sources, Labels labels = Labels::round) {
  return test::surface_winding(mesh, sources,
                               SurfaceWinding{.formulation = Formulation::dual, .labels = labels});
}

Sources chain_of(std::vector<std::vector<int>> chains) {
  Sources sources;
  for (auto& faces : chains) sources.chains.push_back({faces, "test"});
  return sources;
}

TEST(DualWinding, AgreesWithThePrimalOnClosedCurvesAndNearlyOnBrokenOnes) {
  LITTORAL_NEEDS_SHARED("data/generated/curves");
  const auto folder = test::shared() / "data/generated/curves";
  const struct {
    const char *mesh, *curve;
    double differs;
  } cases[] = {{"sphere_cap", "sphere_two_caps.swn.txt", 0},
               {"torus_disc", "torus_meridian_and_disc.txt", 0},
               {"torus_disc", "torus_band.txt", 0},
               {"torus_disc", "torus_meridian.txt", 0},
               {"sphere_cap", "sphere_cap.broken20.swn.txt", 0.03},
               {"torus_disc", "torus_disc.broken20.swn.txt", 0.03}};
  for (const auto& c : cases) {
    SCOPED_TRACE(c.curve);
    const SurfaceMesh mesh(io::read_surface(folder / (std::string(c.mesh) + ".obj")));
    Report report;
    const auto sources = io::read_sources(folder / c.curve, mesh, {}, report);
    const VecXi primal = test::surface_winding(mesh, sources).region;
    const VecXi region = dual(mesh, sources).region;
    EXPECT_LE((region.array() != primal.array()).cast<double>().mean(), c.differs);
    EXPECT_EQ(dual(mesh, sources.reversed()).region, -region);
  }
}

/// A band of n quads from x = 0 to x = n, whose ends are joined: turned over, or not.
SurfaceMesh band(int n, bool twisted) {
  PolygonSoup soup;
  soup.points.resize(2 * n, 3);
  for (int i = 0; i < n; ++i) {
    const double a = 2 * M_PI * i / n, half = twisted ? a / 2 : 0;
    const Vec3 out(std::cos(a), std::sin(a), 0);
    const Vec3 across = std::cos(half) * Vec3::UnitZ() + std::sin(half) * out;
    soup.points.row(2 * i) = (3 * out - across).transpose();
    soup.points.row(2 * i + 1) = (3 * out + across).transpose();
  }
  for (int i = 0; i < n; ++i) {
    int c = 2 * i + 2, d = 2 * i + 3;
    if (i == n - 1) {
      c = twisted ? 1 : 0;
      d = twisted ? 0 : 1;
    }
    test::add_triangle(soup, 2 * i, c, d);
    test::add_triangle(soup, 2 * i, d, 2 * i + 1);
  }
  return SurfaceMesh(soup);
}

TEST(DualWinding, RegionsOfAMoebiusBand) {
  // Two cuts across: up into the fifth quad, down after the tenth.
  for (const bool twisted : {false, true}) {
    const SurfaceMesh mesh = band(40, twisted);
    const VecXi region = dual(mesh, chain_of({{8, 11}, {21, 18}})).region;
    for (int f = 0; f < mesh.n_faces(); ++f) EXPECT_EQ(region[f], f >= 10 && f < 20 ? 1 : 0) << f;
  }
}

TEST(DualWinding, ACutAcrossAMoebiusBandBoundsNothing) {
  for (const bool twisted : {false, true}) {
    const SurfaceMesh mesh = band(40, twisted);
    const VecXi region = dual(mesh, chain_of({{8, 11}})).region;
    EXPECT_EQ(region, VecXi::Zero(mesh.n_faces())) << twisted;
  }
}

TEST(DualWinding, ChainsSayWhichPagesOfABookDiffer) {
  constexpr int n = 6;
  const SurfaceMesh mesh(test::book_soup(3, n, 2.1));
  // At the spine, page 2 is above pages 0 and 1.
  Sources sources;
  for (int j = 0; j < n; ++j) {
    const auto at_spine = [&](int page) { return 2 * (page * n * n + j) + 1; };
    sources.chains.push_back({{at_spine(0), at_spine(2)}, "a"});
    sources.chains.push_back({{at_spine(1), at_spine(2)}, "b"});
  }
  VecXi region = dual(mesh, sources).region;
  for (int f = 0; f < mesh.n_faces(); ++f) EXPECT_EQ(region[f], f / (2 * n * n) == 2) << f;
  // The same with one third of it missing, cut: there it is shorter to go through page 2, once,
  // than along the spine, across two pairs of pages.
  sources.chains.resize(8);
  region = dual(mesh, sources, Labels::cut).region;
  int otherwise = 0;
  for (int f = 0; f < mesh.n_faces(); ++f) {
    if (f / (2 * n * n) != 2) {
      EXPECT_EQ(region[f], 0) << f;
    }
    otherwise += region[f] != (f / (2 * n * n) == 2);
  }
  EXPECT_LE(otherwise, 4);
}

TEST(DualWinding, RefusesChainsThatAreNone) {
  const SurfaceMesh mesh = band(40, false);
  EXPECT_THROW(dual(mesh, chain_of({{3, 9}})), InputError);
  EXPECT_THROW(dual(mesh, chain_of({{3, 3}})), InputError);
  Sources unnamed;
  const auto error = [&](const std::vector<int>& faces) {
    unnamed.chains = {{{10, 11}, ""}, {faces, ""}};
    return test::message_of([&] { dual(mesh, unnamed); });
  };
  EXPECT_EQ(error({3, 9}),
            "chain 2: faces 3 and 9 (counted from 0) share no edge; a chain goes from face to "
            "neighbour");
  for (const int face : {-1, 80, 1 << 30}) {
    const std::string says =
        "chain 2: there is no face " + std::to_string(face) + "; the mesh has 80, counted from 0";
    EXPECT_EQ(error({10, face}), says);
    EXPECT_EQ(error({face, 10}), says);
  }
  EXPECT_EQ(error({3}), "chain 2 has 1 face, at least 2 are needed");
  EXPECT_EQ(error({}), "chain 2 has 0 faces, at least 2 are needed");
  const auto read = [&](const std::string& text) {
    return io::read_sources_txt(text, "a.txt", mesh, {});
  };
  EXPECT_EQ(read("c 10 11\nc 21 20 19\n").chains[1].faces, (std::vector<int>{20, 19, 18}));
  EXPECT_EQ(read("#offset 0\nc 10 11\n").chains[0].faces, (std::vector<int>{10, 11}));
  EXPECT_THROW(read("c 10\n"), InputError);
  EXPECT_THROW(read("c 10 81\n"), InputError);
  EXPECT_THROW(read("c 10 x\n"), InputError);
  EXPECT_THROW(read("c 0 1\n"), InputError);
}

}  // namespace
}  // namespace littoral
