#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "hil_bridge/interlock/interlock.hpp"
#include "hil_bridge/serial_fcu/serial_fcu.hpp"
#include "hil_bridge/transport/byte_stream.hpp"

namespace ironbird::scenarios {

class VerbOptions;

/// Where a unit is, as the command line says it.
struct UnitAddress {
  std::string port;
  int baud = 921600;
  std::string udp;
  double patience = 5.0;  // s
};

void add_unit_address(VerbOptions& options, UnitAddress& address);

/// The line to a unit, opened. @throws ConfigError for an address that is none, transport::LinkError for a
/// line that cannot be opened
std::unique_ptr<hil_bridge::transport::ByteStream> open_line(const UnitAddress& address);

/// Why values were not written to flash, and what to do.
std::string why_not_kept(hil_bridge::ParameterOutcome outcome);

/// A unit on the desk, talked to in real time: asked, and set while it is disarmed. No motor command ever
/// leaves.
class UnitOnLine {
 public:
  enum class Talk {
    kQuestions,  ///< nothing else leaves
    kChanges     ///< parameters and calibrations too, while it reports that it is disarmed
  };

  /// @throws as open_line
  explicit UnitOnLine(const UnitAddress& address, Talk talk = Talk::kChanges);

  /// Who hears every message from now on.
  void listen(std::function<void(const hil_bridge::Arrival&)> ear) { ear_ = std::move(ear); }

  /// Talks until `done`, for at most so long, or until somebody interrupts. @return is it done?
  bool until(double seconds, const std::function<bool()>& done);
  /// Talks until version and parameters are known. @throws transport::LinkError saying what was heard instead
  void meet();

  /// Has the unit write its parameters to its flash. @return did it confirm? If not, it has been said why.
  bool keep();

  hil_bridge::SerialFcu& fcu() { return fcu_; }
  hil_bridge::Connection& connection() { return fcu_.connection(); }
  hil_bridge::Time now() const;
  std::string name() const { return line_->name(); }
  bool line_up() const { return line_->is_up(); }
  int descriptor() const { return line_->descriptor(); }
  double patience() const { return address_.patience; }
  hil_bridge::LinkHealth health() const { return fcu_.health(now()); }

  /// Takes what has come and sends what is due, without waiting.
  void step();

 private:
  UnitAddress address_;
  std::unique_ptr<hil_bridge::transport::ByteStream> line_;
  hil_bridge::Interlock gate_;
  hil_bridge::SerialFcu fcu_;
  std::vector<hil_bridge::Arrival> heard_;
  std::function<void(const hil_bridge::Arrival&)> ear_;
};

}  // namespace ironbird::scenarios
