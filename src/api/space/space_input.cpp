#include "api/space/space_input.h"

#include <string>
#include <utility>

#include "api/space/tori_cloud.h"
#include "base/option_table.h"
#include "base/platform/memory.h"
#include "base/stopwatch.h"
#include "domain/cloud/cloud_normals.h"
#include "littoral/error.h"
#include "sources/space/tet_source_values.h"
#include "spatial/triangulate.h"

namespace littoral {

namespace {

// While a grid is computed: directions, bookkeeping and right-hand side; then a few vectors.
constexpr double bytes_per_node = 48;

/// The other side is positive.
void flip(Torus& t) {
  t.n = -t.n;
  t.k1 = -t.k1;
  t.k2 = -t.k2;
}

std::string grid_text(const Grid& grid) {
  return "a grid of " + std::to_string(grid.n[0]) + " x " + std::to_string(grid.n[1]) + " x " +
         std::to_string(grid.n[2]) + " nodes";
}

std::string place_text(const Vec3& p) {
  return "(" + rounded_text(p[0]) + ", " + rounded_text(p[1]) + ", " + rounded_text(p[2]) + ")";
}

}  // namespace

std::string box_text(const Box& box) { return place_text(box.low) + " to " + place_text(box.high); }

Box bounding_box(const PolygonSoup& input) {
  Box box;
  const auto add = [&](int v) {
    if (!input.points.row(v).allFinite())
      throw InputError("vertex " + std::to_string(v) + " has coordinates that are not finite",
                       "not-finite");
    box.add(input.points.row(v));
  };
  if (input.n_faces() > 0)
    for (int v : input.corners) add(v);
  else
    for (int v = 0; v < input.n_vertices(); ++v) add(v);
  if (!(box.size().minCoeff() >= 0))
    throw InputError("the input has no faces and no points", "empty-input");
  if (!box.size().allFinite())
    throw InputError("the input is too large for double precision", "too-large");
  return box;
}

MatX3i SpaceInput::triangles() const { return triangles_of(surface); }

SpaceInput make_input(const SpaceSources& sources, const Frame& frame, double max_side, Task& task,
                      Report& report) {
  const Stopwatch watch(report, "sources");
  const PolygonSoup& soup = sources.soup;
  SpaceInput input;
  input.flipped = sources.flip;
  PolygonSoup& surface = input.surface;
  surface.points = frame.local(soup.points);
  if (soup.n_faces() > 0) {
    surface.face_offsets = soup.face_offsets;
    surface.corners = soup.corners;
    surface = triangulate(surface);
    if (sources.flip)
      for (int f = 0; f < surface.n_faces(); ++f)
        std::swap(surface.corners[3 * f], surface.corners[3 * f + 1]);
    input.samples = sample_faces(surface, max_side, report, SamplesPerTriangle::one, task);
    report.sizes.emplace_back("faces", surface.n_faces());
  } else {
    surface.normals = sources.estimate_normals
                          ? estimate_normals(surface.points, task.stage(0.05, "normals"))
                          : soup.normals;
    if (sources.flip) surface.normals = -surface.normals;
    if (surface.normals.rows() == 0)
      throw InputError(
          "the input has no faces, and its points have no normals; option estimate-normals "
          "computes some",
          "no-normals");
    if (has_tori(soup) && !sources.estimate_normals) {
      for (const Torus& t : tori_of_cloud(soup)) input.tori.push_back(frame.local(t));
      if (sources.flip)
        for (Torus& t : input.tori) flip(t);
    }
    input.samples = sample_cloud(surface, report);
    report.sizes.emplace_back("points", surface.n_vertices());
  }
  if (!sources.values.empty()) {
    const std::vector<double> each = frame.local(sources.values);
    input.values = input.is_cloud() ? each : values_of_triangles(soup, each);
    input.sample_values = values_of_samples(surface, input.samples, input.values);
  }
  report.sizes.emplace_back("samples", static_cast<double>(input.samples.size()));
  task.checkpoint();
  return input;
}

void check_grid(const Grid& grid) {
  for (int n : grid.n)
    if (n < 2) throw InputError("a grid needs two nodes along each axis at least");
  if (!grid.origin.allFinite() || !grid.spacing.allFinite() || !(grid.spacing.minCoeff() > 0))
    throw InputError("the grid's box must be finite and its spacings positive", "option-value");
  const double nodes = double(grid.n[0]) * grid.n[1] * grid.n[2];
  if (nodes > std::numeric_limits<int>::max())
    throw InputError(grid_text(grid) + " is too large; lower option resolution", "too-large");
  check_memory(bytes_per_node * nodes, grid_text(grid), "lower option resolution");
}

Box box_on_grid(const PolygonSoup& input, const Grid& grid) {
  check_grid(grid);
  Box box = bounding_box(input);
  const Vec3 far = grid.point(grid.n[0] - 1, grid.n[1] - 1, grid.n[2] - 1);
  if ((grid.origin.array() > box.high.array()).any() || (far.array() < box.low.array()).any())
    throw InputError("the box of the grid misses the input, which fills " + box_text(box),
                     "nothing-there");
  return box;
}

}  // namespace littoral
