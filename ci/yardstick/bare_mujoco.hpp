#pragma once

#include <mujoco/mujoco.h>

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string_view>

namespace ironbird::yardstick {

/// One body without shapes, every part of the engine off that a free body does not need, Runge-Kutta.
inline constexpr std::string_view kLeanModel = R"(<mujoco><option timestep="0.0025" integrator="RK4">
  <flag equality="disable" frictionloss="disable" limit="disable" constraint="disable" contact="disable"
   passive="disable" clampctrl="disable" sensor="disable"/></option>
  <worldbody><body><freejoint/><inertial pos="0 0 0" mass="3.9" diaginertia="0.0735 0.0733 0.125"/></body>
  </worldbody></mujoco>)";

/// The engine alone on a model: one step after the other, nothing of ours.
class BareMujoco {
 public:
  explicit BareMujoco(std::string_view mjcf = kLeanModel) {
    const auto files = std::make_unique<mjVFS>();
    mj_defaultVFS(files.get());
    mj_makeEmptyFileVFS(files.get(), "bare.xml", static_cast<int>(mjcf.size()));
    std::copy(mjcf.begin(), mjcf.end(), static_cast<char*>(files->filedata[0]));
    char complaint[500] = "";
    model_ = mj_loadXML("bare.xml", files.get(), complaint, sizeof complaint);
    mj_deleteVFS(files.get());
    if (model_ == nullptr) throw std::runtime_error(complaint);
    data_ = mj_makeData(model_);
    data_->qpos[2] = 1e6;  // it falls as long as anybody watches
    data_->qvel[3] = 0.1;
  }
  ~BareMujoco() {
    mj_deleteData(data_);
    mj_deleteModel(model_);
  }
  BareMujoco(const BareMujoco&) = delete;
  BareMujoco& operator=(const BareMujoco&) = delete;

  void step() { mj_step(model_, data_); }
  /// @param value  of every actuator
  void set_controls(double value) { std::fill_n(data_->ctrl, model_->nu, value); }

 private:
  mjModel* model_ = nullptr;
  mjData* data_ = nullptr;
};

}  // namespace ironbird::yardstick
