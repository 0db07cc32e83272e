// Agreement with the outputs of the authors' program. Tolerances and known defects are those stated
// beside the outputs; docs/measurements/heat.md explains each disagreement.

#include <gmock/gmock.h>

#include <fstream>
#include <sstream>

#include "heat_helpers.h"
#include "io/read.h"
#include "one_call.h"
#include "shared_data.h"

namespace littoral {
namespace {

VecX read_values(const std::filesystem::path& path) {
  std::ifstream in(path);
  std::vector<double> values;
  for (double v; in >> v;) values.push_back(v);
  return Eigen::Map<VecX>(values.data(), static_cast<Eigen::Index>(values.size()));
}

std::filesystem::path folder_of(const std::string& name) {
  return std::filesystem::path("reference/shm_surface") / name;
}

/// What was put into the authors' program, and where its outputs lie.
struct Example {
  std::filesystem::path folder;
  SurfaceMesh mesh;
  Sources sources;

  explicit Example(const std::string& name)
      : folder(test::shared() / folder_of(name)), mesh(io::read_surface(folder / "mesh.obj")) {
    Report unread;
    sources = io::read_sources(folder / "input_source.txt", mesh, std::nullopt, unread);
  }
};

/// Compares a difference, in shares of the range, with what a case allows.
template <class Limits>
void expect_small(const VecX& difference, const Limits& c) {
  const double largest = difference.cwiseAbs().maxCoeff(), mean = difference.cwiseAbs().mean();
  testing::Test::RecordProperty("largest", std::to_string(largest));
  testing::Test::RecordProperty("mean", std::to_string(mean));
  EXPECT_LE(largest, c.tolerance);
  EXPECT_LE(mean, c.mean_tolerance);
}

struct TheirRun {
  const char* name;
  const char* output;
  Constraint constraint;
  double tolerance;       // of the range, largest difference
  double mean_tolerance;  // of the range, mean difference
  double soft = 0;
  bool preserve = false;
  bool up_to_shift = false;  // their zero is the smallest value, ours the mean along the source
};

std::ostream& operator<<(std::ostream& out, const TheirRun& c) {
  return out << c.name << "/" << c.output;
}

class SignedHeatReference : public testing::TestWithParam<TheirRun> {};

TEST_P(SignedHeatReference, AgreesWithTheAuthorsProgram) {
  const TheirRun& c = GetParam();
  LITTORAL_NEEDS_SHARED(folder_of(c.name));
  const Example example(c.name);
  Report report;
  SignedHeat options{1, c.constraint, c.soft, c.preserve};
  options.point_sources = PointVectors::radial;  // as theirs
  const VecX phi = test::signed_heat(example.mesh, example.sources, options, report);
  VecX theirs = read_values(example.folder / c.output);
  ASSERT_EQ(phi.size(), theirs.size());
  ASSERT_TRUE(phi.allFinite());
  const double range = theirs.maxCoeff() - theirs.minCoeff();
  if (c.up_to_shift) theirs.array() += (phi - theirs).mean();
  expect_small((phi - theirs) / range, c);
}

/// Polygon meshes: another discretization than the authors', so only alike.
struct OtherDomain {
  const char* name;
  const char* output;
  const char* constraint;
  double tolerance, mean_tolerance;  // of the range
};

std::ostream& operator<<(std::ostream& out, const OtherDomain& c) {
  return out << c.name << "/" << c.output;
}

class OtherDomainReference : public testing::TestWithParam<OtherDomain> {};

TEST_P(OtherDomainReference, IsCloseToTheAuthorsProgram) {
  const OtherDomain& c = GetParam();
  LITTORAL_NEEDS_SHARED(folder_of(c.name));
  const Example example(c.name);
  Report report;
  VecX phi = test::surface_distance(
      example.mesh, example.sources,
      AnyMethod::named("signed-heat", {{"constraint", c.constraint}, {"time-scale", "1"}}), report);
  const VecX theirs = read_values(example.folder / c.output);
  ASSERT_EQ(phi.size(), theirs.size());
  ASSERT_TRUE(phi.allFinite());
  // Their vertex-based discretizations turn curve normals the other way than their edge-based one.
  if (phi.dot(theirs) < 0) phi = -phi;
  expect_small((phi - theirs) / (theirs.maxCoeff() - theirs.minCoeff()), c);
}

INSTANTIATE_TEST_SUITE_P(
    Cases, OtherDomainReference,
    testing::Values(OtherDomain{"polygon-bear", "dist_none.txt", "none", 0.032, 0.01},
                    OtherDomain{"polygon-bear", "dist_zero.txt", "zero-set", 0.032, 0.01}));

constexpr auto none = Constraint::none, zero = Constraint::zero_set,
               levels = Constraint::level_sets;
INSTANTIATE_TEST_SUITE_P(
    Cases, SignedHeatReference,
    testing::Values(
        TheirRun{"cheb0_13k", "dist_none.txt", none, 1e-8, 1e-8},
        TheirRun{"octa6_equator", "dist_none.txt", none, 1e-8, 1e-8},
        TheirRun{"duck", "dist_none.txt", none, 1e-8, 1e-8},
        TheirRun{"bumpy-sphere", "dist_none.txt", none, 1e-8, 1e-8},
        TheirRun{"shark-cupcake", "dist_none.txt", none, 1e-8, 1e-8},
        TheirRun{"vase-nested-curves", "dist_none.txt", none, 1e-8, 1e-8},
        TheirRun{"mobius", "dist_none.txt", none, 1e-2, 1e-3},
        TheirRun{"cheb0_13k", "dist_default.txt", zero, 1e-8, 1e-8},
        TheirRun{"octa6_equator", "dist_default.txt", zero, 1e-8, 1e-8},
        TheirRun{"duck", "dist_default.txt", zero, 1e-8, 1e-8},
        TheirRun{"bumpy-sphere", "dist_zero.txt", zero, 1e-8, 1e-8},
        TheirRun{"shark-cupcake", "dist_default.txt", zero, 1e-8, 1e-8},
        TheirRun{"vase-nested-curves", "dist_default.txt", zero, 1e-8, 1e-8},
        TheirRun{"mobius", "dist_default.txt", zero, 1e-2, 1e-3},
        TheirRun{"duck", "dist_multiple.txt", levels, 1e-8, 1e-8},
        TheirRun{"bumpy-sphere", "dist_multiple.txt", levels, 1e-8, 1e-8},
        TheirRun{"shark-cupcake", "dist_multiple.txt", levels, 1e-8, 1e-8},
        TheirRun{"vase-nested-curves", "dist_multiple.txt", levels, 1e-8, 1e-8},
        TheirRun{"bumpy-sphere", "dist_default_soft100.txt", zero, 5e-3, 5e-4, 100},
        TheirRun{"bumpy-sphere", "dist_default_preserve.txt", zero, 3e-2, 5e-3, 0, true},
        TheirRun{"fish-unsigned-curve", "dist_none.txt", none, 0.1, 3e-2},
        TheirRun{"fish-unsigned-curve", "dist_default.txt", zero, 0.1, 3e-2},
        TheirRun{"block-points", "dist_none.txt", none, 1e-8, 1e-8, 0, false, true},
        TheirRun{"block-points", "dist_default.txt", zero, 1e-8, 1e-8, 0, false, true}));

}  // namespace
}  // namespace littoral
