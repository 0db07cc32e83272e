// Samples as arrays, and their card.

#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>

#include "api/report_json.h"
#include "io/binary.h"
#include "io/write.h"
#include "io/write_arrays.h"
#include "littoral/error.h"
#include "littoral/samples.h"

namespace littoral {

namespace {

using Json = nlohmann::ordered_json;

const char* name_of(SampleNumbers numbers) {
  return numbers == SampleNumbers::float16   ? "float16"
         : numbers == SampleNumbers::float32 ? "float32"
                                             : "float64";
}

std::string type_of(SampleNumbers numbers) {
  return numbers == SampleNumbers::float16   ? "<f2"
         : numbers == SampleNumbers::float32 ? "<f4"
                                             : "<f8";
}

/// Rows of numbers, or one axis for a vector.
template <class Numbers>
io::NamedArray array_of(std::string name, const Numbers& values, SampleNumbers numbers) {
  io::NamedArray array{std::move(name), type_of(numbers), {std::size_t(values.rows())}, {}};
  if (values.cols() > 1) array.shape.push_back(std::size_t(values.cols()));
  std::ostringstream out;
  for (Eigen::Index r = 0; r < values.rows(); ++r)
    for (Eigen::Index c = 0; c < values.cols(); ++c) {
      const double x = values(r, c);
      if (numbers == SampleNumbers::float16)
        io::store_little(
            out, Eigen::numext::bit_cast<std::uint16_t>(Eigen::half(static_cast<float>(x))));
      else if (numbers == SampleNumbers::float32)
        io::store_little(out, static_cast<float>(x));
      else
        io::store_little(out, x);
    }
  array.bytes = out.str();
  return array;
}

io::NamedArray bytes_of(std::string name, std::string bytes) {
  const std::size_t n = bytes.size();
  return {std::move(name), "|u1", {n}, std::move(bytes)};
}

std::string as_bytes(const std::vector<SampleKind>& kinds) {
  std::string bytes;
  for (const SampleKind kind : kinds) bytes += static_cast<char>(kind);
  return bytes;
}

std::string occupancy(const VecX& distances) {
  std::string bytes;
  for (const double d : distances) bytes += static_cast<char>(d <= 0 ? 1 : 0);
  return bytes;
}

}  // namespace

std::string samples_card(const Samples& samples, const std::string& input) {
  const SampleOptions& options = samples.options;
  Json card;
  card["schema"] = "littoral-samples-1";
  card["version"] = LITTORAL_VERSION;
  card["input"] = input;
  card["normalisation"] = {
      {"centre", {samples.centre[0], samples.centre[1], samples.centre[2]}},
      {"half_side", samples.half_side},
      {"about", "x of the input is at (x - centre) / half_side, in the cube from -1 to 1"}};
  card["options"] = {{"resolution", options.resolution},
                     {"surface", options.surface},
                     {"space", options.space},
                     {"sharp", options.sharp},
                     {"uniform", options.uniform},
                     {"curvature", options.curvature},
                     {"scales", options.scales},
                     {"margin", options.margin},
                     {"seed", options.seed},
                     {"numbers", name_of(options.numbers)}};
  card["kinds"] = {{"0", "uniform"}, {"1", "sharp"}, {"2", "near"}, {"3", "curvature"}};
  card["random_numbers"] = "Philox 4x32-10";
  card["report"] = Json::parse(report_json(samples.report));
  card["report"].erase("timings");  // so that the same samples have the same card
  card["report"].erase("peak_memory_mb");
  return card.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::filesystem::path card_beside(const std::filesystem::path& samples) {
  return std::filesystem::path(samples).replace_extension(".json");
}

void write(const Samples& samples, const std::filesystem::path& path, const std::string& input) {
  const SampleNumbers numbers = samples.options.numbers;
  const std::string card = samples_card(samples, input);
  const PolygonSoup& surface = samples.surface;
  std::ostringstream corners;
  io::store_all_little(corners, surface.corners);  // of four bytes
  io::NamedArray faces{"faces", "<i4", {surface.corners.size() / 3, 3}, corners.str()};
  VecX frame(4);
  frame << samples.centre, samples.half_side;
  io::write_arrays(path,
                   {array_of("points", samples.points, numbers),
                    array_of("distances", samples.distances, numbers),
                    bytes_of("occupancy", occupancy(samples.distances)),
                    array_of("confidence", samples.confidence, numbers),
                    bytes_of("kinds", as_bytes(samples.kinds)),
                    array_of("deviations", samples.deviations, numbers),
                    array_of("surface_points", samples.surface_points, numbers),
                    array_of("surface_normals", samples.surface_normals, numbers),
                    array_of("surface_confidence", samples.surface_confidence, numbers),
                    bytes_of("surface_kinds", as_bytes(samples.surface_kinds)),
                    array_of("vertices", surface.points, SampleNumbers::float32), std::move(faces),
                    array_of("normalisation", frame, SampleNumbers::float64)},
                   card);
  io::write_atomically(card_beside(path), [&](std::ostream& out) { out << card; });
}

}  // namespace littoral
