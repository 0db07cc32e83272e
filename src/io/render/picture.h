#pragma once
// Pictures of a scene without a display: a software renderer.

#include <filesystem>
#include <optional>
#include <vector>

#include "io/render/scene.h"
#include "littoral/types.h"

namespace littoral::io {

struct PictureOptions {
  int width = 1200, height = 900;     // pixels, 16..16384 each, 64 million together
  std::optional<Vec3> towards_eye{};  // direction from the surface to the eye; default: scene_frame
  std::optional<Vec3> up{};  // direction that points up in the picture; default: scene_frame
  int supersampling = 2;     // samples a pixel along x and along y, 1..4
  bool colour_bar = true;    // where there is a field
};

/// Red, green and blue bytes, row by row from the top.
struct Image {
  int width = 0, height = 0;
  std::vector<unsigned char> rgb;  // height*width*3
};

/// Draws the surface coloured by its field, isolines and sources in perspective, shaded from both
/// sides alike. The image is the same for any thread count. Throws what check_scene throws, and
/// InputError for options out of range or a view direction that is zero or parallel to `up`.
Image draw_picture(const Scene& scene, const PictureOptions& options = {});

/// draw_picture into a PNG file; throws IoError if it cannot be written.
void write_picture(const std::filesystem::path& path, const Scene& scene,
                   const PictureOptions& options = {});

/// The bytes of an image as a PNG file.
std::string encode_png(const Image& image);

}  // namespace littoral::io
