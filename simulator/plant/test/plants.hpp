#pragma once

#include <memory>
#include <numbers>

#include "simulator/plant/mujoco_plant.hpp"
#include "simulator/plant/ode_plant.hpp"
#include "simulator/plant/rigid_body_plant.hpp"

namespace ironbird::simulator {

// The plants under test and what each may be wrong by. The bounds are those of a study with a wrench held in
// the body frame, tightened where forces in every stage do better; each is within a factor of ten or so of
// what was seen.

constexpr double kDegree = std::numbers::pi / 180.0;  // rad

struct Own {
  static constexpr const char* kName = "Own";
  static constexpr double kFinest =
      2.5e-3;  // s, of the three steps of the order test; finer ones end in rounding
  static constexpr double kLeastOrder = 3.8;
  static constexpr double kMostOrder = 4.3;
  static constexpr double kFlightPosition = 1e-11;         // m, ten seconds of closed loop at 0.5 ms
  static constexpr double kFlightAttitude = 1e-11;         // rad
  static constexpr double kFlipAttitude = 1e-9 * kDegree;  // rad, ten seconds about the middle axis
  static constexpr double kTumbleEnergy = 1e-12;           // relative, ten seconds at 0.5 ms
  static constexpr double kTumbleMomentum = 1e-11;         // relative
  static constexpr double kFlipTime = 1e-10;               // relative
  static constexpr double kFall = 1e-11;                   // m, terminal velocity
  static std::unique_ptr<Plant> make(const VehicleParams&, const FieldParams&) {
    return std::make_unique<RigidBodyPlant>();
  }
};

struct Mujoco {
  static constexpr const char* kName = "Mujoco";
  static constexpr double kFinest = 0.5e-3;
  static constexpr double kLeastOrder = 1.9;  // its fourth-order scheme adds turns as vectors
  static constexpr double kMostOrder = 2.1;
  static constexpr double kFlightPosition = 1e-8;
  static constexpr double kFlightAttitude = 2e-7;
  static constexpr double kFlipAttitude = 1e-4 * kDegree;
  static constexpr double kTumbleEnergy = 1e-12;
  static constexpr double kTumbleMomentum = 2e-6;
  static constexpr double kFlipTime = 1e-10;
  static constexpr double kFall = 1e-11;
  static std::unique_ptr<Plant> make(const VehicleParams& vehicle, const FieldParams& field) {
    return make_mujoco_plant(vehicle, field);
  }
};

struct Ode {
  static constexpr const char* kName = "Ode";
  static constexpr double kFinest = 0.5e-3;
  static constexpr double kLeastOrder = 1.9;
  static constexpr double kMostOrder = 2.1;
  static constexpr double kFlightPosition = 1e-5;
  static constexpr double kFlightAttitude = 1e-5;
  static constexpr double kFlipAttitude = 1e-3 * kDegree;
  static constexpr double kTumbleEnergy = 1e-6;
  static constexpr double kTumbleMomentum = 1e-6;
  static constexpr double kFlipTime = 5e-6;
  static constexpr double kFall = 1e-5;
  static std::unique_ptr<Plant> make(const VehicleParams& vehicle, const FieldParams& field) {
    return make_ode_plant(vehicle, field);
  }
};

struct PlantName {
  template <class Engine>
  static const char* GetName(int) {
    return Engine::kName;
  }
};

using Plants = ::testing::Types<Own, Mujoco, Ode>;
using PlantsWithContact = ::testing::Types<Mujoco, Ode>;

}  // namespace ironbird::simulator
