// Which way round the faces of a mesh lie.

#include "domain/mesh/face_orientation.h"

#include <gtest/gtest.h>

#include <utility>

#include "test_meshes.h"

namespace littoral {
namespace {

TEST(FaceOrientation, AFlippedFaceFollowsTheOthersAndTheAnswerIsKept) {
  PolygonSoup soup = test::octasphere_soup(2);
  const int flipped = 5;
  std::swap(soup.corners[3 * flipped], soup.corners[3 * flipped + 1]);
  const SurfaceMesh mesh(soup);
  const SurfaceMesh other = mesh;  // a copy shares it
  const FaceOrientation& found = face_orientation(mesh);
  EXPECT_EQ(found.flipped, 1);
  EXPECT_TRUE(found.orientable);
  for (int f = 0; f < mesh.n_faces(); ++f) EXPECT_EQ(found.sign[f], f == flipped ? -1 : 1);
  EXPECT_EQ(&face_orientation(mesh), &found);  // every solve with a curve asks
  EXPECT_EQ(&face_orientation(other), &found);
}

TEST(FaceOrientation, TheScaleOfAMeshIsAPowerOfTwo) {
  PolygonSoup soup = test::octasphere_soup(1);  // coordinates up to 1
  EXPECT_EQ(SurfaceMesh(soup).scale(), 1);
  soup.points *= 13;
  EXPECT_EQ(SurfaceMesh(soup).scale(), 8);
  soup.points *= 0;
  EXPECT_EQ(SurfaceMesh(soup).scale(), 1);
}

}  // namespace
}  // namespace littoral
