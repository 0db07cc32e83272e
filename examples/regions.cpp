// Distance from curves with gaps, the regions that they bound, and pictures of both.
// Takes a mesh file, a file of curves, and a folder to write to.

#include <littoral/littoral.h>

#include <filesystem>
#include <iostream>

using namespace littoral;

int main(int argc, char** argv) {
  if (argc < 4) return std::cerr << "usage: regions MESH CURVES FOLDER\n", 2;
  const std::filesystem::path out = argv[3];
  const Mesh mesh = read_mesh(argv[1]);
  const Sources curves = read_sources(argv[2], mesh);

  const Field d = distance(mesh, curves);
  write(d, out / "distance.ply");
  write_picture(d, out / "distance.png");
  std::cout << "signed distance from " << d.values.minCoeff() << " to " << d.values.maxCoeff()
            << ", " << d.isolines(0).size() << " lines of distance 0\n";

  const Regions r = winding(mesh, curves);
  write(r, out / "regions.txt");
  std::cout << "regions " << r.region.minCoeff() << " to " << r.region.maxCoeff() << ", "
            << r.bounding.size() << " bounding and " << r.nonbounding.size()
            << " nonbounding curves\n";
}
