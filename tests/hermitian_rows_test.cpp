// Matrices that are asked for row by row, against the same kept as a whole.

#include "solve/direct/hermitian_rows.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <memory>
#include <random>
#include <type_traits>
#include <vector>

#include "domain/intrinsic/intrinsic_triangulation.h"
#include "littoral/error.h"
#include "methods/heat/heat_matrix.h"
#include "operators/connection_laplacian.h"
#include "test_meshes.h"

namespace littoral {
namespace {

/// A random Hermitian matrix of blocks, a third of which are zero.
template <class Scalar>
Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic> random_matrix(int blocks, int block) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> number(-1, 1);
  using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
  Matrix A = Matrix::Zero(Eigen::Index{blocks} * block, Eigen::Index{blocks} * block);
  for (int i = 0; i < blocks; ++i)
    for (int j = 0; j <= i; ++j) {
      if (i != j && number(random) > 1.0 / 3) continue;
      for (int r = 0; r < block; ++r)
        for (int c = 0; c < block; ++c) {
          Scalar z = number(random);
          if constexpr (!std::is_same_v<Scalar, double>) z += Scalar(0, number(random));
          A(i * block + r, j * block + c) = z;
        }
    }
  const Matrix whole = A.template triangularView<Eigen::Lower>();
  Matrix out = whole + whole.adjoint();
  for (Eigen::Index i = 0; i < out.rows(); ++i) out(i, i) = std::real(whole(i, i));
  return out;
}

template <class Scalar>
class HermitianRowsOf : public testing::Test {};
using Scalars = testing::Types<double, Complex>;
TYPED_TEST_SUITE(HermitianRowsOf, Scalars);

TYPED_TEST(HermitianRowsOf, LowerTriangleAreThoseOfTheMatrix) {
  for (const int block : {1, 2, 3}) {
    const int n = 9;
    const auto A = random_matrix<TypeParam>(n, block);
    const Eigen::SparseMatrix<TypeParam> lower =
        Eigen::Matrix<TypeParam, Eigen::Dynamic, Eigen::Dynamic>(
            A.template triangularView<Eigen::Lower>())
            .sparseView();
    const auto rows =
        rows_of<TypeParam>(std::make_shared<const Eigen::SparseMatrix<TypeParam>>(lower), block);
    ASSERT_EQ(rows->size(), n);
    ASSERT_EQ(rows->block(), block);
    BlockRow<TypeParam> row;
    std::vector<int> beside;
    for (int i = 0; i < n; ++i) {
      rows->row(i, row);
      rows->neighbours(i, beside);
      ASSERT_EQ(row.blocks.front(), i);
      EXPECT_TRUE(
          std::equal(row.blocks.begin() + 1, row.blocks.end(), beside.begin(), beside.end()));
      auto expected = A.middleRows(i * block, block).eval();
      ASSERT_EQ(row.values.size(), row.blocks.size() * block * block);
      const TypeParam* value = row.values.data();
      for (const int j : row.blocks)
        for (int r = 0; r < block; ++r)
          for (int c = 0; c < block; ++c, ++value) {
            EXPECT_EQ(*value, expected(r, j * block + c)) << i << " " << j;
            expected(r, j * block + c) = 0;
          }
      EXPECT_TRUE(expected.isZero(0)) << i;  // nothing was left out
    }
    EXPECT_EQ(Eigen::SparseMatrix<TypeParam>(lower_triangle(*rows, {}) - lower).norm(), 0);
  }
}

/// Triangles about one edge, beside a closed surface.
SurfaceMesh with_a_book(int fan) {
  PolygonSoup soup = test::octasphere_soup(2);
  const int first = soup.n_vertices();
  MatX3 points(first + 2 + fan, 3);
  points.topRows(first) = soup.points;
  points.row(first) << 3, 0, 0;
  points.row(first + 1) << 3, 0, 1;
  for (int k = 0; k < fan; ++k)
    points.row(first + 2 + k) << 3 + std::cos(0.3 * k), std::sin(0.3 * k), 0.4;
  soup.points = points;
  for (int k = 0; k < fan; ++k)  // from any corner on, so that edges meet in no order
    if (k % 2)
      test::add_triangle(soup, first, first + 1, first + 2 + k);
    else
      test::add_triangle(soup, first + 2 + k, first, first + 1);
  return SurfaceMesh(soup);
}

TEST(ConnectionRows, AreThoseOfTheMatrix) {
  // Of any number of faces at an edge.
  std::vector<SurfaceMesh> meshes{SurfaceMesh(test::grid_soup(5, 4))};
  for (const int fan : {3, 7, 8, 9, 20}) meshes.push_back(with_a_book(fan));
  for (const SurfaceMesh& mesh : meshes) {
    Report report;
    auto T = std::make_shared<IntrinsicTriangulation>(intrinsic_triangulation(mesh, report));
    T->seams.resize(0, 3);  // rows are asked for where there are none
    const SpMatC expected = connection_laplacian(*T, {});
    const auto rows = connection_rows(T);
    const SpMatC found = lower_triangle(*rows, {});
    EXPECT_LE(Eigen::MatrixXcd(found - expected).cwiseAbs().maxCoeff(), 1e-15);
    std::vector<int> beside;
    std::size_t n_beside = 0;
    for (int i = 0; i < rows->size(); ++i) {
      rows->neighbours(i, beside);
      n_beside += beside.size();
      std::sort(beside.begin(), beside.end());
      EXPECT_TRUE(std::adjacent_find(beside.begin(), beside.end()) == beside.end());
    }
    EXPECT_EQ(n_beside, std::size_t(2 * (expected.nonZeros() - expected.cols())));
  }
}

TEST(ConnectionRows, MeetEachNeighbourOnceWhereTrianglesShareTwoEdges) {
  // Two triangles on the same three vertices, both sides of a flat envelope: every edge meets each
  // other one in both.
  PolygonSoup soup;
  soup.points.resize(3, 3);
  soup.points << 0, 0, 0, 1, 0, 0, 0.2, 1, 0;
  test::add_triangle(soup, 0, 1, 2);
  test::add_triangle(soup, 0, 2, 1);
  Report report;
  const auto T = std::make_shared<const IntrinsicTriangulation>(
      intrinsic_triangulation(SurfaceMesh(soup), report));
  const auto rows = connection_rows(T);
  ASSERT_EQ(rows->size(), 3);
  BlockRow<Complex> row;
  for (int i = 0; i < 3; ++i) {
    rows->row(i, row);
    EXPECT_EQ(row.blocks.size(), 3U);
  }
  const SpMatC difference = lower_triangle(*rows, {}) - connection_laplacian(*T, {});
  EXPECT_LE(Eigen::MatrixXcd(difference).cwiseAbs().maxCoeff(), 1e-15);
}

TEST(ConnectionRows, AreThoseOfTheHeatStepWithMassesAdded) {
  const SurfaceMesh mesh = with_a_book(20);
  Report report;
  auto T = std::make_shared<IntrinsicTriangulation>(intrinsic_triangulation(mesh, report));
  T->seams.resize(0, 3);
  VecX M = VecX::LinSpaced(T->n_edges(), 0, 1);  // the first has none
  const double t = 0.3;
  const SpMatC expected = *heat_matrix<Complex>(
      [&](const Task& task) { return connection_laplacian(*T, task); }, M, t, {});
  const SpMatC found = lower_triangle(*heat_rows(connection_rows(T), M, t), {});
  EXPECT_LE(Eigen::MatrixXcd(found - expected).cwiseAbs().maxCoeff(), 1e-15);
  EXPECT_NEAR(expected.coeff(0, 0).real(), 1 + t * connection_laplacian(*T, {}).coeff(0, 0).real(),
              1e-15);
}

TEST(IntrinsicTriangulation, SharesItsCornersWithAMeshAndHasItsOwnWhereFacesAreLeftOut) {
  PolygonSoup soup = test::grid_soup(3, 2);
  const SurfaceMesh whole(soup);
  Report report;
  const IntrinsicTriangulation T = intrinsic_triangulation(whole, report);
  EXPECT_EQ(T.faces.matrix().data(), whole.soup().corners.data());
  EXPECT_EQ(T.edges.matrix().data(), whole.edges().data());

  const int left_out = whole.n_faces();
  test::add_triangle(soup, 0, 0, 1);  // repeats a vertex
  test::add_triangle(soup, 2, 1, 5);
  const SurfaceMesh mesh(soup);
  const IntrinsicTriangulation fewer = intrinsic_triangulation(mesh, report);
  ASSERT_EQ(fewer.n_faces(), mesh.n_faces() - 1);
  for (int f = 0; f < mesh.n_faces(); ++f) {
    if (f == left_out) continue;
    const int t = fewer.triangle_of_face[f];
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(fewer.faces(t, k), mesh.face(f)[k]);
      EXPECT_EQ(fewer.side_edge(t, k), mesh.side_edge(f, k));
    }
  }
}

