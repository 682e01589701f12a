#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "hil_bridge/virtual_fcu/firmware.hpp"

namespace ironbird::hil_bridge::virtual_fcu {

/// Bits of a float, as PARAM_SET carries them.
inline std::uint32_t bits_of(float value) {
  return std::bit_cast<std::uint32_t>(value);
}
inline std::uint32_t bits_of(std::int32_t value) {
  return std::bit_cast<std::uint32_t>(value);
}

/// A 16-byte name field.
inline std::array<char, 16> name_field(std::string_view name) {
  std::array<char, 16> field{};
  std::copy(name.begin(), name.end(), field.begin());
  return field;
}

/// A quad x that can arm by switch: canned mixer, valid failsafe, calibrated IMU.
inline std::vector<ParameterOverride> armable(std::vector<ParameterOverride> more = {}) {
  std::vector<ParameterOverride> saved = {
      {"PRIMARY_MIXER", 2},   {"FAILSAFE_THR", 0.3},  {"GYRO_X_BIAS", 1e-9},
      {"RC_NUM_CHN", 8},      {"RC_ARM_CHN", 4},      {"RC_ATT_OVRD_CHN", 5},
      {"RC_THR_OVRD_CHN", 6}, {"RC_ATT_CTRL_CHN", 7}, {"RC_OVRD_LAG_T", 0}};
  saved.insert(saved.end(), more.begin(), more.end());
  return saved;
}

/// Firmware on a board that the test feeds by hand. Time only passes in `imu_pass` and `wait`.
class FakeBoard {
 public:
  explicit FakeBoard(const std::vector<ParameterOverride>& saved = {}, bool undefined_when_inverted = false)
      : firmware_(saved, undefined_when_inverted) {
    board_.sent = &sent_;
    frame_.channels.fill(0.5F);
    for (std::size_t k : {2U, 4U, 5U, 6U}) frame_.channels[k] = 0.0F;
    frame_.channels[7] = 1.0F;  // angles
  }

  void wait(std::uint64_t microseconds) { board_.clock_us += microseconds; }

  /// 2.5 ms later: one pass with a new IMU sample.
  void imu_pass(Triple acceleration = {0, 0, -kGravity}, Triple rate = {}) {
    wait(2500);
    board_.imu =
        ImuInput{.stamp_us = board_.clock_us, .acceleration = acceleration, .angular_velocity = rate};
    pass();
  }
  void imu_passes(int count) {
    for (int k = 0; k < count; ++k) imu_pass();
  }
  /// One pass without anything new but what the test put on the board.
  void pass() {
    board_.received = inbox_;
    firmware_.pass(board_);
    board_.clear_inputs();
    inbox_.clear();
  }
  /// One pass with an RC frame: that of `frame()`.
  void rc_pass() {
    board_.rc = frame_;
    pass();
  }
  template <class Message>
  void deliver(const Message& message) {
    inbox_.push_back(message);
    pass();
  }
  void put(const rosflight::Message& message) { inbox_.push_back(message); }

  /// The arm switch on, as an RC frame.
  void arm() {
    frame_.channels[4] = 1.0F;
    rc_pass();
  }

  template <class Message>
  std::vector<Message> sent() const {
    std::vector<Message> found;
    for (const Arrival& arrival : sent_) {
      if (const auto* message = std::get_if<Message>(&arrival.message)) found.push_back(*message);
    }
    return found;
  }
  /// Texts sent so far that contain `word`.
  int texts(std::string_view word) const {
    int count = 0;
    for (const auto& text : sent<rosflight::Statustext>()) {
      if (std::string(text.text.data()).find(word) != std::string::npos) ++count;
    }
    return count;
  }
  void forget_sent() { sent_.clear(); }

  Board& board() { return board_; }
  RcFrame& frame() { return frame_; }
  const Firmware& firmware() const { return firmware_; }
  const std::vector<Arrival>& all_sent() const { return sent_; }

 private:
  Firmware firmware_;
  Board board_;
  RcFrame frame_;
  std::vector<rosflight::Message> inbox_;
  std::vector<Arrival> sent_;
};

}  // namespace ironbird::hil_bridge::virtual_fcu
