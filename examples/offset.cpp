// Signed distance around a model, queries, an offset of it, and a shape made of two.
// Takes a mesh file and a folder to write to.

#include <littoral/littoral.h>

#include <filesystem>
#include <iostream>

using namespace littoral;

int main(int argc, char** argv) {
  if (argc < 3) return std::cerr << "usage: offset MESH FOLDER\n", 2;
  const std::filesystem::path out = argv[2];
  const PolygonSoup model = read_soup(argv[1]);

  const Sdf f = signed_distance(model);
  const Vec3 centre = f.bounds().colwise().mean();
  std::cout << "distance at the middle of the box: " << f(centre) << ", growing along "
            << f.gradient(centre).transpose() << "\n";

  const Volume v = f.sample(Grid::around(f, {.resolution = 48}));
  const double size = (f.bounds().row(1) - f.bounds().row(0)).maxCoeff();
  const Mesh shell = isosurface(v, 0.02 * size);
  write(shell, out / "shell.ply");
  std::cout << "a shell of " << shell.n_faces() << " triangles\n";

  // The model without a copy of itself, moved; corners rounded.
  PolygonSoup moved = model;
  moved.points.col(0).array() += 0.3 * size;
  const Sdf difference = subtract(f, signed_distance(moved), 0.02 * size);
  write(isosurface(difference.sample(Grid::around(difference, {.resolution = 48}))),
        out / "difference.ply");

  // Signed heat closes gaps, on a grid; with progress, and a limit on memory.
  Context context;
  context.progress = [last = -1](double fraction, const std::string& stage) mutable {
    const int tenth = static_cast<int>(10 * fraction);
    if (tenth > last) std::cout << 10 * (last = tenth) << " % " << stage << "\n";
  };
  context.memory_limit = 2e9;
  const Sdf heat = signed_distance(model, SpaceSignedHeat{});
  const Volume smooth = heat.sample(Grid::around(model, {.resolution = 32}), context);
  write(smooth, out / "distance.nrrd");
}
