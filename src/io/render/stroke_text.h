#pragma once
// Lines and numbers drawn straight into an image.

#include <string_view>

#include "io/render/picture.h"
#include "io/render/scene_style.h"

namespace littoral::io {

/// A round-ended line from (x0, y0) to (x1, y1), positions and width in pixels, anti-aliased.
void draw_line(Image& image, double x0, double y0, double x1, double y1, double width, Rgb colour);

/// Digits and "+-.e" with their top left at (x, y), `size` pixels high; other characters are
/// spaces.
void draw_number(Image& image, double x, double y, double size, std::string_view text, Rgb colour);

/// Width of what draw_number draws, pixels.
double number_width(double size, std::string_view text);

}  // namespace littoral::io
