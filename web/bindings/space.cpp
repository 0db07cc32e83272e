// Space: signed distance at points and on grids, volumes, isosurfaces, offsets.

#include "bindings.h"

namespace littoral::web {

namespace {

Vec3 triple_of(const val& array) {
  const std::vector<double> x = numbers_of<double>(array);
  if (x.size() != 3)
    throw InputError("expected three numbers, there are " + std::to_string(x.size()));
  return {x[0], x[1], x[2]};
}

Grid grid_of(const val& grid) {
  const Vec3 n = triple_of(grid["n"]);
  Grid out{{0, 0, 0}, triple_of(grid["origin"]), triple_of(grid["spacing"])};
  for (int a = 0; a < 3; ++a) {
    if (!(n[a] >= 1 && n[a] <= 1e6) || n[a] != std::floor(n[a]))
      throw InputError("a grid has 1 to 1000000 nodes along each axis");
    if (!(out.spacing[a] > 0) || !std::isfinite(out.spacing[a]) || !std::isfinite(out.origin[a]))
      throw InputError("a grid's origin must be finite and its spacing positive");
    out.n[static_cast<std::size_t>(a)] = static_cast<int>(n[a]);
  }
  if (n.prod() > 1 << 30)  // counted in 32 bits
    throw IoError("a grid of " + std::to_string(n.prod()) + " nodes does not fit into memory");
  return out;
}

val grid_out(const Grid& grid) {
  val out = val::object();
  out.set("n", val::array(std::vector<int>(grid.n.begin(), grid.n.end())));
  out.set("origin", val::array(std::vector<double>(grid.origin.begin(), grid.origin.end())));
  out.set("spacing", val::array(std::vector<double>(grid.spacing.begin(), grid.spacing.end())));
  return out;
}

Grid grid_around(const Sdf& sdf, const val& options) {
  if (options.hasOwnProperty("n")) return grid_of(options);
  GridOptions out;
  const auto given = [&](const char* name) { return !options[name].isUndefined(); };
  if (given("resolution")) out.resolution = options["resolution"].as<int>();
  if (given("spacing")) out.spacing = options["spacing"].as<double>();
  if (given("padding")) out.padding = options["padding"].as<double>();
  if (given("bounds")) {
    const std::vector<double> box = numbers_of<double>(options["bounds"]);
    if (box.size() != 6) throw InputError("bounds are six numbers, x0 y0 z0 x1 y1 z1");
    out.bounds.emplace();
    std::copy(box.begin(), box.end(), out.bounds->begin());
  }
  return Grid::around(sdf, out);
}

val distance_around(const Mesh& mesh, const std::string& method, const val& options, bool flip,
                    bool estimate_normals, const val& progress) {
  return answered([&] {
    return val(signed_distance(mesh, method_of(method, options), {flip, estimate_normals},
                               context_of(progress)));
  });
}

val about_sdf(const Sdf& sdf) {
  return answered([&] {
    val out = val::object();
    const auto box = sdf.bounds();
    out.set("report", report_json(sdf.report()));
    out.set("bounds", val::array(std::vector<double>{box(0, 0), box(0, 1), box(0, 2), box(1, 0),
                                                     box(1, 1), box(1, 2)}));
    return out;
  });
}

val sdf_at(const Sdf& sdf, const val& points, const val& progress) {
  return answered([&] { return array_of(sdf.at(points_of(points), context_of(progress))); });
}

val sdf_gradients(const Sdf& sdf, const val& points, const val& progress) {
  return answered([&] {
    const DistanceSamples samples = sdf.with_gradients(points_of(points), context_of(progress));
    val out = val::object();
    out.set("values", array_of(samples.values));
    out.set("gradients", array_of(samples.gradients));
    return out;
  });
}

val sdf_closest(const Sdf& sdf, const val& points, const val& progress) {
  return answered([&] {
    const NearestPoints near = sdf.closest(points_of(points), context_of(progress));
    val out = val::object();
    out.set("positions", array_of(near.points));
    out.set("elements", array_of(near.elements));
    out.set("corners", array_of(near.corners));
    out.set("barycentric", array_of(near.barycentric));
    out.set("distances", array_of(near.distances));
    return out;
  });
}

val sdf_winding(const Sdf& sdf, const val& points, const val& progress) {
  return answered(
      [&] { return array_of(sdf.winding_number(points_of(points), context_of(progress))); });
}

val sdf_confidence(const Sdf& sdf, const val& points, const val& progress) {
  return answered(
      [&] { return array_of(sdf.confidence(points_of(points), context_of(progress))); });
}

val sampled(const Sdf& sdf, const val& options, const val& progress) {
  return answered([&] { return val(sdf.sample(grid_around(sdf, options), context_of(progress))); });
}

val read_volume_file(const std::string& path) {
  return answered([&] { return val(read_volume(path)); });
}

val volume_of(const val& grid, const val& values) {
  return answered([&] {
    const std::vector<double> numbers = numbers_of<double>(values);
    Volume out{grid_of(grid), Eigen::Map<const VecX>(numbers.data(), std::ssize(numbers)),
               "distance"};
    if (out.grid.n_nodes() != numbers.size())
      throw InputError("there are " + std::to_string(numbers.size()) + " values for " +
                       std::to_string(out.grid.n_nodes()) + " nodes");
    return val(std::move(out));
  });
}

val volume_values(const Volume& volume) {
  return answered([&] { return array_of(volume.values); });
}

val volume_grid(const Volume& volume) {
  return answered([&] { return grid_out(volume.grid); });
}

val volume_at(const Volume& volume, const val& points) {
  return answered([&] {
    const MatX3 x = points_of(points);
    const auto& n = volume.grid.n;
    if (n[0] < 2 || n[1] < 2 || n[2] < 2)
      throw InputError("between nodes there is nothing along an axis of one");
    VecX out(x.rows());
    for (Eigen::Index i = 0; i < x.rows(); ++i) {
      const Vec3 at =
          (x.row(i).transpose() - volume.grid.origin).cwiseQuotient(volume.grid.spacing);
      const Vec3 last(n[0] - 1, n[1] - 1, n[2] - 1);
      const bool inside = (at.array() >= 0).all() && (at.array() <= last.array()).all();
      out[i] = inside ? interpolate(volume, at) : std::numeric_limits<double>::quiet_NaN();
    }
    return array_of(out);
  });
}

val isosurface_of(const Volume& volume, double level, bool close_at_box, const val& progress) {
  return answered(
      [&] { return val(isosurface(volume, level, close_at_box, context_of(progress))); });
}

val volume_offsets(const Volume& volume, const val& distances, double open, double close,
                   const val& progress) {
  return answered([&] {
    val out = val::array();
    for (const Mesh& mesh :
         offset(volume, numbers_of<double>(distances), {open, close}, context_of(progress)))
      out.call<void>("push", val(mesh));
    return out;
  });
}

val distance_to_volume(const Volume& volume, const std::string& meaning, const val& threshold,
                       const val& progress) {
  return answered([&] {
    const std::vector<std::string> names{"automatic", "distance", "mask", "density"};
    const auto found = std::find(names.begin(), names.end(), meaning);
    if (found == names.end())
      throw InputError("a volume's values are automatic, distance, mask or density, not '" +
                       meaning + "'");
    std::optional<double> at;
    if (!threshold.isUndefined()) at = threshold.as<double>();
    return val(signed_distance(volume, static_cast<VolumeMeaning>(found - names.begin()), at,
                               context_of(progress)));
  });
}

val write_volume_file(const Volume& volume, const std::string& path) {
  return answered([&] {
    write(volume, path);
    return val::undefined();
  });
}

}  // namespace

}  // namespace littoral::web

EMSCRIPTEN_BINDINGS(littoral_space) {
  using namespace littoral::web;  // NOLINT: the module's only scope
  emscripten::class_<littoral::Sdf>("Sdf");
  emscripten::class_<littoral::Volume>("Volume");
  emscripten::function("signedDistance", distance_around);
  emscripten::function("aboutSdf", about_sdf);
  emscripten::function("sdfAt", sdf_at);
  emscripten::function("sdfGradients", sdf_gradients);
  emscripten::function("sdfClosest", sdf_closest);
  emscripten::function("sdfWinding", sdf_winding);
  emscripten::function("sdfConfidence", sdf_confidence);
  emscripten::function("sampled", sampled);
  emscripten::function("readVolume", read_volume_file);
  emscripten::function("madeVolume", volume_of);
  emscripten::function("volumeValues", volume_values);
  emscripten::function("volumeGrid", volume_grid);
  emscripten::function("volumeAt", volume_at);
  emscripten::function("isosurface", isosurface_of);
  emscripten::function("volumeOffsets", volume_offsets);
  emscripten::function("volumeDistance", distance_to_volume);
  emscripten::function("writeVolume", write_volume_file);
}
