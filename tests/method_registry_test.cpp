// One concept for every method: registered, found by name, checked, prepared once, solved from any
// thread.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <thread>

#include "littoral/error.h"
#include "one_call.h"
#include "space_helpers.h"
#include "test_meshes.h"
#include "tet_helpers.h"

namespace littoral {
namespace {

using test::message_of;
using ::testing::HasSubstr;

/// A method of one's own: straight through space to the nearest node of the sources, times a scale.
struct ThroughTheAir {
  static constexpr const char* method = "test-through-the-air";
  double scale = 1;
};

Method<SurfaceDomain> through_the_air() {
  static const OptionTable<ThroughTheAir> table = OptionTable<ThroughTheAir>().number(
      &ThroughTheAir::scale, "scale", "", 0.5, 2, "Factor of all values.");
  return make_method<SurfaceDomain>(
      {ThroughTheAir::method, "Distance through the air.", {"triangle mesh"}, {}, "none"}, table,
      [](const SurfaceDomain& domain, const ThroughTheAir&, SolveHint, const Task&, Report&) {
        return [domain](const Sources& sources, const ThroughTheAir& options, Task&, Report&) {
          const SurfaceMesh& mesh = *domain.mesh;
          std::vector<SurfacePoint> nodes = sources.points;
          for (const Curve& curve : sources.curves)
            nodes.insert(nodes.end(), curve.nodes.begin(), curve.nodes.end());
          SurfaceAnswer answer;
          answer.values =
              VecX::Constant(mesh.n_vertices(), std::numeric_limits<double>::infinity());
          for (int v = 0; v < mesh.n_vertices(); ++v)
            for (const SurfacePoint& p : nodes)
              answer.values[v] = std::min(
                  answer.values[v], options.scale * (mesh.point(v) - mesh.position(p)).norm());
          return answer;
        };
      });
}

Registry<SurfaceDomain>& with_own_method() {
  static const bool added = (Registry<SurfaceDomain>::instance().add(through_the_air()), true);
  static_cast<void>(added);
  return Registry<SurfaceDomain>::instance();
}

AnyMethod own(OptionValues values = {}) {
  return AnyMethod::named(ThroughTheAir::method, std::move(values));
}

TEST(MethodRegistry, AnOwnMethodIsFoundEverywhere) {
  with_own_method();
  bool listed = false;
  for (const MethodFamily& family : method_families())
    for (const MethodInfo& info : family.methods)
      if (info.name == ThroughTheAir::method) {
        listed = true;
        EXPECT_EQ(family.title, SurfaceDomain::title);
        ASSERT_EQ(info.options.size(), 1u);
        EXPECT_EQ(info.options[0].name, "scale");
        EXPECT_EQ(info.options[0].fallback, "1");
        EXPECT_EQ(info.options[0].range(), "0.5 to 2");
      }
  EXPECT_TRUE(listed);

  const SurfaceMesh mesh(test::octasphere_soup(1));
  const Sources source(SurfacePoint::at_vertex(3));
  Report report;
  const VecX once = test::surface_distance(mesh, source, ThroughTheAir{.scale = 2}, report);
  for (int v = 0; v < mesh.n_vertices(); ++v)
    EXPECT_EQ(once[v], 2 * (mesh.point(v) - mesh.point(3)).norm());
  EXPECT_EQ(report.method, ThroughTheAir::method);
  EXPECT_EQ(report.domain, "triangle mesh");
  EXPECT_THAT(report.options, testing::ElementsAre(testing::Pair("scale", "2")));
  EXPECT_EQ(test::surface_distance(mesh, source, own({{"scale", "2"}}), report), once);

  const PairsAnswer pairs = test::pair_distances(mesh, {}, own(), report);
  ASSERT_EQ(pairs.distances.rows(), mesh.n_vertices());
  EXPECT_LT((2 * pairs.distances.row(3).transpose() - once).cwiseAbs().maxCoeff(), 1e-15);
  ASSERT_TRUE(pairs.statistics);
  EXPECT_LT(pairs.statistics->largest_violation, 1e-12);
  const auto infos = pair_methods();
  EXPECT_TRUE(std::any_of(infos.begin(), infos.end(), [](const MethodInfo& info) {
    return info.name == ThroughTheAir::method;
  }));
}

TEST(MethodRegistry, BadOptionsDomainsAndNamesAreRefused) {
  with_own_method();
  const SurfaceMesh mesh(test::octasphere_soup(1));
  const Sources source(SurfacePoint::at_vertex(3));
  const auto asked = [&](const SurfaceMesh& on, const AnyMethod& method) {
    return message_of([&] {
      Report report;
      test::surface_distance(on, source, method, report);
    });
  };
  Report report;
  EXPECT_THROW(test::surface_distance(mesh, source, own({{"bend", "1"}}), report), InputError);
  EXPECT_THAT(
      asked(mesh, own({{"bend", "1"}})),
      testing::AllOf(HasSubstr("'bend'"), HasSubstr(ThroughTheAir::method), HasSubstr("scale")));
  EXPECT_THROW(test::surface_distance(mesh, source, own({{"scale", "3"}}), report), InputError);
  EXPECT_THROW(test::surface_distance(mesh, source, ThroughTheAir{.scale = 3}, report), InputError);
  for (const AnyMethod& method : {own({{"scale", "3"}}), AnyMethod(ThroughTheAir{.scale = 3})})
    EXPECT_THAT(asked(mesh, method), testing::AllOf(HasSubstr("scale"), HasSubstr("2")));
  EXPECT_THAT(asked(mesh, own({{"scale", "wide"}})), HasSubstr("scale"));
  EXPECT_THAT(asked(mesh, AnyMethod::named("test-through-the-ground")),
              testing::AllOf(HasSubstr("test-through-the-ground"), HasSubstr("signed-heat"),
                             HasSubstr(ThroughTheAir::method)));
  EXPECT_THAT(message_of([&] {
                test::pair_distances(mesh, {}, own({{"bend", "1"}}), report);
              }),
              HasSubstr("'bend'"));
  // Options of another method, and of the same method elsewhere.
  EXPECT_THAT(asked(mesh, SpaceSignedHeat{}), HasSubstr("signed-heat"));
  EXPECT_THROW(test::surface_distance(mesh, source, SpaceSignedHeat{}, report), InputError);

  PolygonSoup points;
  points.points = points.normals = mesh.points();
  const SurfaceMesh cloud(points);
  EXPECT_THROW(test::surface_distance(cloud, source, own(), report), UnsupportedError);
  EXPECT_THAT(asked(cloud, own()),
              testing::AllOf(HasSubstr("triangle mesh"), HasSubstr("not on a point cloud"),
                             HasSubstr("signed-heat, unsigned-heat")));
  EXPECT_THROW(test::pair_distances(cloud, {0}, own(), report), UnsupportedError);
}

TEST(MethodRegistry, ANameCanBeTakenOnce) {
  Registry<SurfaceDomain>& registry = with_own_method();
  EXPECT_THROW(registry.add(through_the_air()), InputError);
  EXPECT_THAT(message_of([&] { registry.add(through_the_air()); }),
              HasSubstr(ThroughTheAir::method));
  Method<SurfaceDomain> taken = through_the_air();
  taken.info.name = Exact::method;
  EXPECT_THROW(registry.add(taken), InputError);
  EXPECT_EQ(registry.find(Exact::method)->info.domains, std::vector<std::string>{"triangle mesh"});
  const auto infos = registry.infos();
  EXPECT_EQ(std::count_if(infos.begin(), infos.end(),
                          [](const MethodInfo& info) { return info.name == Exact::method; }),
            1);
}

TEST(MethodRegistry, WithoutANameTheFirstIsTaken) {
  const SurfaceMesh mesh(test::octasphere_soup(2));
  const Sources source(SurfacePoint::at_vertex(3));
  Report report, same;
  EXPECT_EQ(test::surface_distance(mesh, source, {}, report),
            test::surface_distance(mesh, source, Automatic{}, same));
  EXPECT_EQ(report.method, "auto");
}

// ------------------------------------------------------------------ solvers that are used again

/// Every answer of `all` by one solver: one after the other, twice, and from four threads at once;
/// `expect_same(i, answer)` compares the i-th.
template <class D, class Same>
void use_again(const AnyMethod& method, const D& domain,
               const std::vector<typename D::Sources>& all, const Same& expect_same) {
  for (const SolveHint hint : {SolveHint::single_rhs, SolveHint::many_rhs}) {
    Report report;
    const auto solver = prepare(method, domain, hint, {}, report);
    for (int round = 0; round < 2; ++round)
      for (std::size_t i = 0; i < all.size(); ++i)
        expect_same(i, solver->solve(all[i], {}, report));
    const auto fresh = prepare(method, domain, hint, {}, report);  // nothing kept yet
    std::vector<std::optional<typename D::Answer>> answers(4);
    std::vector<std::thread> threads;
    for (std::size_t k = 0; k < answers.size(); ++k)
      threads.emplace_back([&, k] {
        Report own_report;
        answers[k] = fresh->solve(all[k % all.size()], {}, own_report);
      });
    for (std::thread& thread : threads) thread.join();
    for (std::size_t k = 0; k < answers.size(); ++k) expect_same(k % all.size(), *answers[k]);
  }
}

void expect_solver_can_be_used_again(const AnyMethod& method) {
  const SurfaceMesh mesh(test::jittered_grid_soup(8, 8, 0.2));
  std::vector<int> across;
  for (int j = 0; j <= 8; ++j) across.push_back(9 * j + 4);
  const std::vector<Sources> all = {Sources(SurfacePoint::at_vertex(20)),
                                    Sources().add(Curve::along_vertices(across)),
                                    Sources(SurfacePoint::in_face(30, 0.2, 0.3, 0.5))};
  std::vector<VecX> once;
  for (const Sources& sources : all) {
    Report report;
    once.push_back(test::surface_distance(mesh, sources, method, report));
    ASSERT_EQ(once.back().size(), mesh.n_vertices());
  }
  use_again(method, domain_of(mesh), all, [&](std::size_t i, const SurfaceAnswer& answer) {
    EXPECT_EQ(answer.values, once[i]) << i;
  });
}

TEST(SolverReuse, SurfaceMethodsGiveTheSameBits) {
  for (const MethodInfo& info : Registry<SurfaceDomain>::instance().infos()) {
    SCOPED_TRACE(info.name);
    expect_solver_can_be_used_again(AnyMethod::named(info.name));
  }
}

TEST(SolverReuse, SoDoTheirVariants) {
  const AnyMethod variants[] = {SignedHeat{.intrinsic_delaunay = true},
                                SignedHeat{.discontinuous = true},
                                SignedHeat{.soft = 100},
                                SignedHeat{.preserve_normals = true},
                                SignedHeat{.sharpen = Sharpening::on},
                                UnsignedHeat{.intrinsic_delaunay = true},
                                Quadratic{.is_signed = true},
                                Regularized{.regularizer = Regularizer::hessian},
                                Regularized{.elements = Elements::quadratic}};
  for (const AnyMethod& method : variants) {
    SCOPED_TRACE(method.name() + " " + std::to_string(&method - variants));
    expect_solver_can_be_used_again(method);
  }
}

TEST(SolverReuse, TetMethodsGiveTheSameBits) {
  const auto mesh = std::make_shared<const TetMesh>(test::tet_box(4));
  TetSources vertex, square, boundary;
  vertex.vertices = {7};
  square.surface = test::square_at(0.37, 3);
  boundary.boundary = true;
  const std::vector<TetSources> all = {vertex, square, boundary};
  for (const MethodInfo& info : Registry<TetDomain>::instance().infos()) {
    SCOPED_TRACE(info.name);
    const AnyMethod method = AnyMethod::named(info.name);
    std::vector<VecX> once;
    for (const TetSources& sources : all) {
      Report report;
      once.push_back(test::tet_mesh_distance(*mesh, sources, method, report));
    }
    use_again(method, TetDomain{mesh}, all,
              [&](std::size_t i, const VecX& values) { EXPECT_EQ(values, once[i]) << i; });
  }
}

TEST(SolverReuse, WindingNumbersGiveTheSameBits) {
  const SurfaceMesh mesh(test::torus_soup(12, 8));
  const Sources patch = Sources().add(
      Curve::along_vertices({17, 25, 33, 34, 35, 27, 19, 18, 17}));  // closed, on edges
  Sources broken = Sources().add(Curve::along_vertices({17, 25, 33, 34, 35, 27}));
  broken.add(Curve::along_vertices({40, 41, 42, 43, 44, 45, 46}));
  const std::vector<Sources> all = {patch, broken, broken.reversed()};
  for (const Formulation formulation :
       {Formulation::primal, Formulation::dual, Formulation::nonconforming}) {
    const SurfaceWinding method{.formulation = formulation};
    std::vector<WindingAnswer> once;
    for (const Sources& sources : all) once.push_back(test::surface_winding(mesh, sources, method));
    use_again(AnyMethod(method), WindingDomain{domain_of(mesh).mesh}, all,
              [&](std::size_t i, const WindingAnswer& answer) {
                EXPECT_EQ(answer.region, once[i].region) << i;
                EXPECT_EQ(answer.numbers.w.u, once[i].numbers.w.u) << i;
                EXPECT_EQ(answer.numbers.completed, once[i].numbers.completed) << i;
              });
  }
}

}  // namespace
}  // namespace littoral