TEST(ConnectionRows, CoupleEdgesByTheCotangentsBetweenThem) {
  // Where these are negative the entry is a turn the other way.
  for (const SurfaceMesh& mesh : {SurfaceMesh(test::grid_soup(5, 4)), with_a_book(7)}) {
    Report report;
    auto T = std::make_shared<IntrinsicTriangulation>(intrinsic_triangulation(mesh, report));
    T->seams.resize(0, 3);
    const VecX M = VecX::Ones(T->n_edges());
    const double t = 0.3;
    const auto rows = heat_rows(connection_rows(T), M, t);
    MatX expected = MatX::Zero(T->n_edges(), T->n_edges()), found = expected;
    for (int f = 0; f < T->n_faces(); ++f)
      for (int k = 0; k < 3; ++k) {
        const int i = T->side_edge(f, k), j = T->side_edge(f, (k + 1) % 3);
        const double w = 2 * t * T->shape(f).cot[(k + 1) % 3];
        expected(i, j) += w;
        expected(j, i) += w;
      }
    std::vector<Coupled> beside;
    for (int i = 0; i < rows->size(); ++i) {
      rows->couplings(i, beside);
      for (const auto& [j, w] : beside) found(i, j) += w;
    }
    EXPECT_LE((found - expected).cwiseAbs().maxCoeff(), 1e-13);
    EXPECT_GT(expected.maxCoeff(), 0.1);
  }
}

