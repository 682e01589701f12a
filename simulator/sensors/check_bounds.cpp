#include "simulator/sensors/check_bounds.hpp"

#include <sstream>
#include <stdexcept>

namespace ironbird::simulator {

void require_within(const std::string& path, double value, const char* unit, double lower, double upper) {
  if (value >= lower && value <= upper) return;
  std::ostringstream message;
  message << path << " = " << value << ' ' << unit << ", must be " << lower << ".." << upper;
  throw std::invalid_argument(message.str());
}

}  // namespace ironbird::simulator
