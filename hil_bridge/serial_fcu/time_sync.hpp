#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "hil_bridge/fcu/fcu.hpp"

namespace ironbird::hil_bridge {

/// How a time synchronisation stands.
struct TimeSyncState {
  bool valid = false;
  Time offset{};
  double drift = 0.0;
  Time least_round_trip{};
  Time round_trip{};
  std::uint64_t used = 0;
  std::uint64_t ignored = 0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("valid", self.valid, "1", "there was an exchange");
    visit("offset", self.offset, "ns", "bench time minus FCU time, now");
    visit("drift", self.drift, "1", "how much faster the bench's clock runs, as fraction");
    visit("least_round_trip", self.least_round_trip, "ns", "of the exchanges remembered");
    visit("round_trip", self.round_trip, "ns", "of the latest exchange");
    visit("used", self.used, "1", "exchanges believed");
    visit("ignored", self.ignored, "1", "exchanges that took too long");
  }
};

/// Turns the FCU's microseconds into bench time, from exchanges of time stamps.
///
/// An exchange says: between sending and the answer's arrival the FCU's clock showed so much. Half way
/// between is the best guess, wrong by half the difference of the two ways; so exchanges that took much
/// longer than the quickest one remembered are ignored. A straight line (offset and drift) is fitted to the
/// rest. The line that is used moves towards the fitted one by at most `kGreatestSlew`. Time jumps only when
/// two exchanges in a row prove it wrong, as when the first one waited behind all parameters. It jumps
/// forwards; instead of backwards it stands still.
///
/// Pure: time is an argument. The manner is that of NTP's clock filter (RFC 5905, section 10); the firmware's
/// companion `rosflight_io` takes each exchange nearly whole and carries its jitter.
class TimeSync {
 public:
  static constexpr double kGreatestSlew = 1e-3;  ///< s/s, ten times what two crystals differ by
  static constexpr std::size_t kRemembered = 64;

  /// One exchange. @param sent  bench time of the request  @param fcu  the FCU's clock in the answer
  /// @param arrived  bench time of the answer
  void exchange(Time sent, Time fcu, Time arrived);

  /// Bench time at which the FCU's clock showed `fcu`; never less than for the greatest `fcu` before it.
  /// Without an exchange `fallback`, the time of arrival.
  Time to_bench(Time fcu, Time fallback);

  /// The FCU has booted: its clock began anew.
  void reset();

  const TimeSyncState& state() const { return state_; }

 private:
  struct Sample {
    Time fcu{};
    Time offset{};
    Time round_trip{};
  };

  Time present_offset(Time fcu) const;
  /// Does the answer's clock lie outside of sending and arrival, as the line used tells them?
  bool contradicts(const Sample& sample) const;
  void begin_with(const Sample& sample);
  void fit(Time fcu);

  std::array<Sample, kRemembered> samples_{};
  std::size_t count_ = 0;
  std::size_t next_ = 0;
  Time anchor_{};  // FCU time at which the offset was `anchor_offset_`
  Time anchor_offset_{};
  double drift_ = 0.0;     // of the fitted offset, s/s
  double catch_up_ = 0.0;  // s/s, with which the line used moves to the fitted one,
  Time error_{};           // until it has moved by this
  Time latest_fcu_ = Time::min();
  Time latest_bench_ = Time::min();
  int contradictions_ = 0;  // in a row
  TimeSyncState state_;
};

}  // namespace ironbird::hil_bridge
