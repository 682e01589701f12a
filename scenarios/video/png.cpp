#include "scenarios/video/png.hpp"

#include <png.h>

#include <string>
#include <system_error>
#include <vector>

#include "scenarios/config/user_error.hpp"
#include "scenarios/config/write_file.hpp"

namespace ironbird::scenarios {
namespace {

using simulator::Image;
using simulator::Pixel;

png_image empty_description() {
  png_image description{};
  description.version = PNG_IMAGE_VERSION;
  description.format = PNG_FORMAT_RGB;
  return description;
}

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& why) {
  throw UserError(with_remedy(file.string() + ": " + why));
}

}  // namespace

void write_png(const Image& image, const std::filesystem::path& file) {
  std::vector<std::uint8_t> rgb;
  rgb.reserve(image.pixels().size() * 3);
  for (const Pixel& pixel : image.pixels()) {
    rgb.insert(rgb.end(), {pixel.r, pixel.g, pixel.b});
  }
  png_image description = empty_description();
  description.width = static_cast<png_uint_32>(image.width());
  description.height = static_cast<png_uint_32>(image.height());
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(description);
  std::string bytes(size, '\0');
  if (png_image_write_to_memory(&description, bytes.data(), &size, 0, rgb.data(), 0, nullptr) == 0)
    fail(file, std::string("cannot be written: ") + description.message);
  bytes.resize(size);
  write_file(file, bytes);
}

Image read_png(const std::filesystem::path& file) {
  png_image description = empty_description();
  if (png_image_begin_read_from_file(&description, file.c_str()) == 0) {
    fail(file, std::string("cannot be read: ") + description.message);
  }
  description.format = PNG_FORMAT_RGB;
  std::vector<std::uint8_t> rgb(PNG_IMAGE_SIZE(description));
  const png_color black{0, 0, 0};
  if (png_image_finish_read(&description, &black, rgb.data(), 0, nullptr) == 0) {
    fail(file, std::string("cannot be read: ") + description.message);
  }
  Image image(static_cast<int>(description.width), static_cast<int>(description.height));
  const std::uint8_t* from = rgb.data();
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x, from += 3) {
      image.at(x, y) = Pixel{from[0], from[1], from[2], 255};
    }
  }
  return image;
}

}  // namespace ironbird::scenarios
