// Space: signed distance at points and on grids, volumes, isosurfaces, offsets.

#include <algorithm>

#include "base/index.h"
#include "desk/call.h"

namespace littoral::desk {

namespace {

Vec3 triple_of(const Call& call, const json& array) {
  const std::vector<double> x = call.doubles(array);
  if (x.size() != 3)
    throw InputError("expected three numbers, there are " + std::to_string(x.size()));
  return {x[0], x[1], x[2]};
}

json triple_out(const Vec3& v) { return {v[0], v[1], v[2]}; }

Grid grid_of(const Call& call, const json& grid) {
  const Vec3 n = triple_of(call, grid.at("n"));
  Grid out{{0, 0, 0}, triple_of(call, grid.at("origin")), triple_of(call, grid.at("spacing"))};
  for (int a = 0; a < 3; ++a) {
    if (!(n[a] >= 1 && n[a] <= 1e6) || n[a] != std::floor(n[a]))
      throw InputError("a grid has 1 to 1000000 nodes along each axis");
    if (!(out.spacing[a] > 0) || !std::isfinite(out.spacing[a]) || !std::isfinite(out.origin[a]))
      throw InputError("a grid's origin must be finite and its spacing positive");
    out.n[a] = static_cast<int>(n[a]);
  }
  if (n.prod() > 1 << 30)  // counted in 32 bits
    throw IoError("a grid of " + std::to_string(n.prod()) + " nodes does not fit into memory",
                  "too-large");
  return out;
}

Grid grid_around(const Call& call, const Sdf& sdf, const json& options) {
  if (options.contains("n")) return grid_of(call, options);
  GridOptions out;
  const auto given = [&](const char* name) {
    return options.contains(name) && !options[name].is_null();
  };
  if (given("resolution")) {
    const double nodes = Call::number_of(options["resolution"]);
    if (!(nodes >= 1 && nodes <= 1e6)) throw InputError("resolution is 1 to 1000000 nodes");
    out.resolution = static_cast<int>(nodes);
  }
  if (given("spacing")) out.spacing = Call::number_of(options["spacing"]);
  if (given("padding")) out.padding = Call::number_of(options["padding"]);
  if (given("bounds")) {
    const std::vector<double> box = call.doubles(options["bounds"]);
    if (box.size() != 6) throw InputError("bounds are six numbers, x0 y0 z0 x1 y1 z1");
    out.bounds.emplace();
    std::copy(box.begin(), box.end(), out.bounds->begin());
  }
  return Grid::around(sdf, out);
}

/// The nodes of a flat grid in space; i runs fastest.
MatX3 slice_nodes(const Call& call, const json& slice) {
  const Vec3 origin = triple_of(call, slice.at("origin")), u = triple_of(call, slice.at("u")),
             v = triple_of(call, slice.at("v"));
  const std::vector<double> n = call.doubles(slice.at("n"));
  for (const double count : n)
    if (!(count >= 1 && count <= 20000) || count != std::floor(count))
      throw InputError("a slice has 1 to 20000 points along each side");
  if (n.size() != 2) throw InputError("a slice has two sides");
  const auto across = index(n[0]), down = index(n[1]);
  const auto part = [](Eigen::Index i, Eigen::Index count) {
    return count > 1 ? static_cast<double>(i) / static_cast<double>(count - 1) : 0;
  };
  MatX3 out(across * down, 3);
  for (Eigen::Index j = 0; j < down; ++j)
    for (Eigen::Index i = 0; i < across; ++i)
      out.row(j * across + i) = origin + part(i, across) * u + part(j, down) * v;
  return out;
}

json made_sdf(Call& call, Sdf made) {
  const Sdf& sdf = call.make(std::move(made));
  const auto box = sdf.bounds();
  return {{"report", report_json(sdf.report())},
          {"bounds", {box(0, 0), box(0, 1), box(0, 2), box(1, 0), box(1, 1), box(1, 2)}}};
}

json made_volume(Call& call, Volume made) {
  const Grid& grid = call.make(std::move(made)).grid;
  return {
      {"n", grid.n}, {"origin", triple_out(grid.origin)}, {"spacing", triple_out(grid.spacing)}};
}

json distance_around(Call& call) {
  return made_sdf(call, signed_distance(call.object<Mesh>(0), call.method(1, 2),
                                        {call.flag(3), call.flag(4)}, call.context()));
}

json sdf_at(Call& call) {
  return call.put(call.object<Sdf>(0).at(call.points(call[1]), call.context()));
}

json sdf_slice(Call& call) {
  return call.put(call.object<Sdf>(0).at(slice_nodes(call, call[1]), call.context()));
}

json sdf_gradients(Call& call) {
  const DistanceSamples samples =
      call.object<Sdf>(0).with_gradients(call.points(call[1]), call.context());
  return {{"values", call.put(samples.values)}, {"gradients", call.put(samples.gradients)}};
}

json sdf_closest(Call& call) {
  const NearestPoints near = call.object<Sdf>(0).closest(call.points(call[1]), call.context());
  return {{"positions", call.put(near.points)},
          {"elements", call.put(near.elements)},
          {"corners", call.put(near.corners)},
          {"barycentric", call.put(near.barycentric)},
          {"distances", call.put(near.distances)}};
}

json sdf_winding(Call& call) {
  return call.put(call.object<Sdf>(0).winding_number(call.points(call[1]), call.context()));
}

json sdf_confidence(Call& call) {
  return call.put(call.object<Sdf>(0).confidence(call.points(call[1]), call.context()));
}

json sampled(Call& call) {
  const Sdf& sdf = call.object<Sdf>(0);
  return made_volume(call, sdf.sample(grid_around(call, sdf, call[1]), call.context()));
}

json load_volume(Call& call) {
  json out;
  with_file(call, [&](const auto& path) { out = made_volume(call, read_volume(path)); });
  return out;
}

json volume_of_arrays(Call& call) {
  const std::vector<double> numbers = call.doubles(call[1]);
  Volume out{grid_of(call, call[0]), Eigen::Map<const VecX>(numbers.data(), std::ssize(numbers)),
             "distance"};
  if (out.grid.n_nodes() != numbers.size())
    throw InputError("there are " + std::to_string(numbers.size()) + " values for " +
                     std::to_string(out.grid.n_nodes()) + " nodes");
  return made_volume(call, std::move(out));
}

json volume_values(Call& call) { return call.put(call.object<Volume>(0).values); }

json interpolated(Call& call, const MatX3& x) {
  const auto& volume = call.object<Volume>(0);
  const auto& n = volume.grid.n;
  if (n[0] < 2 || n[1] < 2 || n[2] < 2)
    throw InputError("between nodes there is nothing along an axis of one");
  VecX out(x.rows());
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    const Vec3 at = (x.row(i).transpose() - volume.grid.origin).cwiseQuotient(volume.grid.spacing);
    const Vec3 last(n[0] - 1, n[1] - 1, n[2] - 1);
    const bool inside = (at.array() >= 0).all() && (at.array() <= last.array()).all();
    out[i] = inside ? interpolate(volume, at) : std::numeric_limits<double>::quiet_NaN();
  }
  return call.put(out);
}

json volume_at(Call& call) { return interpolated(call, call.points(call[1])); }
json volume_slice(Call& call) { return interpolated(call, slice_nodes(call, call[1])); }

json isosurface_of(Call& call) {
  return made_surface(
      call, isosurface(call.object<Volume>(0), call.number(1), call.flag(2), call.context()));
}

json volume_offsets(Call& call) {
  json out = json::array();
  for (Mesh& mesh : offset(call.object<Volume>(0), call.doubles(call[1]),
                           {call.number(2), call.number(3)}, call.context()))
    out.push_back(made_surface(call, std::move(mesh)));
  return out;
}

json distance_to_volume(Call& call) {
  const std::vector<std::string> names{"automatic", "distance", "mask", "density"};
  const std::string meaning = call.text(1);
  const auto found = std::find(names.begin(), names.end(), meaning);
  if (found == names.end())
    throw InputError("a volume's values are automatic, distance, mask or density, not '" + meaning +
                     "'");
  std::optional<double> at;
  if (!call[2].is_null()) at = call.number(2);
  return made_sdf(
      call, signed_distance(call.object<Volume>(0),
                            static_cast<VolumeMeaning>(found - names.begin()), at, call.context()));
}

json write_volume(Call& call) {
  return written(call, call.text(1),
                 [&](const auto& path) { write(call.object<Volume>(0), path); });
}

}  // namespace

void add_space_operations(Operations& operations) {
  operations.merge(Operations{{"signedDistance", distance_around},
                              {"sdfAt", sdf_at},
                              {"sdfSlice", sdf_slice},
                              {"sdfGradients", sdf_gradients},
                              {"sdfClosest", sdf_closest},
                              {"sdfWinding", sdf_winding},
                              {"sdfConfidence", sdf_confidence},
                              {"sample", sampled},
                              {"loadVolume", load_volume},
                              {"makeVolume", volume_of_arrays},
                              {"volumeValues", volume_values},
                              {"volumeAt", volume_at},
                              {"volumeSlice", volume_slice},
                              {"isosurface", isosurface_of},
                              {"volumeOffsets", volume_offsets},
                              {"volumeDistance", distance_to_volume},
                              {"writeVolume", write_volume}});
}

}  // namespace littoral::desk
