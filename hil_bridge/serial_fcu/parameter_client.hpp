#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "hil_bridge/fcu/fcu.hpp"
#include "hil_bridge/serial_fcu/parameter_set.hpp"

namespace ironbird::hil_bridge {

/// How a set or a write to the FCU's flash ended.
enum class ParameterOutcome : std::uint8_t {
  kPending,
  kDone,       ///< the FCU has said the value that was asked for
  kRefused,    ///< it answered no, as it does when armed
  kNoAnswer,   ///< it did not answer in time
  kDifferent,  ///< it keeps another value
};

/// How a download stands.
struct ParameterProgress {
  int known = 0;
  int count = 0;
  std::uint64_t requests = 0;
  bool complete = false;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("known", self.known, "1", "parameters received");
    visit("count", self.count, "1", "parameters that there are; 0: not known yet");
    visit("requests", self.requests, "1", "parameters asked for again");
    visit("complete", self.complete, "1", "all are known");
  }
};

/// The FCU's parameters as known here, and the talk that keeps them the same on both sides.
///
/// The protocol acknowledges nothing: a list may come with holes, a set gets an answer only if it changed
/// something. So: what is missing is asked for again, index by index, until it is there; a set is followed by
/// a reading-back until the FCU says the new value. Works over a line that loses half of everything in either
/// direction.
///
/// Pure: time comes in with the calls, messages go out through a function.
class ParameterClient {
 public:
  using Send = std::function<void(const rosflight::Message&)>;

  /// @param system  SYS_ID of the FCU
  explicit ParameterClient(std::uint8_t system = 1) : system_(system) {}

  /// From now on the FCU has this SYS_ID. It hears nothing that is addressed to another.
  void address(std::uint8_t system);
  std::uint8_t system() const { return system_; }

  /// Forgets everything and asks for all.
  void start_download(Time now);

  /// Wants `name` to have these bits. @return empty, or why that is not possible
  std::string set(const ParameterRecord& wanted);
  /// Wants all values written to flash.
  void write_to_flash();

  void take(const rosflight::ParamValue& message, Time now);
  void take(const rosflight::RosflightCmdAck& message);

  /// Sends what is due. Call it often, at least every 20 ms.
  void advance(Time now, const Send& send);

  const ParameterProgress& progress() const { return progress_; }
  /// All that are known, in the order of their indices.
  std::vector<ParameterRecord> known() const;
  std::optional<ParameterRecord> find(std::string_view name) const;

  /// What is not set yet stays as it is.
  void forget_sets() { sets_.clear(); }
  /// Is nothing under way?
  bool idle() const { return sets_.empty() && write_ != ParameterOutcome::kPending; }
  /// Sets that did not come to be, with the reason; oldest first.
  struct Failure {
    ParameterRecord wanted;
    ParameterOutcome outcome;
  };
  const std::vector<Failure>& failures() const { return failures_; }
  ParameterOutcome write_outcome() const { return write_; }
  /// Has a value changed since the last write to flash that went well?
  bool unsaved() const { return unsaved_; }

 private:
  struct Slot {
    std::optional<ParameterRecord> record;
    Time asked = Time::min();
  };
  struct Set {
    ParameterRecord wanted;
    std::uint16_t index = 0;
    int tries = 0;
    bool read_back = false;
    bool answered = false;
    Time next = Time::min();
  };

  void request_missing(Time now, const Send& send);
  void advance_sets(Time now, const Send& send);
  void advance_write(Time now, const Send& send);
  void settle(std::uint16_t index);

  std::uint8_t system_;
  bool downloading_ = false;
  Time list_asked_ = Time::min();
  Time last_value_ = Time::min();
  Time requested_ = Time::min();
  std::vector<Slot> slots_;
  std::deque<Set> sets_;
  std::vector<Failure> failures_;
  ParameterProgress progress_;
  ParameterOutcome write_ = ParameterOutcome::kDone;
  int write_tries_ = 0;
  Time write_next_{};
  bool unsaved_ = false;
};

}  // namespace ironbird::hil_bridge
