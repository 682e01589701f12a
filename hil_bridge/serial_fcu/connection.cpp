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

/// The firmware's version is what `git describe` says: v2.0.1, v2.0.1-4-g12ab34c, or a commit alone, which
/// tells nothing.
bool is_second_version(std::string_view text) {
  if (text.starts_with('v')) text.remove_prefix(1);
  const std::size_t digits = text.find_first_not_of("0123456789");
  const bool has_major = digits != 0 && digits != std::string_view::npos && text[digits] == '.';
  return !has_major || text.substr(0, digits) == "2";
}

bool mixes_wrongly(std::string_view text) {
  constexpr std::string_view kFirst = "2.0.0";
  if (text.starts_with('v')) text.remove_prefix(1);
  return text.starts_with(kFirst) && (text.size() == kFirst.size() || text[kFirst.size()] == '-');
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
  } else if (const auto* heartbeat = std::get_if<rosflight::Heartbeat>(&message)) {
    heartbeat_ = now;
    dialect_ = heartbeat->mavlink_version;
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
    dialect_.reset();
    version_.clear();
    refusal_.clear();
    state_ = ConnectionState::kHeard;
    if (config_.download) parameters_.start_download(now);
  }
  fcu_clock_ = std::max(fcu_clock_, fcu);
}

std::string Connection::what_is_other() const {
  const int count = parameters_.progress().count;
  if (count != 0 && count != rosflight::kParameterCount) {
    return "the unit has " + std::to_string(count) + " parameters, ROSflight 2.0 has " +
           std::to_string(rosflight::kParameterCount);
  }
  // Later a heartbeat of another kind is one that was broken on the way and has the right sum by chance.
  if (state_ != ConnectionState::kReady && dialect_ && *dialect_ != rosflight::kDialectVersion) {
    return "the unit speaks version " + std::to_string(*dialect_) +
           " of MAVLink's dialects, ROSflight 2.0 has " + std::to_string(rosflight::kDialectVersion);
  }
  if (!is_second_version(version_)) return "the unit is of another version than ROSflight 2.0";
  if (mixes_wrongly(version_))
    return "the unit mixes the companion's commands by the mixer that is not selected, as 2.0.0 does";
  return "";
}

void Connection::judge() {
  const ParameterProgress& progress = parameters_.progress();
  if (const std::string other = what_is_other(); !other.empty()) {
    state_ = ConnectionState::kRefused;
    refusal_ = other + (version_.empty() ? "" : "; it calls itself " + version_) +
               "; flash a firmware of version 2.0.1 or later";
    return;
  }
  if (state_ == ConnectionState::kRefused) {
    state_ = ConnectionState::kHeard;
    refusal_.clear();
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
