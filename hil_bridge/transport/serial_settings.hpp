#pragma once

#include <string>

namespace ironbird::hil_bridge::transport {

/// Sets a serial line to 8 data bits, no parity, one stop bit, no flow control, bytes as they are.
/// @param descriptor  of the open line
/// @param baud        any rate, Bd; the driver takes the nearest it can make
/// @return empty, or why the line would not take it
std::string set_raw(int descriptor, int baud);

/// Asks the driver to hand bytes on at once instead of gathering them (16 ms on some converters).
/// @return did it agree? Most lines that need no such thing do not
bool set_low_latency(int descriptor);

}  // namespace ironbird::hil_bridge::transport
