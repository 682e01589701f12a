#pragma once

#include <string>

#include "hil_bridge/serial_fcu/serial_fcu.hpp"

namespace ironbird::scenarios {

/// What is known of a unit, one line for each fact.
std::string unit_report(const hil_bridge::SerialFcu& fcu, const std::string& line, hil_bridge::Time now);

/// The same for programs.
std::string unit_report_json(const hil_bridge::SerialFcu& fcu, const std::string& line, hil_bridge::Time now);

/// The names of the bits of the error code, "none" for 0.
std::string error_names(std::uint8_t code);
/// Who has which channel: "the companion has all", or the names of the bits.
std::string override_names(std::uint16_t bits);

}  // namespace ironbird::scenarios
