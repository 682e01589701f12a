#include "simulator/plant/mujoco_plant.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <stdexcept>

#include "simulator/frames/ned_nwu.hpp"
#include "simulator/plant/mujoco_model.hpp"
#include "simulator/plant/proximity.hpp"

namespace ironbird::simulator {
namespace {

constexpr double kContactStep = 0.5e-3;  // s
constexpr double kRestStep = 2.5e-3;     // s
constexpr double kFlightStep = 5e-3;     // s

class MujocoPlant final : public Plant {
 public:
  MujocoPlant(const VehicleParams& vehicle, const FieldParams& field)
      : flight_(flight_model()),
        contact_(contact_model(vehicle.contact, field)),
        proximity_(vehicle.contact, field) {
    configure({vehicle.mass, vehicle.inertia.matrix()}, 9.80665);
    reset(RigidBodyState{}, RotorSpeeds::Zero());
  }

  void configure(const MassProperties& mass, double gravity) override {
    flight_.configure(mass, gravity);
    contact_.configure(mass, gravity);
  }

  void reset(const RigidBodyState& state, const RotorSpeeds& rotors) override {
    state_ = state;
    state_.q_NB.normalize();
    rotors_ = rotors;
    rotor_rates_.fill(RotorSpeeds::Zero());
    failure_ = nullptr;
    in_contact_ = false;
    choose(proximity_.update(state.p_NB_N, state.v_NB_N.norm()));
    active_->reset(state_);
  }

  void step(double dt, ForceModel& forces) override {
    const bool near = proximity_.update(state_.p_NB_N, state_.v_NB_N.norm());
    if (near != (active_ == &contact_)) {
      choose(near);
      active_->reset(state_);
    }
    forces_ = &forces;
    dt_ = dt;
    step_engine();
    advance_rotors();
    active_->read(state_);
    in_contact_ = active_->data().ncon > 0;
    forces.settle(state_, rotors_);
  }

  const RigidBodyState& state() const override { return state_; }
  const RotorSpeeds& rotors() const override { return rotors_; }
  bool in_contact() const override { return in_contact_; }
  const char* failure() const override { return failure_; }
  double contact_step() const override {
    if (!proximity_.near()) return kFlightStep;
    return in_contact_ && nearly_at_rest(state_) ? kRestStep : kContactStep;
  }

  /// One stage of the engine's integrator: called by the engine when it has set the stage's state.
  void evaluate_stage() {
    const int i = std::min(stage_, 3);
    const double offset = kStage[i] * dt_;
    const RotorSpeeds rotors = i == 0 ? rotors_ : RotorSpeeds(rotors_ + offset * rotor_rates_[i - 1]);
    RigidBodyState state;
    active_->read(state);
    const Forces acting = forces_->evaluate(state, rotors, offset);
    const Vector3 force_world = ned_nwu(Vector3(state.q_NB * acting.wrench.F_Bcm_B));
    const Vector3 torque_body = ned_nwu(acting.wrench.M_Bcm_B);
    std::copy_n(force_world.data(), 3, active_->data().qfrc_applied);      // world axes
    std::copy_n(torque_body.data(), 3, active_->data().qfrc_applied + 3);  // body axes
    rotor_rates_[i] = acting.rotor_acceleration;
    ++stage_;
  }

 private:
  /// Where in the step the four stages of the classical scheme lie; also what each takes of the rates before
  /// it.
  static constexpr std::array<double, 4> kStage = {0.0, 0.5, 0.5, 1.0};

  void choose(bool near) { active_ = near ? &contact_ : &flight_; }

  void step_engine();

  /// Moves the rotor speeds on with the weights of the engine's scheme.
  void advance_rotors() {
    const auto& k = rotor_rates_;
    const bool one_stage = active_->model().opt.integrator == mjINT_EULER;
    rotors_ += one_stage ? RotorSpeeds(dt_ * k[0])
                         : RotorSpeeds(dt_ / 6.0 * (k[0] + 2.0 * k[1] + 2.0 * k[2] + k[3]));
  }

  MujocoModel flight_;
  MujocoModel contact_;
  MujocoModel* active_ = &contact_;
  Proximity proximity_;
  RigidBodyState state_;
  RotorSpeeds rotors_ = RotorSpeeds::Zero();
  bool in_contact_ = false;
  const char* failure_ = nullptr;

  // Of the step under way.
  ForceModel* forces_ = nullptr;
  double dt_ = 0.0;
  int stage_ = 0;
  std::array<RotorSpeeds, 4> rotor_rates_;
};

// The engine knows one callback for the whole process. It finds the plant in the data that it is called with,
// so it holds nothing itself; data without a plant, such as a renderer's, is left alone.
void set_plant_of(mjData& data, MujocoPlant* plant) {
  std::memcpy(data.userdata, &plant, sizeof plant);
}

void on_control(const mjModel* model, mjData* data) {
  if (model->nuserdata < 1) return;
  MujocoPlant* plant = nullptr;
  std::memcpy(&plant, data->userdata, sizeof plant);
  if (plant != nullptr) plant->evaluate_stage();
}

[[noreturn]] void on_error(const char* message) {
  throw std::runtime_error(message);
}

void on_warning(const char*) {}  // the counters in the data say it all

/// Before anything else: the engine's own handlers write a file and wait for a key.
bool install_handlers() {
  mju_user_error = on_error;
  mju_user_warning = on_warning;
  mjcb_control = on_control;
  return true;
}

[[maybe_unused]] const bool kHandlersInstalled = install_handlers();

void MujocoPlant::step_engine() {
  mjData& data = active_->data();
  mjModel& model = active_->model();
  model.opt.timestep = dt_;
  // Contact is stiff and has corners: four stages cost four times as much there and gain nothing.
  model.opt.integrator = in_contact_ ? mjINT_EULER : mjINT_RK4;
  stage_ = 0;
  set_plant_of(data, this);
  try {
    mj_step(&model, &data);
  } catch (const std::runtime_error&) {
    failure_ = "MuJoCo reported an error";
  }
  set_plant_of(data, nullptr);
  if (active_->bad_values() != 0) failure_ = "MuJoCo met a value that it could not believe and started over";
}

}  // namespace

std::unique_ptr<Plant> make_mujoco_plant(const VehicleParams& vehicle, const FieldParams& field) {
  return std::make_unique<MujocoPlant>(vehicle, field);
}

}  // namespace ironbird::simulator
