#pragma once
// Samples of a shape for learning: points on its surface and in space, with distances.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "littoral/context.h"
#include "littoral/methods.h"
#include "littoral/polygon_soup.h"
#include "littoral/report.h"
#include "littoral/space.h"
#include "littoral/types.h"

namespace littoral {

/// How positions and distances are stored. Distances are those of the positions as stored.
enum class SampleNumbers { float16, float32, float64 };

/// What is sampled, and how often. Lengths are in half sides of the cube.
struct SampleOptions {
  int resolution = 64;      // nodes along a side of the cube, of the grid for the surface
  int surface = 8192;       // points on the surface
  int space = 8192;         // points in space
  double sharp = 0.5;       // share of the surface's points that are where normals turn
  double uniform = 0.25;    // share of space's points that are anywhere in the cube
  double curvature = 0.25;  // share that are near where normals turn; the rest are near the
                            // surface
  std::vector<double> scales{0.005, 0.02, 0.08};  // deviations from the surface, in equal shares
  double margin = 0.1;                            // about the input, in its longest side
  std::uint64_t seed = 0;
  SampleNumbers numbers = SampleNumbers::float32;
};

/// Where a sample comes from.
enum class SampleKind : std::uint8_t {
  uniform = 0,    // by area, or by volume
  sharp = 1,      // on the surface, by area times how much normals turn
  near = 2,       // one of the scales away from uniform points of the surface
  curvature = 3,  // one of the scales away from sharp points of the surface
};

/// Samples in the cube [-1, 1]^3, and what they were taken from. A point x of the input is at
/// (x - centre) / half_side.
struct Samples {
  Vec3 centre = Vec3::Zero();
  double half_side = 1;  // [length]
  PolygonSoup surface;   // closed, in the cube

  MatX3 surface_points{0, 3}, surface_normals{0, 3};  // on the zero set of the distance; outward
  VecX surface_confidence;                            // 0 to 1: of inside and outside there
  std::vector<SampleKind> surface_kinds;

  MatX3 points{0, 3};
  VecX distances;   // negative inside; inside is what has no positive one
  VecX confidence;  // 0 to 1
  std::vector<SampleKind> kinds;
  VecX deviations;  // scale of each point; 0: uniform

  SampleOptions options;
  Report report;  // sizes and residuals hold figures of quality
};

/// Distance by `method` (by default the one that is right for the input), a surface of its zero set
/// on a grid, points of this moved onto the zero set itself, and distances at points around them.
/// The same bits for the same input, options and version on every machine and any number of
/// threads. Throws InputError for bad input and options out of range, and as signed_distance.
Samples sample(const PolygonSoup& input, const SampleOptions& options = {},
               const AnyMethod& method = {}, const Orientation& orientation = {},
               const Context& context = {});

/// Version, options, normalisation, figures of quality and warnings as JSON. `input`: what it is
/// called.
std::string samples_card(const Samples& samples, const std::string& input);

/// The file of the card that belongs to a file of samples: "a.json" to "a.npz".
std::filesystem::path card_beside(const std::filesystem::path& samples);

/// Writes arrays and, beside them, the card: .npz (NumPy), .zarr (a folder, version 2, not packed),
/// .tar (WebDataset, with the card as a member, too). Throws UnsupportedError for other extensions,
/// IoError.
void write(const Samples& samples, const std::filesystem::path& path, const std::string& input);

}  // namespace littoral
