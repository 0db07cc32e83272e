// Distance along a point cloud, and in the space around it, without meshing it.

#include <littoral/littoral.h>

#include <cmath>
#include <iostream>

using namespace littoral;

int main() {
  // Points spread evenly over the unit sphere, with normals.
  const int n = 2000;
  MatX3 P(n, 3);
  for (int i = 0; i < n; ++i) {
    const double z = 1 - (2 * i + 1.0) / n, angle = i * 2.399963229728653;
    P.row(i) << std::sqrt(1 - z * z) * std::cos(angle), std::sqrt(1 - z * z) * std::sin(angle), z;
  }
  const Mesh cloud = Mesh::cloud(P, P);

  const Field d = distance(cloud, Sources(SurfacePoint::at_vertex(0)), UnsignedHeat{});
  std::cout << "from pole to pole along the points: " << d.values[n - 1] << "\n";

  const Sdf f = signed_distance(cloud);  // by tori
  std::cout << "distance at (2, 0, 0): " << f(Vec3(2, 0, 0)) << ", at the centre "
            << f(Vec3::Zero()) << "\n";
}
