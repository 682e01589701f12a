#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hil_bridge/fcu/fcu.hpp"
#include "hil_bridge/serial_fcu/parameter_client.hpp"

namespace ironbird::hil_bridge {

/// What a unit can calibrate.
struct CalibrationKind {
  std::string_view name;
  std::uint8_t command = 0;
  std::string_view wants;
  std::span<const std::string_view> parameters;
  bool zeroes_first = false;
  bool starts_over = false;
  bool repeatable = true;
  Time least{};
  Time usual{};
  Time patience{};

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("name", self.name, "", "on the command line");
    visit("command", self.command, "1", "number in ROSFLIGHT_CMD");
    visit("wants", self.wants, "", "what the vehicle, or the pilot, has to do");
    visit("parameters", self.parameters, "", "where the result goes");
    visit("zeroes_first", self.zeroes_first, "1", "the unit sets them to zero when it begins");
    visit("starts_over", self.starts_over, "1", "the unit tries again after a failure");
    visit("repeatable", self.repeatable, "1", "ordering it twice does no harm");
    visit("least", self.least, "ns", "what comes earlier is of another calibration");
    visit("usual", self.usual, "ns", "after this the result is asked for, should nobody have told it");
    visit("patience", self.patience, "ns", "after this it has failed");
  }
};

/// All kinds, in the order of the dialect.
std::span<const CalibrationKind> calibration_kinds();
/// The kind of that name, or null.
const CalibrationKind* find_calibration(std::string_view name);

enum class CalibrationState : std::uint8_t {
  kAsked,     ///< ordered, not yet acknowledged
  kRunning,   ///< the unit has said that it began
  kDone,      ///< the result is there
  kFailed,    ///< the unit said so, or its result is no result
  kRefused,   ///< the unit answered no, as it does when it is armed
  kNoAnswer,  ///< it did not answer
};

/// One calibration, from the order to its outcome.
///
/// The unit's acknowledgement says only that it began. How it ended shows in its texts and in the parameters
/// that hold the result, both of which a line may lose: the parameters are asked for again.
///
/// Pure: time comes in with the calls, messages go out through a function.
class CalibrationClient {
 public:
  using Send = std::function<void(const rosflight::Message&)>;

  /// @param parameters  all known; outlives this
  CalibrationClient(const CalibrationKind& kind, const ParameterClient& parameters);

  void take(const rosflight::Message& message, Time now);
  /// Sends what is due. Call it often, at least every 20 ms.
  void advance(Time now, const Send& send);

  CalibrationState state() const { return state_; }
  bool over() const { return state_ != CalibrationState::kAsked && state_ != CalibrationState::kRunning; }
  /// Why it failed, in the unit's words where it has some.
  const std::string& reason() const { return reason_; }
  /// What the result's parameters were before, and are now.
  struct Change {
    std::string name;
    ParameterRecord before;
    ParameterRecord now;
  };
  std::vector<Change> changes() const;

 private:
  void hear(const rosflight::Statustext& text, Time now);
  void hear(const rosflight::ParamValue& value, Time now);
  void ask_for_result(Time now, const Send& send);
  void judge_result(Time now);
  void end(CalibrationState state, std::string reason = {});

  const CalibrationKind& kind_;
  const ParameterClient& parameters_;
  CalibrationState state_ = CalibrationState::kAsked;
  std::string reason_;
  std::vector<ParameterRecord> before_;
  std::vector<std::optional<ParameterRecord>> told_;  // after the calibration can have ended
  std::optional<Time> said_done_;
  int tries_ = 0;
  Time ordered_ = Time::min();
  Time began_{};
  Time asked_ = Time::min();
};

}  // namespace ironbird::hil_bridge
