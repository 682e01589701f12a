#include "scenarios/video/image_diff.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>

namespace ironbird::scenarios {
namespace {

using simulator::Image;
using simulator::Pixel;

constexpr int kWindow = 8;
constexpr int kStride = 4;
constexpr double kC1 = 0.01 * 255 * 0.01 * 255;  // the constants of the paper for 8 bits
constexpr double kC2 = 0.03 * 255 * 0.03 * 255;

double brightness(const Pixel& p) {
  return 0.2126 * p.r + 0.7152 * p.g + 0.0722 * p.b;
}

std::array<int, 3> differences(const Pixel& a, const Pixel& b) {
  return {std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)};
}

double window_likeness(const Image& a, const Image& b, int left, int top) {
  const int right = std::min(left + kWindow, a.width());
  const int bottom = std::min(top + kWindow, a.height());
  double sum_a = 0.0, sum_b = 0.0, sum_aa = 0.0, sum_bb = 0.0, sum_ab = 0.0;
  for (int y = top; y < bottom; ++y) {
    for (int x = left; x < right; ++x) {
      const double in_a = brightness(a.at(x, y));
      const double in_b = brightness(b.at(x, y));
      sum_a += in_a;
      sum_b += in_b;
      sum_aa += in_a * in_a;
      sum_bb += in_b * in_b;
      sum_ab += in_a * in_b;
    }
  }
  const double n = (right - left) * (bottom - top);
  const double mean_a = sum_a / n;
  const double mean_b = sum_b / n;
  const double var_a = sum_aa / n - mean_a * mean_a;
  const double var_b = sum_bb / n - mean_b * mean_b;
  const double covariance = sum_ab / n - mean_a * mean_b;
  return (2.0 * mean_a * mean_b + kC1) * (2.0 * covariance + kC2) /
         ((mean_a * mean_a + mean_b * mean_b + kC1) * (var_a + var_b + kC2));
}

}  // namespace

ImageDistance compare(const Image& a, const Image& b) {
  ImageDistance distance;
  distance.same_size = a.width() == b.width() && a.height() == b.height();
  if (!distance.same_size) {
    distance.likeness = 0.0;
    return distance;
  }
  double changed = 0.0;
  double sum = 0.0;
  for (std::size_t i = 0; i < a.pixels().size(); ++i) {
    const std::array<int, 3> d = differences(a.pixels()[i], b.pixels()[i]);
    const int greatest = std::max({d[0], d[1], d[2]});
    distance.greatest = std::max(distance.greatest, greatest);
    changed += greatest > 0 ? 1.0 : 0.0;
    sum += d[0] + d[1] + d[2];
  }
  if (distance.greatest == 0) {
    return distance;
  }
  const double count = static_cast<double>(a.pixels().size());
  distance.changed = changed / count;
  distance.mean = sum / (3.0 * count);
  double likeness = 0.0;
  int windows = 0;
  for (int top = 0; top == 0 || top + kWindow <= a.height(); top += kStride) {
    for (int left = 0; left == 0 || left + kWindow <= a.width(); left += kStride) {
      likeness += window_likeness(a, b, left, top);
      ++windows;
    }
  }
  distance.likeness = likeness / windows;
  return distance;
}

Image difference_picture(const Image& a, const Image& b) {
  Image picture(a.width(), a.height());
  for (int y = 0; y < a.height(); ++y) {
    for (int x = 0; x < a.width(); ++x) {
      const std::array<int, 3> d = differences(a.at(x, y), b.at(x, y));
      const int greatest = std::max({d[0], d[1], d[2]});
      const int grey = 170 + static_cast<int>(brightness(a.at(x, y))) / 4;
      // Small differences show too: the smallest takes away a third of the way to pure red.
      const int fade = greatest == 0 ? 0 : std::min(255, 85 + 3 * greatest);
      picture.at(x, y) = Pixel{static_cast<std::uint8_t>(grey + (220 - grey) * fade / 255),
                               static_cast<std::uint8_t>(grey - grey * fade / 255),
                               static_cast<std::uint8_t>(grey - grey * fade / 255), 255};
    }
  }
  return picture;
}

}  // namespace ironbird::scenarios
