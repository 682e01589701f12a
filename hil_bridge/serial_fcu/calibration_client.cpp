#include "hil_bridge/serial_fcu/calibration_client.hpp"

#include <algorithm>
#include <cctype>
#include <utility>

namespace ironbird::hil_bridge {

namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr Time kAnswer = milliseconds(500);
constexpr int kTries = 40;  // 0.75 of them get no answer over a line that loses half: 10^-5 get none at all
constexpr Time kAskAgain = milliseconds(200);
constexpr Time kToldInTime = seconds(3);  // its values, after the unit has said that it is done
constexpr std::uint8_t kErrorSeverity = 3;
constexpr std::uint8_t kLoudestInfo = 6;

constexpr std::array<std::string_view, 3> kAccelerometer = {"ACC_X_BIAS", "ACC_Y_BIAS", "ACC_Z_BIAS"};
constexpr std::array<std::string_view, 3> kGyro = {"GYRO_X_BIAS", "GYRO_Y_BIAS", "GYRO_Z_BIAS"};
constexpr std::array<std::string_view, 2> kBaro = {"BARO_BIAS", "GROUND_LEVEL"};
constexpr std::array<std::string_view, 1> kAirspeed = {"DIFF_PRESS_BIAS"};
constexpr std::array<std::string_view, 3> kTrim = {"X_EQ_TORQUE", "Y_EQ_TORQUE", "Z_EQ_TORQUE"};

// Durations: 1001 samples of the IMU, of which 400 come a second; 256 of a pressure, one every 20 ms.
const CalibrationKind kKinds[] = {
    {"rc-trim", rosflight::kCalibrateRc, "the pilot holds the sticks as for a steady hover", kTrim, false,
     false, false, Time::zero(), milliseconds(500), seconds(3)},
    {"imu", rosflight::kCalibrateImu, "the vehicle stands level and still", kAccelerometer, true, false, true,
     seconds(1), milliseconds(3500), seconds(15)},
    {"gyro", rosflight::kCalibrateGyro, "the vehicle stands still", kGyro, true, false, true, seconds(1),
     milliseconds(3500), seconds(15)},
    {"baro", rosflight::kCalibrateBaro, "no wind and no open door", kBaro, false, true, true, seconds(4),
     seconds(7), seconds(25)},
    {"airspeed", rosflight::kCalibrateAirspeed, "the pitot tube is covered", kAirspeed, false, true, true,
     seconds(4), seconds(7), seconds(25)},
};

/// The unit's words are those of its version: only their stems are relied on.
bool speaks_of(std::string_view text, std::initializer_list<std::string_view> stems) {
  std::string low(text);
  std::transform(low.begin(), low.end(), low.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::any_of(stems.begin(), stems.end(),
                     [&](std::string_view stem) { return low.find(stem) != std::string::npos; });
}

bool is_zero(const ParameterRecord& record) {
  return (record.bits & 0x7FFFFFFFU) == 0;  // both zeros
}

}  // namespace

std::span<const CalibrationKind> calibration_kinds() {
  return kKinds;
}

const CalibrationKind* find_calibration(std::string_view name) {
  const auto found = std::find_if(std::begin(kKinds), std::end(kKinds),
                                  [&](const CalibrationKind& kind) { return kind.name == name; });
  return found == std::end(kKinds) ? nullptr : found;
}

CalibrationClient::CalibrationClient(const CalibrationKind& kind, const ParameterClient& parameters)
    : kind_(kind), parameters_(parameters), told_(kind.parameters.size()) {
  for (const std::string_view name : kind.parameters) {
    before_.push_back(parameters.find(name).value_or(ParameterRecord{std::string(name), kRealParameter, 0}));
  }
}

void CalibrationClient::take(const rosflight::Message& message, Time now) {
  if (over()) return;
  if (const auto* answer = std::get_if<rosflight::RosflightCmdAck>(&message)) {
    if (answer->command != kind_.command || state_ != CalibrationState::kAsked || tries_ == 0) return;
    if (answer->success == 0)
      return end(CalibrationState::kRefused, "the unit refuses; it does while it is armed");
    state_ = CalibrationState::kRunning;
    began_ = now;
  } else if (const auto* text = std::get_if<rosflight::Statustext>(&message)) {
    hear(*text, now);
  } else if (const auto* value = std::get_if<rosflight::ParamValue>(&message)) {
    hear(*value, now);
  }
}

void CalibrationClient::hear(const rosflight::Statustext& text, Time now) {
  const std::string_view words = rosflight::text_of(text.text);
  if (state_ != CalibrationState::kRunning || now - began_ < kind_.least) return;
  if (text.severity <= kErrorSeverity && speaks_of(words, {"cal", "movement", "bias"})) {
    reason_ = "the unit says: " + std::string(words);
    if (!kind_.starts_over) end(CalibrationState::kFailed, reason_);
  } else if (text.severity > kErrorSeverity && text.severity <= kLoudestInfo &&
             speaks_of(words, {"finish", "success", "offset", "found"})) {
    said_done_ = now;  // the values are still asked for, if they were lost
  }
}

void CalibrationClient::hear(const rosflight::ParamValue& value, Time now) {
  if (state_ != CalibrationState::kRunning || now - began_ < kind_.least) return;
  for (std::size_t k = 0; k < kind_.parameters.size(); ++k) {
    if (rosflight::text_of(value.param_id) != kind_.parameters[k]) continue;
    told_[k] = ParameterRecord{before_[k].name, value.param_type, value.param_value.bits};
  }
  judge_result(now);
}

void CalibrationClient::judge_result(Time now) {
  const bool all = std::all_of(told_.begin(), told_.end(), [](const auto& told) { return told.has_value(); });
  if (!all) return;
  bool result = said_done_.has_value();
  for (std::size_t k = 0; k < told_.size(); ++k) {
    result = result || (kind_.zeroes_first ? !is_zero(*told_[k]) : *told_[k] != before_[k]);
  }
  if (result) return end(CalibrationState::kDone);
  if (now - began_ >= kind_.usual) std::fill(told_.begin(), told_.end(), std::nullopt);  // ask again
}

void CalibrationClient::advance(Time now, const Send& send) {
  if (over()) return;
  if (state_ == CalibrationState::kAsked) {
    if (ordered_ != Time::min() && now - ordered_ < kAnswer) return;
    if (tries_ == (kind_.repeatable ? kTries : 1)) {
      return end(CalibrationState::kNoAnswer, "the unit does not answer the order");
    }
    ++tries_;
    ordered_ = now;
    return send(rosflight::RosflightCmd{.command = kind_.command});
  }
  if (now - began_ >= kind_.patience) {
    return end(CalibrationState::kFailed, reason_.empty() ? "the unit told no result in time" : reason_);
  }
  if (said_done_ && now - *said_done_ >= kToldInTime) return end(CalibrationState::kDone);
  if (said_done_ || now - began_ >= kind_.usual) ask_for_result(now, send);
}

void CalibrationClient::ask_for_result(Time now, const Send& send) {
  if (asked_ != Time::min() && now - asked_ < kAskAgain) return;
  asked_ = now;
  for (std::size_t k = 0; k < told_.size(); ++k) {
    if (told_[k]) continue;
    send(rosflight::ParamRequestRead{.param_index = -1,
                                     .target_system = parameters_.system(),
                                     .target_component = 0,
                                     .param_id = rosflight::field_of<16>(kind_.parameters[k])});
  }
}

std::vector<CalibrationClient::Change> CalibrationClient::changes() const {
  std::vector<Change> changes;
  for (const ParameterRecord& before : before_) {
    changes.push_back({before.name, before, parameters_.find(before.name).value_or(before)});
  }
  return changes;
}

void CalibrationClient::end(CalibrationState state, std::string reason) {
  state_ = state;
  reason_ = std::move(reason);
}

}  // namespace ironbird::hil_bridge
