// What CGAL's packages are asked, asked here: of a mesh that may be broken, without a traits class.

#include <littoral/littoral.h>

#include <iostream>

int main(int argc, char** argv) {
  using namespace littoral;
  if (argc != 3) {
    std::cerr << "usage: from_cgal MESH RESULT\n";
    return 2;
  }
  try {
    const PolygonSoup soup = read_soup(argv[1]);
    const Mesh mesh(soup);
    const Sources source(SurfacePoint::at_vertex(7));
    const Vec3 x(0.1, 0.2, 0.3);
    MatX3 X(1, 3);
    X << x.transpose();

    const Field heat = distance(mesh, source, UnsignedHeat{});
    const Field exact = distance(mesh, source, Exact{});

    const Sdf sdf = signed_distance(soup);
    const bool inside = sdf(x) < 0;
    const NearestPoints nearest = sdf.closest(X);
    const VecX turns = sdf.winding_number(X);

    const Volume volume = sdf.sample(Grid::around(sdf, {.resolution = 48}));
    const Mesh shell = offset(volume, {0.05}).front();
    const Repaired closed = repair(soup);

    std::cout << "heat " << heat.values.maxCoeff() << ", exact " << exact.values.maxCoeff() << "\n"
              << (inside ? "inside" : "outside") << ", nearest face " << nearest.elements[0]
              << ", winding number " << turns[0] << "\n"
              << "shell of " << shell.n_faces() << " faces, closed surface of "
              << closed.surface.n_faces() << "\n";
    write(closed.surface, argv[2]);
  } catch (const Error& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}
