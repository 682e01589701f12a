#include <benchmark/benchmark.h>

#include "ci/yardstick/in_turns.hpp"
#include "hil_bridge/virtual_fcu/firmware.hpp"

// One pass of the firmware with a new IMU sample, armed, flying a companion's command through the motor model
// of a custom mixer, other sensors at their usual rates, all telemetry built.

namespace ironbird::hil_bridge::virtual_fcu {
namespace {

std::vector<ParameterOverride> flying_quad() {
  std::vector<ParameterOverride> saved = {
      {"PRIMARY_MIXER", 11},  {"USE_MOTOR_PARAM", 1}, {"FAILSAFE_THR", 0.2},       {"RC_NUM_CHN", 8},
      {"RC_ARM_CHN", 4},      {"GYRO_X_BIAS", 1e-3},  {"MOTOR_RESISTANCE", 0.085}, {"MOTOR_KV", 0.02894},
      {"RC_ATT_OVRD_CHN", 5}, {"RC_THR_OVRD_CHN", 5}, {"BATT_VOLT_MAX", 25.2}};
  constexpr double kRoll[] = {-1, -1, 1, 1};
  constexpr double kPitch[] = {1, -1, -1, 1};
  for (int j = 0; j < 4; ++j) {
    const std::string output = std::to_string(j);
    saved.push_back({"PRI_MIXER_OUT_" + output, 2});
    saved.push_back({"PRI_MIXER_2_" + output, -5098.0});
    saved.push_back({"PRI_MIXER_3_" + output, 22184.6 * kRoll[j]});
    saved.push_back({"PRI_MIXER_4_" + output, 22184.6 * kPitch[j]});
    saved.push_back({"PRI_MIXER_5_" + output, j % 2 == 0 ? 234146.0 : -234146.0});
  }
  return saved;
}

/// A firmware that flies, and the board that feeds it.
class Flight {
 public:
  explicit Flight(bool listened) : firmware_(flying_quad()) {
    sent_.reserve(1024);
    if (listened) board_.sent = &sent_;
    for (int k = 0; k < 2000; ++k) step(true);
  }

  /// One tick: an idle pass with a command and, every fourth time, RC; then the IMU pass.
  void step(bool idle_pass) {
    ++tick_;
    board_.clock_us = tick_ * 2500;
    sent_.clear();
    if (idle_pass) {
      board_.clear_inputs();
      command_[0] = command();
      board_.received = command_;
      if (tick_ % 4 == 0) board_.rc = frame();
      firmware_.pass(board_);
    }
    fill();
    firmware_.pass(board_);
    benchmark::DoNotOptimize(board_.outputs);
  }

  void set_mode(std::uint8_t mode) { mode_ = mode; }
  bool armed() const { return firmware_.arming().armed(); }

 private:
  /// Forces and torques, or angles and throttle.
  rosflight::OffboardControl command() const {
    if (mode_ == 0) return {.u = {0, 0, -34.0F, 0.1F, -0.1F, 0.02F}, .ignore = 0, .mode = 0};
    return {.u = {0, 0, 0.45F, 0.1F, -0.1F, 0.02F}, .ignore = 0, .mode = mode_};
  }

  RcFrame frame() const {
    RcFrame frame;
    frame.channels.fill(0.5F);
    frame.channels[2] = 0.0F;
    frame.channels[4] = tick_ > 40 ? 1.0F : 0.0F;
    frame.channels[5] = 0.0F;
    return frame;
  }

  void fill() {
    board_.clear_inputs();
    const float wobble = 0.01F * static_cast<float>(tick_ % 16);
    board_.imu = ImuInput{.stamp_us = board_.clock_us,
                          .acceleration = {wobble, -wobble, -9.8F},
                          .angular_velocity = {0.1F * wobble, -0.2F * wobble, 0.05F * wobble},
                          .temperature = 300.0F};
    if (tick_ % 4 == 0) board_.mag = Triple{2e-5F, 1e-6F, 4e-5F};
    if (tick_ % 8 == 0) board_.baro = PressureInput{85800.0F, 300.0F};
    if (tick_ % 40 == 0) board_.gnss = rosflight::RosflightGnss{};
    if (tick_ % 40 == 0) board_.battery = BatteryInput{24.0F, 20.0F};
  }

  Firmware firmware_;
  Board board_;
  std::vector<Arrival> sent_;
  std::array<rosflight::Message, 1> command_{};
  std::uint64_t tick_ = 0;
  std::uint8_t mode_ = 0;
};

// The real firmware took 4.9 steps of a hand-written integrator for a pass with telemetry. The promise is as
// many, and seven tenths of them when nobody listens.
constexpr double kRealFirmware = 0.58 / 0.119;

void run(benchmark::State& state, double goal, bool listened, bool idle_pass, std::uint8_t mode) {
  Flight flight(listened);
  flight.set_mode(mode);
  for (int k = 0; k < 8; ++k) flight.step(true);
  if (!flight.armed()) state.SkipWithError("the firmware did not arm");
  yardstick::beside_rk4(state, goal, [&] { flight.step(idle_pass); });
}

void ImuPassWithTelemetryBesideRk4(benchmark::State& state) {
  run(state, kRealFirmware, true, false, 0);
}
void ImuPassInAngleModeBesideRk4(benchmark::State& state) {
  run(state, 0.0, true, false, 2);
}
void ImuPassWithoutListenerBesideRk4(benchmark::State& state) {
  run(state, 0.7 * kRealFirmware, false, false, 0);
}
void WholeTickWithTelemetryBesideRk4(benchmark::State& state) {
  run(state, 0.0, true, true, 0);
}

BENCHMARK(ImuPassWithTelemetryBesideRk4)->UseManualTime();
BENCHMARK(ImuPassInAngleModeBesideRk4)->UseManualTime();
BENCHMARK(ImuPassWithoutListenerBesideRk4)->UseManualTime();
BENCHMARK(WholeTickWithTelemetryBesideRk4)->UseManualTime();

}  // namespace
}  // namespace ironbird::hil_bridge::virtual_fcu
