#pragma once

#include <mujoco/mujoco.h>

#include <memory>
#include <string>

#include "simulator/plant/field.hpp"
#include "simulator/plant/plant.hpp"
#include "simulator/vehicle/vehicle_params.hpp"

namespace ironbird::simulator {

/// The vehicle as one body without any shape: all that free flight needs.
std::string flight_model();

/// The vehicle with feet and box, on the ground, among the obstacles.
std::string contact_model(const ContactParams& vehicle, const FieldParams& field);

/// A MuJoCo model of one free body with its data.
class MujocoModel {
 public:
  /// @param mjcf  text of the model
  /// @throws std::invalid_argument with the engine's complaint
  explicit MujocoModel(const std::string& mjcf);

  /// Writes mass properties and gravity into the model; keeps the state.
  void configure(const MassProperties& mass, double gravity);

  /// Sets the state, in NED and FRD, and forgets everything about the past.
  void reset(const RigidBodyState& state);

  /// The state, in NED and FRD.
  void read(RigidBodyState& state) const;

  /// How often the engine has found a value that it cannot believe and has started over.
  int bad_values() const;

  mjModel& model() { return *model_; }
  mjData& data() { return *data_; }
  const mjData& data() const { return *data_; }

 private:
  struct DeleteModel {
    void operator()(mjModel* model) const { mj_deleteModel(model); }
  };
  struct DeleteData {
    void operator()(mjData* data) const { mj_deleteData(data); }
  };

  std::unique_ptr<mjModel, DeleteModel> model_;
  std::unique_ptr<mjData, DeleteData> data_;
};

}  // namespace ironbird::simulator
