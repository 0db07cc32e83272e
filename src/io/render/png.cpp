#if LITTORAL_PNG
#include <png.h>
#endif

#include "io/render/picture.h"
#include "littoral/error.h"

namespace littoral::io {

#if LITTORAL_PNG

std::string encode_png(const Image& image) {
  // libpng's simplified interface: errors come back as a return value and a message.
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  header.width = static_cast<png_uint_32>(image.width);
  header.height = static_cast<png_uint_32>(image.height);
  header.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(header);
  std::string bytes(size, '\0');
  if (!png_image_write_to_memory(&header, bytes.data(), &size, 0, image.rgb.data(), 0, nullptr)) {
    const std::string message = header.message;
    png_image_free(&header);
    throw IoError("cannot encode a picture as PNG: " + message, "cannot-write");
  }
  bytes.resize(size);
  return bytes;
}

#else

std::string encode_png(const Image&) {
  throw UnsupportedError("this build of the library writes no pictures", "unsupported-file");
}

#endif

}  // namespace littoral::io
