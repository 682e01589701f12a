#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "hil_bridge/virtual_fcu/arming.hpp"
#include "hil_bridge/virtual_fcu/attitude_controller.hpp"
#include "hil_bridge/virtual_fcu/attitude_filter.hpp"
#include "hil_bridge/virtual_fcu/battery_monitor.hpp"
#include "hil_bridge/virtual_fcu/board.hpp"
#include "hil_bridge/virtual_fcu/calibration.hpp"
#include "hil_bridge/virtual_fcu/command_mux.hpp"
#include "hil_bridge/virtual_fcu/mixer.hpp"
#include "hil_bridge/virtual_fcu/parameter_store.hpp"
#include "hil_bridge/virtual_fcu/rc.hpp"
#include "hil_bridge/virtual_fcu/sensor_corrections.hpp"
#include "hil_bridge/virtual_fcu/telemetry.hpp"

namespace ironbird::hil_bridge::virtual_fcu {

/// One value that differs from the firmware's default.
struct ParameterOverride {
  std::string name;
  double value = 0.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("name", self.name, "", "name of the parameter");
    visit("value", self.value, "SI", "value; whole for an integer parameter");
  }
};

/// Equivalent of the ROSflight 2.0 firmware: everything between the board's samples and its outputs, in
/// single precision, oddities included. Pure: no clock, no I/O; the board is an argument.
///
/// Not in it: the status lights, the recovery record of hard faults (inert on current boards) and the reboot
/// commands (acknowledged and without effect, as on current boards).
class Firmware final : private ParameterStore::Listener {
 public:
  /// Boots with `saved` as the values in non-volatile memory.
  /// @param undefined_when_inverted  see AttitudeFilter
  /// @throws std::invalid_argument for a name that does not exist or a value that its type cannot hold
  explicit Firmware(std::span<const ParameterOverride> saved = {}, bool undefined_when_inverted = false);

  Firmware(const Firmware&) = delete;
  Firmware& operator=(const Firmware&) = delete;

  /// One pass of the endless loop: sensors; with a new IMU sample filter, controller, mixer and outputs;
  /// messages out; messages in; errors; RC; command combination. So control flies the combination of the pass
  /// before.
  void pass(Board& board);

  const ParameterStore& parameters() const { return parameters_; }
  const Arming& arming() const { return arming_; }
  const Rc& rc() const { return rc_; }
  const CommandMux& commands() const { return mux_; }
  const AttitudeFilter& filter() const { return filter_; }
  const AttitudeController& controller() const { return controller_; }
  const Mixer& mixer() const { return mixer_; }
  const BatteryMonitor& battery() const { return battery_; }
  /// Is an IMU calibration running?
  bool calibrating_imu() const { return gyro_calibration_.running() || accelerometer_calibration_.running(); }
  /// Mixer inputs of the last IMU pass: forces x y z, torques x y z, four free ones.
  const std::array<float, kMixerInputs>& mixer_inputs() const { return mixer_inputs_; }

 private:
  void parameter_changed(ParameterId id) override;
  void configure_parts();
  void rebuild_mixer();
  void rebuild_failsafe();
  void map_switches();
  void boot();

  std::uint32_t now_ms() const { return static_cast<std::uint32_t>(now_us_ / 1000U); }
  void read_sensors(Board& board);
  void read_pressures(const Board& board);
  void control(Board& board);
  void stream(const Board& board);
  void stream_slow_sensors(const Board& board);
  void take_rc(const RcFrame& frame);

  void calibrate_imu(const ImuInput& rotated);
  void finish_gyro_calibration(const BiasResult& result);
  void finish_accelerometer_calibration(const BiasResult& result);
  void start_gyro_calibration();
  void start_imu_calibration();
  void calibrate_pressure(PressureCalibration& calibration, float pressure);
  void calibrate_trim();
  void set_triple(ParameterId first, const Triple& value);

  void handle_event(Event event);
  void request_arm();
  void explain_refusal();
  void set_error(ErrorBit bit, bool present);
  /// Sends a STATUS at once if the state machine or the error code moved.
  void report_changes();
  void send_status();
  void send_imu_and_attitude();
  void send_outputs(const Board& board);
  void send_rc_channels(const RcFrame& frame);

  void handle(const rosflight::Message& message);
  void on(const rosflight::ParamRequestRead& request);
  void on(const rosflight::ParamRequestList& request);
  void on(const rosflight::ParamSet& request);
  void on(const rosflight::Timesync& request);
  void on(const rosflight::RosflightCmd& request);
  void on(const rosflight::ExternalAttitude& message);
  bool run_command(std::uint8_t command);

  ParameterStore parameters_;
  Arming arming_;
  Rc rc_;
  CommandMux mux_;
  AttitudeFilter filter_;
  AttitudeController controller_;
  Mixer mixer_;
  BatteryMonitor battery_;
  SensorCorrections corrections_;
  GyroCalibration gyro_calibration_;
  AccelerometerCalibration accelerometer_calibration_;
  PressureCalibration baro_calibration_{kBaroVariance};
  PressureCalibration airspeed_calibration_{kDifferentialPressureVariance};
  Telemetry telemetry_;

  std::uint64_t now_us_ = 0;
  std::int16_t sensor_errors_ = 0;
  std::int16_t loop_time_us_ = 0;
  ImuInput imu_;           // what goes out on the link
  ImuInput believed_imu_;  // the same, or the last one that was a number
  std::uint64_t imu_before_us_ = 0;
  bool imu_seen_ = false;
  std::optional<float> pressure_;               // the latest that makes sense, Pa
  std::optional<float> differential_pressure_;  // the same
  float density_ = kSeaLevelDensity;
  std::array<float, kMixerInputs> mixer_inputs_{};
  bool rc_decoded_ = false;
  std::uint16_t reported_overrides_ = 0;
  bool refusal_explained_ = false;
  std::uint32_t refusal_explained_ms_ = 0;
};

}  // namespace ironbird::hil_bridge::virtual_fcu
