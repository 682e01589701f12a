#pragma once

#include <filesystem>

#include "simulator/render/image.hpp"

namespace ironbird::scenarios {

/// Writes the picture as a PNG file of 8-bit RGB. The same picture gives the same bytes. The file appears
/// whole or not at all. @throws std::runtime_error naming the file
void write_png(const simulator::Image& image, const std::filesystem::path& file);

/// Reads a PNG file of any kind as an opaque picture. @throws std::runtime_error naming the file
simulator::Image read_png(const std::filesystem::path& file);

}  // namespace ironbird::scenarios
