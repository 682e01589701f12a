#include "scenarios/requirements/quantity_text.hpp"

#include <cmath>
#include <stdexcept>

#include "scenarios/config/quantity.hpp"

namespace ironbird::scenarios {

double read_quantity(std::string_view text, std::string_view unit, const std::string& what) {
  double number = 0.0;
  try {
    number = parse_quantity(text, unit.empty() ? "1" : unit);
  } catch (const QuantityError& error) {
    throw std::invalid_argument(what + " = \"" + std::string(text) + "\": " + error.what());
  }
  if (!std::isfinite(number))
    throw std::invalid_argument(what + " = \"" + std::string(text) + "\", must be finite");
  return number;
}

}  // namespace ironbird::scenarios
