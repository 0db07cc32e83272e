// Surface winding numbers against the outputs of the authors' program.

#include <gtest/gtest.h>

#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include "domain/intrinsic/intrinsic_triangulation.h"
#include "io/read.h"
#include "methods/winding/surface_winding.h"
#include "shared_data.h"

namespace littoral {
namespace {

/// Numbers of a text file; `nan` is one of them.
std::vector<double> numbers(const std::filesystem::path& path) {
  std::ifstream in(path);
  std::vector<double> out;
  for (std::string word; in >> word;) out.push_back(std::stod(word));
  return out;
}

MatX3 corners(const std::filesystem::path& path) {
  const std::vector<double> x = numbers(path);
  return Eigen::Map<const MatX3>(x.data(), static_cast<Eigen::Index>(x.size() / 3), 3);
}

struct TheirRegions {
  JumpCalculus J;
  VecX curve;
  std::filesystem::path folder;
};

TheirRegions load(const std::string& name, bool clamp) {
  TheirRegions c;
  c.folder = test::shared() / "reference/swn" / name;
  const SurfaceMesh mesh(io::read_surface(c.folder / "mesh.obj"));
  Report report;
  c.J = jump_calculus(intrinsic_triangulation(mesh, report));
  // Half their cotangents lie between 1e-3 and 1e3.
  if (clamp) c.J.weight = c.J.weight.cwiseMax(1e-3).cwiseMin(1e3);
  c.curve = VecX::Zero(c.J.n_edges);
  const std::vector<double> ends = numbers(c.folder / "curve_edges_0based.txt");
  for (std::size_t i = 0; i + 1 < ends.size(); i += 2)
    for (int f = 0; f < mesh.n_faces(); ++f)
      for (int k = 0; k < 3; ++k)
        if (mesh.face(f)[k] == static_cast<int>(ends[i]) &&
            mesh.face(f)[(k + 1) % 3] == static_cast<int>(ends[i + 1]))
          c.curve[c.J.edge(f, k)] += c.J.along(f, k);
  return c;
}

WindingNumbers solve(const TheirRegions& c, const SurfaceWinding& options = {}) {
  Report report;
  return WindingSolver(std::make_shared<const JumpCalculus>(c.J))
      .solve(c.curve, options, {}, report);
}

class WindingReference : public testing::TestWithParam<std::string> {};

TEST_P(WindingReference, JumpHarmonicFunctionsAgree) {
  LITTORAL_NEEDS_SHARED("reference/swn");
  const TheirRegions c = load(GetParam(), true);
  const WindingNumbers ours = solve(c);
  const MatX3 theirs = corners(c.folder / "u_corner.txt");
  ASSERT_EQ(theirs.rows(), c.J.n_faces);
  // Up to one constant, and not at the ends of curves, where neither has a value.
  double lo = std::numeric_limits<double>::infinity(), hi = -lo;
  for (int f = 0; f < c.J.n_faces; ++f)
    for (int k = 0; k < 3; ++k)
      if (!ours.u.open[c.J.node(f, k)]) {
        lo = std::min(lo, ours.u.u(f, k) - theirs(f, k));
        hi = std::max(hi, ours.u.u(f, k) - theirs(f, k));
      }
  EXPECT_LE(hi - lo, 1e-5);
}

TEST_P(WindingReference, LabelsAgree) {
  LITTORAL_NEEDS_SHARED("reference/swn");
  const TheirRegions c = load(GetParam(), false);
  const WindingNumbers ours = solve(c);
  const std::vector<double> theirs = numbers(c.folder / "label_face.txt");
  double best = 1;
  for (int shift = -2; shift <= 2; ++shift) {
    double wrong = 0;
    for (int f = 0; f < c.J.n_faces; ++f)
      if (ours.region[f] + shift != static_cast<int>(theirs[f])) wrong += c.J.area[f];
    best = std::min(best, wrong / c.J.area.sum());
  }
  // Their residual function of torus-phi is 2.5e10 everywhere; the labels made with it differ.
  EXPECT_LE(best, GetParam() == "torus-phi" ? 0.04 : 0.0);
}

INSTANTIATE_TEST_SUITE_P(Cases, WindingReference,
                         testing::Values("asymmetric-torus", "bunny-heart", "double-torus",
                                         "torus-phi"),
                         [](const auto& c) {
                           std::string name = c.param;
                           name.erase(std::remove(name.begin(), name.end(), '-'), name.end());
                           return name;
                         });

TEST(WindingReferences, ResidualsAreNoLonger) {
  LITTORAL_NEEDS_SHARED("reference/swn");
  for (const char* name : {"asymmetric-torus", "double-torus"}) {
    SCOPED_TRACE(name);
    const TheirRegions c = load(name, false);
    const SurfaceWinding options;
    const WindingNumbers ours = solve(c, options);
    // Both as jumps of corner values, measured alike.
    const auto length = [&](const MatX3& v) {
      const VecX jump = jump_derivative(c.J, v);
      double sum = 0;
      for (int e = 0; e < c.J.n_edges; ++e)
        sum += (c.curve[e] != 0 ? options.curve_weight : 1) * c.J.length[e] * std::abs(jump[e]);
      return sum;
    };
    EXPECT_LE(length(ours.v), length(corners(c.folder / "v_corner.txt")) * (1 + 1e-6));
    EXPECT_LE(ours.gap, 1e-6);
  }
}

}  // namespace
}  // namespace littoral
