#include "hil_bridge/serial_fcu/connection.hpp"

#include <algorithm>

namespace ironbird::hil_bridge {

namespace {

using std::chrono::milliseconds;

constexpr Time kHeartbeatPeriod = std::chrono::seconds(1);
constexpr Time kVersionPeriod = milliseconds(500);
// No multiple of what a unit's loop may take: exchanges that always met it in the same phase would all be
// slow.
constexpr Time kExchangePeriod = std::chrono::microseconds(97'300);
constexpr Time kGone = std::chrono::seconds(3);
// The clock of a unit that has booted starts at zero; one that merely sends two streams out of order steps
// back by less.
constexpr Time kBootStep = milliseconds(500);

/// Can this be the answer to a question of ours?
bool answers_us(const rosflight::Timesync& message, Time now) {
  return message.tc1 > 0 && Time{message.tc1} <= rosflight::kGreatestClock && message.ts1 >= 0 &&
         Time{message.ts1} <= now;
}

}  // namespace

std::string_view name_of(ConnectionState state) {
  switch (state) {
    case ConnectionState::kSilent:
      return "silent";
    case ConnectionState::kHeard:
      return "heard";
    case ConnectionState::kDownloading:
      return "downloading";
    case ConnectionState::kReady:
      return "ready";
    case ConnectionState::kRefused:
      return "refused";
  }
  return "";
}

Connection::Connection(const ConnectionConfig& config) : config_(config), parameters_(config.system) {}

void Connection::begin(Time now) {
  const ConnectionConfig config = config_;
  *this = Connection(config);
  if (config_.download) parameters_.start_download(now);
}

void Connection::take(const rosflight::Message& message, Time now, std::uint64_t lost) {
  frame_ = now;
  lost_ = lost;
  if (state_ == ConnectionState::kSilent) state_ = ConnectionState::kHeard;
  if (const auto* imu = std::get_if<rosflight::SmallImu>(&message)) {
    imu_ = now;
    hear(rosflight::clock_of(imu->time_boot_us), now);
  } else if (const auto* value = std::get_if<rosflight::ParamValue>(&message)) {
    parameters_.take(*value, now);
  } else if (const auto* answer = std::get_if<rosflight::Timesync>(&message)) {
    if (answers_us(*answer, now)) time_sync_.exchange(Time{answer->ts1}, Time{answer->tc1}, now);
  } else if (const auto* status = std::get_if<rosflight::RosflightStatus>(&message)) {
    status_ = *status;
    status_at_ = now;
    lost_at_status_ = lost;
  } else if (const auto* acknowledged = std::get_if<rosflight::RosflightCmdAck>(&message)) {
    parameters_.take(*acknowledged);
  } else if (const auto* version = std::get_if<rosflight::RosflightVersion>(&message)) {
    // One that says nothing does not take back what was said.
    if (const auto text = rosflight::text_of(version->version); !text.empty()) version_ = text;
  } else if (std::holds_alternative<rosflight::Heartbeat>(message)) {
    heartbeat_ = now;
    lost_at_heartbeat_ = lost;
  } else if (std::holds_alternative<rosflight::RcChannels>(message)) {
    radio_ = now;
  }
  judge();
}

void Connection::hear(Time fcu, Time now) {
  if (fcu_clock_ != Time::min() && fcu < fcu_clock_ - kBootStep) {
    ++reboots_;
    fcu_clock_ = Time::min();
    time_sync_.reset();
    status_.reset();
    status_at_.reset();
    version_.clear();
    refusal_.clear();
    state_ = ConnectionState::kHeard;
    if (config_.download) parameters_.start_download(now);
  }
  fcu_clock_ = std::max(fcu_clock_, fcu);
}

void Connection::judge() {
  const ParameterProgress& progress = parameters_.progress();
  if (progress.count != 0 && progress.count != rosflight::kParameterCount) {
    state_ = ConnectionState::kRefused;
    refusal_ = "the unit has " + std::to_string(progress.count) + " parameters, ROSflight 2.0 has " +
               std::to_string(rosflight::kParameterCount) +
               (version_.empty() ? "" : "; it calls itself " + version_) +
               "; flash a firmware of version 2.0";
    return;
  }
  if (state_ == ConnectionState::kHeard && progress.known > 0) state_ = ConnectionState::kDownloading;
  const bool known = (progress.complete || !config_.download) && !version_.empty();
  if (known && (state_ == ConnectionState::kHeard || state_ == ConnectionState::kDownloading)) {
    state_ = ConnectionState::kReady;
  }
}

void Connection::advance(Time now, const Send& send) {
  if (frame_ && now - *frame_ > kGone && state_ != ConnectionState::kRefused)
    state_ = ConnectionState::kSilent;
  if (heartbeat_due_ == Time::min() || now >= heartbeat_due_) {
    heartbeat_due_ = now + kHeartbeatPeriod;
    send(rosflight::Heartbeat{.mavlink_version = rosflight::kDialectVersion});
  }
  // Asked while armed it would only be refused.
  const bool armed = status_ && status_->armed != 0;
  if (version_.empty() && !armed && (version_due_ == Time::min() || now >= version_due_)) {
    version_due_ = now + kVersionPeriod;
    send(rosflight::RosflightCmd{.command = rosflight::kSendVersion});
  }
  if (config_.synchronise && (exchange_due_ == Time::min() || now >= exchange_due_)) {
    exchange_due_ = now + kExchangePeriod;
    send(rosflight::Timesync{.tc1 = 0, .ts1 = now.count()});
  }
  parameters_.advance(now, send);
}

Time Connection::to_bench(Time fcu, Time fallback) {
  return config_.synchronise ? time_sync_.to_bench(fcu, fallback) : fcu;
}

}  // namespace ironbird::hil_bridge
