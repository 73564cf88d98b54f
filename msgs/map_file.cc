#include "msgs/map_file.h"

#include <fmt/format.h>
#include <png.h>

#include <cstdint>

#include "core/error.h"
#include "core/files.h"
#include "worlds/uav/obstacle_map.h"

namespace fresco {
namespace {

constexpr char kColours[] =
    "black or white (free), red (no flying), green (blocks radio), yellow (both) and blue (start and "
    "landing), each "
    "of red, green and blue 0 or 255";

/// Frees what libpng has allocated for a picture.
class PngImage {
 public:
  PngImage() { image_.version = PNG_IMAGE_VERSION; }
  ~PngImage() { png_image_free(&image_); }
  PngImage(const PngImage&) = delete;
  PngImage& operator=(const PngImage&) = delete;

  png_image& operator*() { return image_; }
  png_image* operator->() { return &image_; }

 private:
  png_image image_{};
};

/// The character of a pixel; 0 if its colour has no meaning.
char KindOfColour(const uint8_t* pixel) {
  int colour = 0;
  for (int channel = 0; channel < 3; ++channel) {
    if (pixel[channel] != 0 && pixel[channel] != 255) {
      return 0;
    }
    colour = 2 * colour + (pixel[channel] != 0 ? 1 : 0);
  }
  constexpr char kKinds[] = {'.', 'S', 'R', 0, 'N', 0, 'B', '.'};  // black, blue, green, .., white
  return kKinds[colour];
}

}  // namespace

std::vector<std::string> ReadMapFile(const std::filesystem::path& path) {
  const std::string file = ReadFile(path);
  PngImage image;
  if (png_image_begin_read_from_memory(&*image, file.data(), file.size()) == 0) {
    throw UsageError(fmt::format("{}: not a PNG file ({})", path.string(), image->message));
  }
  const size_t columns = image->width;
  const size_t rows = image->height;
  if (columns > kMaximumMapCells || columns * rows > kMaximumMapCells) {
    throw UsageError(fmt::format("{}: {} x {} pixels are too many; allowed: a product of at most {}",
                                 path.string(), columns, rows, kMaximumMapCells));
  }
  image->format = PNG_FORMAT_RGB;
  std::vector<uint8_t> pixels(PNG_IMAGE_SIZE(*image));
  const png_color black{};
  if (png_image_finish_read(&*image, &black, pixels.data(), 0, nullptr) == 0) {
    throw UsageError(fmt::format("{}: a damaged PNG file ({})", path.string(), image->message));
  }
  std::vector<std::string> text(rows);
  for (size_t i = 0; i < rows * columns; ++i) {
    const uint8_t* pixel = pixels.data() + 3 * i;
    const char kind = KindOfColour(pixel);
    if (kind == 0) {
      throw UsageError(fmt::format(
          "{}: the pixel in column {} from the left and row {} from the top (both from 0) has the colour "
          "#{:02x}{:02x}{:02x}; allowed: {}",
          path.string(), i % columns, i / columns, pixel[0], pixel[1], pixel[2], kColours));
    }
    text[i / columns].push_back(kind);
  }
  return text;
}

}  // namespace fresco
