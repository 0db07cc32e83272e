#include "io/render/stroke_text.h"

#include <algorithm>
#include <cmath>

namespace littoral::io {

namespace {

constexpr double cell_width = 4, cell_height = 6, advance = 5.4;

// Pen paths on a grid 4 wide and 6 high, y down: pairs of digits are points, a space lifts the pen.
std::string_view strokes(char c) {
  switch (c) {
    case '0':
      return "103041453616050110";
    case '1':
      return "112026";
    case '2':
      return "01103041420646";
    case '3':
      return "01103041423323 334445361605";
    case '4':
      return "36300444";
    case '5':
      return "400002324345361605";
    case '6':
      return "413010010516364544331304";
    case '7':
      return "00401626";
    case '8':
      return "103041423313020110 1304051636454433";
    case '9':
      return "051636454130100103143443";
    case '-':
      return "0343";
    case '+':
      return "0343 2125";
    case '.':
      return "2626";
    case 'e':
      return "04444332120305163645";
    default:
      return "";
  }
}

}  // namespace

void draw_line(Image& image, double x0, double y0, double x1, double y1, double width, Rgb colour) {
  const double reach = 0.5 * width + 0.5, dx = x1 - x0, dy = y1 - y0;
  const double length2 = dx * dx + dy * dy;
  const int left = std::max(0, static_cast<int>(std::min(x0, x1) - reach));
  const int right = std::min(image.width - 1, static_cast<int>(std::max(x0, x1) + reach));
  const int top = std::max(0, static_cast<int>(std::min(y0, y1) - reach));
  const int bottom = std::min(image.height - 1, static_cast<int>(std::max(y0, y1) + reach));
  for (int y = top; y <= bottom; ++y) {
    for (int x = left; x <= right; ++x) {
      const double px = x + 0.5 - x0, py = y + 0.5 - y0;
      const double t = length2 > 0 ? std::clamp((px * dx + py * dy) / length2, 0.0, 1.0) : 0;
      const double ink = std::clamp(reach - std::hypot(px - t * dx, py - t * dy), 0.0, 1.0);
      unsigned char* pixel =
          &image.rgb[3 * (std::size_t(y) * std::size_t(image.width) + std::size_t(x))];
      for (std::size_t k = 0; k < 3; ++k) {
        pixel[k] = static_cast<unsigned char>(std::lround((1 - ink) * pixel[k] + ink * colour[k]));
      }
    }
  }
}

void draw_number(Image& image, double x, double y, double size, std::string_view text, Rgb colour) {
  const double unit = size / cell_height;
  for (const char c : text) {
    const std::string_view path = strokes(c);
    bool down = false;
    double px = 0, py = 0;
    for (std::size_t i = 0; i + 1 < path.size();) {
      if (path[i] == ' ') {
        down = false;
        ++i;
        continue;
      }
      const double qx = x + unit * (path[i] - '0'), qy = y + unit * (path[i + 1] - '0');
      if (down) draw_line(image, px, py, qx, qy, 0.12 * size, colour);
      px = qx;
      py = qy;
      down = true;
      i += 2;
    }
    x += unit * advance;
  }
}

double number_width(double size, std::string_view text) {
  if (text.empty()) return 0;
  return size / cell_height * (advance * static_cast<double>(text.size() - 1) + cell_width);
}

}  // namespace littoral::io
