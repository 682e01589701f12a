#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "hil_bridge/serial_fcu/serial_fcu.hpp"
#include "scenarios/fcu/unit_view.hpp"

namespace ironbird::scenarios {

/// What there is to show of a unit, now.
struct Monitored {
  const hil_bridge::SerialFcu& fcu;
  const UnitView& view;
  std::string line;  ///< its name
  bool line_up = true;
  hil_bridge::Time now{};
  hil_bridge::Time since{};  ///< when the watching began
};

/// Messages of this kind in the last second.
template <class M>
int rate_of(const Monitored& unit) {
  return unit.fcu.statistics().rate(UnitView::kind<M>());
}

/// Is nothing heard, and for how long? Words for it, or empty.
std::string silence_of(const Monitored& unit);

/// The whole view, one string a line, none of them wider than the terminal.
/// @param columns  0: as wide as it likes  @param colour  what needs attention is red
std::vector<std::string> monitor_screen(const Monitored& unit, std::size_t columns, bool colour);

/// The same in one line, for a log file.
std::string monitor_line(const Monitored& unit);

/// The same as one line of JSON. What was not heard is not in it.
std::string monitor_json(const Monitored& unit);

}  // namespace ironbird::scenarios
