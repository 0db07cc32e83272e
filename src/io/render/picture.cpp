#include "io/render/picture.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "io/render/camera.h"
#include "io/render/discs.h"
#include "io/render/raster.h"
#include "io/render/stroke_text.h"
#include "io/render/trace_raster.h"
#include "io/write.h"
#include "littoral/error.h"

namespace littoral::io {

namespace {

constexpr Rgb paper{249, 250, 252}, ink{40, 44, 54};

void check_options(const PictureOptions& options) {
  const auto side_ok = [](int n) { return n >= 16 && n <= 16384; };
  if (!side_ok(options.width) || !side_ok(options.height) ||
      static_cast<long long>(options.width) * options.height > 64'000'000) {
    throw InputError("picture: width and height must be 16 to 16384, and 64 million pixels at most",
                     "option-value");
  }
  if (options.supersampling < 1 || options.supersampling > 4) {
    throw InputError("picture: supersampling must be 1 to 4", "option-value");
  }
}

// A bar of the colours between the least and the greatest value, with numbers on its right.
struct ColourBar {
  double left, top, bottom, width, text_size;
  std::vector<double> ticks;

  std::string text(double tick) const {
    return label_text(tick, ticks.size() > 1 ? 0.1 * (ticks[1] - ticks[0]) : 0);
  }
};

ColourBar plan_bar(const PictureOptions& options, const FieldStyle& style, double& room) {
  ColourBar bar{};
  const double height = options.height;
  bar.text_size = std::clamp(0.016 * height, 7.0, 40.0);
  bar.width = 1.4 * bar.text_size;
  bar.top = 0.2 * height;
  bar.bottom = 0.8 * height;
  bar.ticks = style.discrete
                  ? nice_ticks(style.low, style.high, 1)  // the regions
                  : nice_ticks(style.low, style.high, nice_spacing(style.low, style.high, 7));
  if (bar.ticks.empty()) bar.ticks.push_back(style.low);
  double widest = 0;
  for (const double tick : bar.ticks) {
    widest = std::max(widest, number_width(bar.text_size, bar.text(tick)));
  }
  room = bar.width + 3 * bar.text_size + widest;
  bar.left = options.width - room + bar.text_size;
  return bar;
}

// Regions: a box of its colour for each number, the least below.
void draw_regions(Image& image, const ColourBar& bar, const FieldStyle& style) {
  const auto n = static_cast<double>(bar.ticks.size());
  const double step = std::min(2 * bar.text_size, (bar.bottom - bar.top) / n);
  const double middle = 0.5 * (bar.top + bar.bottom), right = bar.left + bar.width;
  for (std::size_t i = 0; i < bar.ticks.size(); ++i) {
    const double bottom = middle + (0.5 * n - static_cast<double>(i)) * step;
    const double top = bottom - 0.8 * step;
    for (int y = static_cast<int>(top); y < static_cast<int>(bottom); ++y)
      draw_line(image, bar.left, y + 0.5, right, y + 0.5, 1, value_colour(style, bar.ticks[i]));
    if (step < 1.1 * bar.text_size && i % 4 != 0) continue;
    draw_number(image, right + 0.8 * bar.text_size, 0.5 * (top + bottom) - 0.5 * bar.text_size,
                bar.text_size, bar.text(bar.ticks[i]), ink);
  }
}

void draw_bar(Image& image, const ColourBar& bar, const FieldStyle& style) {
  if (style.discrete) return draw_regions(image, bar, style);
  const double half = 0.5 * style.high - 0.5 * style.low;
  const auto height_of = [&](double value) {
    const double t = half > 0 ? (0.5 * value - 0.5 * style.low) / half : 0.5;
    return bar.bottom + t * (bar.top - bar.bottom);
  };
  const int top = static_cast<int>(bar.top), bottom = static_cast<int>(bar.bottom);
  for (int y = top; y < bottom; ++y) {
    const double t = (bar.bottom - (y + 0.5)) / (bar.bottom - bar.top);
    const double value = (1 - t) * style.low + t * style.high;
    const Rgb colour = value_colour(style, value);
    draw_line(image, bar.left + 1, y + 0.5, bar.left + bar.width - 1, y + 0.5, 1, colour);
  }
  const double right = bar.left + bar.width;
  draw_line(image, bar.left, bar.top, bar.left, bar.bottom, 1, ink);
  draw_line(image, right, bar.top, right, bar.bottom, 1, ink);
  draw_line(image, bar.left, bar.top, right, bar.top, 1, ink);
  draw_line(image, bar.left, bar.bottom, right, bar.bottom, 1, ink);
  for (const double tick : bar.ticks) {
    const double y = height_of(tick);
    draw_line(image, right, y, right + 0.4 * bar.text_size, y, 1, ink);
    draw_number(image, right + 0.8 * bar.text_size, y - 0.5 * bar.text_size, bar.text_size,
                bar.text(tick), ink);
  }
}

// Of the vertices, where the shading asks for it. What is traced stands in the way like the rest.
Openness open_of(const Scene& scene) {
  if (scene.shading != Shading::occluded) return {};
  if (!scene.trace) return openness(scene.points, scene.triangles);
  const MatX3i& traced = scene.trace->triangles;
  MatX3i all(scene.triangles.rows() + traced.rows(), 3);
  all << scene.triangles, traced;
  return openness(scene.points, all);
}

// Of the corners that stand for them where vertices are drawn as discs.
Openness at_discs(const Scene& scene, const Openness& open) {
  if (scene.discs.rows() == 0 || open.rows() == 0) return open;
  Openness corners(disc_corners * open.rows(), 4);
  for (Eigen::Index i = 0; i < corners.rows(); ++i) corners.row(i) = open.row(i / disc_corners);
  return corners;
}

void resolve(const Band& band, int samples, Image& image) {
  const auto n = static_cast<float>(samples * samples);
  for (int y = band.y0 / samples; y < band.y1 / samples; ++y) {
    for (int x = 0; x < image.width; ++x) {
      Eigen::Vector3f sum = Eigen::Vector3f::Zero();
      for (int j = 0; j < samples; ++j) {
        for (int i = 0; i < samples; ++i) {
          sum += band.colour[band.at(x * samples + i, y * samples + j)].cwiseMin(255.f);
        }
      }
      const std::size_t at = 3 * (std::size_t(y) * std::size_t(image.width) + std::size_t(x));
      for (int k = 0; k < 3; ++k) {
        image.rgb[at + std::size_t(k)] =
            static_cast<unsigned char>(std::clamp(std::lround(sum[k] / n), 0L, 255L));
      }
    }
  }
}

}  // namespace

Image draw_picture(const Scene& scene, const PictureOptions& options) {
  check_scene(scene);
  check_options(options);
  const FieldStyle style = field_style(scene);
  const int samples = options.supersampling;
  const bool with_bar = style.present && options.colour_bar && options.width >= 200;
  double room = 0;
  ColourBar bar{};
  if (with_bar) bar = plan_bar(options, style, room);

  const double margin = 0.04 * std::min(options.width, options.height) + 4;
  const Eigen::Vector4d window(margin, margin,
                               std::max(margin + 8, options.width - std::max(margin, room)),
                               options.height - margin);
  const Camera camera = fit_camera(scene, options, samples * window);
  const int rows = 16 * samples, height = options.height * samples;
  const Scene discs = scene.discs.rows() > 0 ? discs_as_triangles(scene) : Scene{};
  const Scene& drawn = scene.discs.rows() > 0 ? discs : scene;
  const Openness open = open_of(scene);
  const SurfaceRaster surface(drawn, at_discs(scene, open), camera, style, samples, height, rows);
  const TraceRaster trace(scene, open, camera, style, samples);
  const MarkRaster marks(scene, camera, samples);

  Image image{options.width, options.height, {}};
  image.rgb.resize(3 * std::size_t(image.width) * std::size_t(image.height));
  const auto bands = std::size_t((height + rows - 1) / rows);
  parallel_for(bands, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      Band band;
      band.width = options.width * samples;
      band.y0 = static_cast<int>(b) * rows;
      band.y1 = std::min(height, band.y0 + rows);
      const auto size = std::size_t(band.width) * std::size_t(band.y1 - band.y0);
      band.nearness.assign(size, 0);
      band.colour.assign(size, Eigen::Vector3f(paper[0], paper[1], paper[2]));
      surface.draw(static_cast<int>(b), band);
      trace.draw(band);
      marks.draw(band);
      resolve(band, samples, image);
    }
  });
  if (with_bar) draw_bar(image, bar, style);
  return image;
}

void write_picture(const std::filesystem::path& path, const Scene& scene,
                   const PictureOptions& options) {
  const std::string bytes = encode_png(draw_picture(scene, options));
  write_atomically(path, [&](std::ostream& out) {
    out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  });
}

}  // namespace littoral::io
