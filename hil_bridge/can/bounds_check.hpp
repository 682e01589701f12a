#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace ironbird::hil_bridge::can {

/// Visits a description and throws std::invalid_argument at the first member outside its bounds.
class BoundsCheck {
 public:
  /// @param whose  beginning of the path that the message names
  explicit BoundsCheck(std::string whose) : whose_(std::move(whose)) {}

  template <class T, class... Bounds>
  void operator()(const char* name, const T& value, const char* unit, const char*, Bounds... bounds) const {
    if constexpr (sizeof...(bounds) == 2) {
      const double limits[] = {static_cast<double>(bounds)...};
      if (value >= limits[0] && value <= limits[1]) return;
      const std::string shown = std::string(unit) == "1" ? "" : std::string(" ") + unit;
      throw std::invalid_argument(whose_ + '.' + name + " = " + text(value) + shown + ", must be " +
                                  text(limits[0]) + " to " + text(limits[1]));
    }
  }

 private:
  static std::string text(double value) {
    std::string digits = std::to_string(value);
    digits.erase(digits.find_last_not_of('0') + 1);
    if (digits.back() == '.') digits.pop_back();
    return digits;
  }

  std::string whose_;
};

}  // namespace ironbird::hil_bridge::can
