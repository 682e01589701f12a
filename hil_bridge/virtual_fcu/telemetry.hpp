#pragma once

#include <array>
#include <cstdint>

#include "hil_bridge/virtual_fcu/board.hpp"
#include "hil_bridge/virtual_fcu/parameter_store.hpp"
#include "hil_bridge/virtual_fcu/text_log.hpp"

namespace ironbird::hil_bridge::virtual_fcu {

/// What the firmware says and when: sends messages to the board, keeps the schedule of heartbeat and status,
/// and holds back texts until somebody is there to read them.
class Telemetry final : public TextLog {
 public:
  static constexpr int kHeldTexts = 25;
  static constexpr int kOutputDivider = 8;  ///< IMU samples per ROSFLIGHT_OUTPUT_RAW

  /// Where messages of this pass go.
  void begin_pass(const Board& board) {
    sent_ = board.sent;
    arrival_ = board.sent_arrival;
    clock_us_ = board.clock_us;
  }
  /// Is somebody listening?
  bool listened() const { return sent_ != nullptr; }

  template <class Message>
  void send(const Message& message) {
    if (sent_ != nullptr) sent_->push_back({arrival_, message});
  }

  /// Texts are held back, at most 25, the oldest overwritten, until the first heartbeat has come.
  void write(Severity severity, std::string_view text) override;
  void set_connected() { connected_ = true; }
  /// Sends the oldest text held back, if connected.
  void release_text();

  /// One PARAM_VALUE.
  void send_parameter(const ParameterStore& parameters, ParameterId id);
  /// Every parameter, one per pass, from the first.
  void start_parameter_list() { next_parameter_ = 0; }
  void continue_parameter_list(const ParameterStore& parameters);

  /// Does the clock enter a new second, a new tenth, with this pass? Each answers true once.
  bool heartbeat_due();
  bool status_due();
  /// Is this the eighth sample since the last time?
  bool output_due();

 private:
  struct HeldText {
    Severity severity = Severity::kInfo;
    std::array<char, 50> text{};
  };

  std::vector<Arrival>* sent_ = nullptr;
  Time arrival_{};
  std::uint64_t clock_us_ = 0;
  bool connected_ = false;
  std::array<HeldText, kHeldTexts> held_{};
  int oldest_held_ = 0;
  int held_count_ = 0;
  int next_parameter_ = kParameterCount;
  std::uint64_t second_ = 0;
  std::uint64_t tenth_ = 0;
  int samples_ = 0;
};

}  // namespace ironbird::hil_bridge::virtual_fcu
