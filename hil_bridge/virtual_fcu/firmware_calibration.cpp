#include "hil_bridge/virtual_fcu/firmware.hpp"

// Calibrations: when they start, and what their results do.

namespace ironbird::hil_bridge::virtual_fcu {

void Firmware::set_triple(ParameterId first, const Triple& value) {
  parameters_.set(first, value.x);
  parameters_.set(first + 1, value.y);
  parameters_.set(first + 2, value.z);
}

void Firmware::start_gyro_calibration() {
  set_triple(parameter("GYRO_X_BIAS"), {});
  gyro_calibration_.start();
}

void Firmware::start_imu_calibration() {
  start_gyro_calibration();
  set_triple(parameter("ACC_X_BIAS"), {});
  accelerometer_calibration_.start();
}

void Firmware::calibrate_imu(const ImuInput& rotated) {
  if (gyro_calibration_.running()) {
    if (const auto result = gyro_calibration_.add(rotated.angular_velocity)) finish_gyro_calibration(*result);
  }
  if (accelerometer_calibration_.running()) {
    const Triple drift = {parameters_.real(parameter("ACC_X_TEMP_COMP")),
                          parameters_.real(parameter("ACC_Y_TEMP_COMP")),
                          parameters_.real(parameter("ACC_Z_TEMP_COMP"))};
    if (const auto result =
            accelerometer_calibration_.add(rotated.acceleration, rotated.temperature, drift)) {
      finish_accelerometer_calibration(*result);
    }
  }
}

void Firmware::finish_gyro_calibration(const BiasResult& result) {
  if (result.verdict != BiasResult::Verdict::kAccepted) {
    telemetry_.write(Severity::kError, "gyro calibration: too much movement");
    handle_event(Event::kCalibrationFailed);
    return;
  }
  set_triple(parameter("GYRO_X_BIAS"), result.bias);
  filter_.reset_bias();
  handle_event(Event::kCalibrationComplete);
}

void Firmware::finish_accelerometer_calibration(const BiasResult& result) {
  if (result.verdict == BiasResult::Verdict::kMoved) {
    telemetry_.write(Severity::kError, "IMU calibration: too much movement");
    return;
  }
  filter_.reset();
  if (result.verdict == BiasResult::Verdict::kTooLarge) {
    telemetry_.write(Severity::kError, TextLine("accelerometer bias too large: ").add(result.norm).text());
    return;
  }
  set_triple(parameter("ACC_X_BIAS"), result.bias);
  telemetry_.write(Severity::kInfo, "IMU offsets stored");
  set_error(kUncalibratedImu, false);
}

void Firmware::calibrate_pressure(PressureCalibration& calibration, float pressure) {
  const bool baro = &calibration == &baro_calibration_;
  const PressureCalibration::Outcome outcome = calibration.add(pressure, now_ms());
  if (outcome == PressureCalibration::Outcome::kNone) return;
  if (outcome == PressureCalibration::Outcome::kUnsteady) {
    telemetry_.write(Severity::kError, baro ? "baro calibration: too much movement"
                                            : "airspeed calibration: too much movement");
    return;
  }
  if (baro) {
    parameters_.set(parameter("BARO_BIAS"), calibration.mean());
    parameters_.set(parameter("GROUND_LEVEL"), pressure_altitude(calibration.mean()));
  } else {
    parameters_.set(parameter("DIFF_PRESS_BIAS"), calibration.mean());
  }
  telemetry_.write(Severity::kInfo, baro ? "baro calibration finished" : "airspeed calibration finished");
}

void Firmware::calibrate_trim() {
  telemetry_.write(Severity::kWarning, "taking equilibrium torques from the sticks");
  const std::array<float, 3> torques = controller_.trim(mux_.pilot());
  for (int k = 0; k < 3; ++k) {
    const ParameterId id = parameter("X_EQ_TORQUE") + k;
    parameters_.set(id, parameters_.real(id) + torques[static_cast<std::size_t>(k)]);
  }
  telemetry_.write(Severity::kWarning, "equilibrium torques found: zero the trims now");
}

}  // namespace ironbird::hil_bridge::virtual_fcu
