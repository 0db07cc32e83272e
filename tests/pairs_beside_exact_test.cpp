// How far distances between pairs are from exact ones, and that it is said.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "api/surface/pairs.h"
#include "geodesic_helpers.h"
#include "one_call.h"
#include "test_meshes.h"

namespace littoral {
namespace {

TEST(PairsBesideExact, SmoothedFarFromExactDistanceIsSaid) {
  const SurfaceMesh mesh(test::octasphere_soup(2));
  double last = 0;
  for (const auto& [alpha, far] : {std::pair("0.01", false), {"0.05", false}, {"1", true}}) {
    Report report;
    const MatX D =
        test::pair_distances(mesh, {}, AnyMethod::named("symmetric", {{"alpha", alpha}}), report)
            .distances;
    double difference = 0;
    for (const int v : {0, 8, 16, 24, 33, 41, 49, 57}) {
      const VecX d = test::exact(mesh, test::vertex_points({v}));
      difference += (D.row(v).transpose() - d).cwiseAbs().mean() / d.maxCoeff() / 8;
    }
    const auto said = std::find_if(report.residuals.begin(), report.residuals.end(), [](auto& r) {
      return r.first == "mean difference from exact distance";
    });
    ASSERT_NE(said, report.residuals.end());
    EXPECT_NEAR(said->second, difference, 1e-9) << alpha;
    EXPECT_GT(difference, last);
    EXPECT_EQ(report.warnings.size(), far ? 1U : 0U) << alpha << " " << difference;
    last = difference;
  }
}

}  // namespace
}  // namespace littoral