TEST(HermitianRows, CouplingsAreTheSizesOfTurns) {
  // Blocks of two: 3 times a turn between the first two, nothing between the others.
  const Eigen::Matrix2d turn = -3 * Eigen::Rotation2Dd(0.7).matrix();
  Triplets entries;
  for (int k = 0; k < 6; ++k) entries.emplace_back(k, k, 5);
  for (int r = 0; r < 2; ++r)
    for (int c = 0; c < 2; ++c) entries.emplace_back(2 + r, c, turn(r, c));
  SpMat A(6, 6);
  A.setFromTriplets(entries.begin(), entries.end());
  const auto rows = rows_of(std::make_shared<const SpMat>(A), 2);
  std::vector<Coupled> beside;
  for (const int i : {0, 1}) {
    rows->couplings(i, beside);
    ASSERT_EQ(beside.size(), 1U);
    EXPECT_EQ(beside[0].block, 1 - i);
    EXPECT_NEAR(beside[0].w, 3, 1e-14);
  }
  rows->couplings(2, beside);
  EXPECT_TRUE(beside.empty());
}

TEST(HermitianRows, LowerTriangleCanBeStopped) {
  SpMat identity(3, 3);
  identity.setIdentity();
  const CancelToken stop;
  stop.cancel();
  const auto rows = rows_of<double>(std::make_shared<const SpMat>(identity), 1);
  EXPECT_THROW(lower_triangle(*rows, Task(stop)), Cancelled);
}

}  // namespace
}  // namespace littoral
