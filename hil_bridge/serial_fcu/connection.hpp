#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "hil_bridge/fcu/fcu.hpp"
#include "hil_bridge/serial_fcu/parameter_client.hpp"
#include "hil_bridge/serial_fcu/time_sync.hpp"

namespace ironbird::hil_bridge {

/// How far the acquaintance with the other side has come.
enum class ConnectionState : std::uint8_t {
  kSilent,       ///< nothing of the dialect has been heard, or not for a while
  kHeard,        ///< frames come; who it is is being asked
  kDownloading,  ///< it says which version it is; its parameters are coming
  kReady,        ///< version and parameters are known
  kRefused,      ///< it is not a ROSflight 2.0 unit: see `refusal`
};

std::string_view name_of(ConnectionState state);

/// What a connection expects.
struct ConnectionConfig {
  std::uint8_t system = 1;
  bool synchronise = true;
  bool download = true;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("system", self.system, "1", "SYS_ID of the unit, until it is heard");
    visit("synchronise", self.synchronise, "1", "turn its time stamps into the bench's");
    visit("download", self.download, "1", "ask for all of its parameters");
  }
};

/// The talk beside the flying: who is there, is it alive, which parameters has it, what time is it there.
///
/// The protocol has no handshake and neither side notices that the other is gone (the streams simply stop),
/// so both are made here: presence from what arrives, identity from version and number of parameters.
///
/// Pure: time comes in with the calls, messages go out through a function.
class Connection {
 public:
  using Send = ParameterClient::Send;

  static constexpr Time kImuSilence = std::chrono::milliseconds(50);
  static constexpr Time kHeartbeatSilence = std::chrono::seconds(3);
  static constexpr Time kRcSilence = std::chrono::milliseconds(100);
  static constexpr Time kStatusSilence = std::chrono::milliseconds(500);
  /// A report that the unit's count of frames shows to have been lost on the way may be missing longer.
  static constexpr Time kHeartbeatLost = std::chrono::seconds(10);
  static constexpr Time kStatusLost = std::chrono::seconds(1);

  explicit Connection(const ConnectionConfig& config = {});

  /// The line is up, anew or for the first time.
  void begin(Time now);
  /// @param lost  frames of the unit that did not arrive, since the line came up
  void take(const rosflight::Message& message, Time now, std::uint64_t lost = 0);
  /// The unit's frames come from this system: it is the one to which its parameters are asked for.
  void follow(std::uint8_t system) { parameters_.address(system); }
  /// Sends what is due. Call it often, at least every 20 ms.
  void advance(Time now, const Send& send);

  ConnectionState state() const { return state_; }
  /// Why it was refused, and what to do.
  const std::string& refusal() const { return refusal_; }
  const std::string& version() const { return version_; }
  const ParameterClient& parameters() const { return parameters_; }
  ParameterClient& parameters() { return parameters_; }
  const TimeSyncState& time_sync() const { return time_sync_.state(); }
  /// Bench time of a stamp of the FCU. @param fallback  the time of arrival
  Time to_bench(Time fcu, Time fallback);

  bool imu_alive(Time now) const { return heard_within(imu_, now, kImuSilence); }
  bool heartbeat_alive(Time now) const {
    return heard_within(heartbeat_, now, lost_ > lost_at_heartbeat_ ? kHeartbeatLost : kHeartbeatSilence);
  }
  bool radio_alive(Time now) const { return heard_within(radio_, now, kRcSilence); }
  const std::optional<rosflight::RosflightStatus>& status() const { return status_; }
  /// Does its latest report, not older than half a second, say that it is armed, or that it is not?
  bool armed(Time now) const { return status_alive(now) && status_->armed != 0; }
  bool disarmed(Time now) const { return status_alive(now) && status_->armed == 0; }
  /// How often the unit has booted since the line came up, as its clock tells.
  int reboots() const { return reboots_; }

 private:
  static bool heard_within(const std::optional<Time>& last, Time now, Time silence) {
    return last && now - *last <= silence;
  }
  bool status_alive(Time now) const {
    return heard_within(status_at_, now, lost_ > lost_at_status_ ? kStatusLost : kStatusSilence);
  }
  /// Notes the unit's clock. One that starts anew is a unit that has booted.
  void hear(Time fcu, Time now);
  /// In which way this is no ROSflight 2.0 unit; empty: in none that is known.
  std::string what_is_other() const;
  /// Finds the state that what is known adds up to.
  void judge();

  ConnectionConfig config_;
  ConnectionState state_ = ConnectionState::kSilent;
  std::string refusal_;
  std::optional<int> dialect_;
  std::string version_;
  ParameterClient parameters_;
  TimeSync time_sync_;
  std::optional<Time> frame_;
  std::optional<Time> imu_;
  std::optional<Time> heartbeat_;
  std::optional<Time> radio_;
  std::optional<rosflight::RosflightStatus> status_;
  std::optional<Time> status_at_;
  std::uint64_t lost_ = 0;
  std::uint64_t lost_at_heartbeat_ = 0;
  std::uint64_t lost_at_status_ = 0;
  Time fcu_clock_ = Time::min();
  int reboots_ = 0;
  Time heartbeat_due_ = Time::min();
  Time version_due_ = Time::min();
  Time exchange_due_ = Time::min();
};

}  // namespace ironbird::hil_bridge
