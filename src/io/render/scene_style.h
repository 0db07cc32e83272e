#pragma once
// How a scene looks, decided once for pages and pictures: frame, colours, levels, source marks.

#include <array>
#include <vector>

#include "io/render/scene.h"

namespace littoral::io {

using Rgb = std::array<unsigned char, 3>;  // sRGB
inline Eigen::Vector3f as_vector(const Rgb& c) {
  return {static_cast<float>(c[0]), static_cast<float>(c[1]), static_cast<float>(c[2])};
}

/// Centre and size of what is shown, and a pleasant view of it.
struct SceneFrame {
  Vec3 centre = Vec3::Zero();  // of the bounding box
  double radius = 1;           // largest distance from the centre, at least the smallest normal
  Vec3 towards_eye{0, 0, 1};   // unit
  Vec3 up{0, 1, 0};            // unit, orthogonal to towards_eye
};

/// The frame of surface and sources. Flat surfaces are seen face-on from the positive side of their
/// largest normal component (so nothing is mirrored) with y (or -z) up; others from the front
/// above, turned by 30 degrees from the shorter horizontal principal axis. y is up, or z for what
/// stands on the plane z = 0 and not on y = 0. What the scene says of its view comes first.
/// Throws InputError for directions that are zero, not finite or parallel.
SceneFrame scene_frame(const Scene& scene);

/// The axis that is up for what fills a box: y, or z for what stands on z = 0 and not on y = 0.
Vec3 upright_axis(const Vec3& low, const Vec3& high);

/// Which values the colours span.
struct FieldStyle {
  bool present = false;  // is there a finite value?
  ColourMap map = ColourMap::sequential;
  bool diverging = false;    // two hues about zero, where values are negative somewhere
  bool infinite = false;     // are there infinite values? drawn grey
  double low = 0, high = 0;  // least and greatest finite value on the triangles
  double colour_low = 0, colour_high = 0;  // ends of the colour map
  double spacing = 0;                      // of even isolines; 0: none, or explicit levels
  bool discrete = false;                   // integers that name regions, in colours of their own
};

/// The style of a scene's field.
FieldStyle field_style(const Scene& scene);
/// The style of another field of the same surface.
FieldStyle field_style(const Scene& scene, const SceneField& field);

/// The style of values at points, whatever joins these.
FieldStyle field_style(const VecX& values, const std::string& name);

/// One colour for each value; grey where it is not finite.
std::vector<Rgb> value_colours(const VecX& values, const std::string& name);

/// The colours (256) of a map, from low to high, as in colour_maps.inc; not of automatic.
const std::array<Rgb, 256>& colour_map(ColourMap map);

/// The name of a map in colour_maps.inc.
const char* colour_map_name(ColourMap map);

/// The colour of a region by its number.
Rgb region_colour(long number);

/// The colour of a finite value.
Rgb value_colour(const FieldStyle& style, double value);

/// Position of a finite value in the colour map, 0..1; of diverging ones 0 is in the middle.
double colour_position(const FieldStyle& style, double value);

inline constexpr Rgb plain_colour{196, 204, 214}, infinite_colour{150, 150, 150};
inline constexpr Rgb signed_colour{0, 122, 70}, unsigned_colour{214, 0, 108};

/// The number 1, 2, 2.5 or 5 times a power of ten that cuts high - low into about `count` parts;
/// 0 if the range is empty or not finite, or count < 1.
double nice_spacing(double low, double high, double count);

/// Multiples of `step` inside [low, high], ascending; at most 1000 of them.
std::vector<double> nice_ticks(double low, double high, double step);

/// A number to five significant digits, or to as many as tell apart what is `fine` apart, for
/// labels; no trailing zeros, plain minus sign.
std::string label_text(double value, double fine = 0);

/// Pieces that mark sources: strokes (whole curves, or dashes of unsigned ones) and arrow heads
/// showing the direction of signed ones, in space.
struct SourceMarks {
  struct Stroke {
    Vec3 a, b;
    bool is_signed;
  };
  struct Arrow {
    Vec3 base, tip;
  };
  std::vector<Stroke> strokes;
  std::vector<Arrow> arrows;
};

SourceMarks source_marks(const Scene& scene, double radius);

}  // namespace littoral::io
