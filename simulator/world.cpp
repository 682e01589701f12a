#include "simulator/world.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace ironbird::simulator {

namespace {

/// How long the vehicle may take to come to rest on the ground.
constexpr Time kSettlingTime = std::chrono::milliseconds(500);

SensorSite site_of(const Environment& environment) {
  return {.latitude = environment.latitude(),
          .longitude = environment.longitude(),
          .altitude = environment.altitude(),
          .gravity = environment.gravity(),
          .magnetic_field_N = environment.magnetic_field_N(),
          .air = environment.params().air};
}

Quaternion turned_to(double heading) {
  return Quaternion(Eigen::AngleAxis<double>(heading, Vector3::UnitZ()));
}

/// Distance from the centre of mass down to what touches the ground first, m.
double standing_height(const ContactParams& contact) {
  double height = contact.body_half_size.z();
  for (const Vector3& foot : contact.feet) height = std::max(height, foot.z() + contact.foot_radius);
  return height;
}

/// The attitude half-way between two that are close to each other.
Quaternion midway(const Quaternion& first, const Quaternion& second) {
  const double sign = first.dot(second) < 0.0 ? -1.0 : 1.0;
  return Quaternion(first.coeffs() + sign * second.coeffs()).normalized();
}

}  // namespace

World::World(const WorldConfig& config, std::unique_ptr<Plant> plant)
    : tick_(config.tick),
      environment_(config.environment, config.seed),
      vehicle_(config.vehicle, environment_),
      sensors_(config.sensors, site_of(environment_), config.tick, config.seed),
      plant_(std::move(plant)) {
  plant_->configure(vehicle_.mass_properties(), environment_.gravity());
  RigidBodyState start;
  start.p_NB_N = config.initial_p_NB_N;
  start.q_NB = turned_to(config.initial_heading);
  if (config.on_ground) {
    start.p_NB_N.z() = -standing_height(config.vehicle.contact);
    settle(start);
  } else {
    plant_->reset(start, vehicle_.equilibrium_speeds());
  }
  copy_state_to_truth();
  truth_.f_B = plant_->state().q_NB.conjugate() * Vector3(0.0, 0.0, -environment_.gravity());
}

World::~World() = default;

void World::settle(const RigidBodyState& start) {
  plant_->reset(start, RotorSpeeds::Zero());
  vehicle_.set_commands(RotorCommands{});
  const std::int64_t steps = plant_steps();
  const std::int64_t count = kSettlingTime * steps / tick_;
  const double dt = seconds(tick_) / static_cast<double>(steps);
  bool touched = false;
  for (std::int64_t i = 0; i < count; ++i) {
    plant_->step(dt, vehicle_);
    touched = touched || plant_->in_contact();
  }
  if (!touched) plant_->reset(start, RotorSpeeds::Zero());
}

void World::step(const RotorCommands& commands, Time until) {
  assert(until > truth_.stamp && (until - truth_.stamp) % tick_ == Time::zero());
  vehicle_.set_commands(commands);
  readings_ = Readings{};
  while (truth_.stamp < until) advance_tick();
}

void World::advance_tick() {
  const RigidBodyState before = plant_->state();
  environment_.advance(seconds(tick_), before.p_NB_N, before.v_NB_N);
  step_plant();
  truth_.stamp += tick_;
  update_truth(before);
  sensors_.sample(truth_, truth_.stamp, fault_state_, readings_);
}

void World::step_plant() {
  const std::int64_t steps = plant_steps();
  const double dt = seconds(tick_) / static_cast<double>(steps);
  for (std::int64_t i = 0; i < steps; ++i) {
    plant_->step(dt, vehicle_);
    vehicle_.finish_step(dt, plant_->state(), plant_->rotors());
  }
}

std::int64_t World::plant_steps() const {
  const double longest = plant_->contact_step();
  if (seconds(tick_) <= longest) return 1;
  // The fewest equal steps, each a whole number of nanoseconds and none longer than the engine likes.
  constexpr double kRoundOff = 1e-9;
  std::int64_t steps = static_cast<std::int64_t>(std::ceil(seconds(tick_) / longest - kRoundOff));
  while (tick_.count() % steps != 0) ++steps;
  return steps;
}

int World::begin(const Fault& fault) {
  check(fault, vehicle_.rotor_count());
  if (fault.kind == FaultKind::kBatteryCharge) vehicle_.set_battery_charge(fault.magnitude);
  faults_.push_back({next_fault_, fault});
  apply_faults();
  return next_fault_++;
}

void World::end(int id) {
  std::erase_if(faults_, [id](const ActiveFault& active) { return active.id == id; });
  apply_faults();
}

void World::apply_faults() {
  FaultState state;
  for (const ActiveFault& active : faults_) add(active.fault, state);
  for (int rotor = 0; rotor < vehicle_.rotor_count(); ++rotor) {
    vehicle_.set_rotor_efficiency(rotor, state.rotor_efficiency[static_cast<std::size_t>(rotor)]);
  }
  if (state.wind_N != fault_state_.wind_N) environment_.add_wind(state.wind_N - fault_state_.wind_N);
  if (state.payload != fault_state_.payload) {
    vehicle_.set_payload(state.payload);
    plant_->configure(vehicle_.mass_properties(), environment_.gravity());
  }
  fault_state_ = state;
}

void World::update_truth(const RigidBodyState& before) {
  const RigidBodyState& after = plant_->state();
  const double dt = seconds(tick_);
  const Vector3 gravity_N(0.0, 0.0, environment_.gravity());
  const Vector3 a_NB_N = (after.v_NB_N - before.v_NB_N) / dt;
  copy_state_to_truth();
  truth_.f_B = midway(before.q_NB, after.q_NB).conjugate() * (a_NB_N - gravity_N);
  truth_.w_dot_NB_B = (after.w_NB_B - before.w_NB_B) / dt;
}

void World::copy_state_to_truth() {
  const RigidBodyState& state = plant_->state();
  truth_.p_NB_N = state.p_NB_N;
  truth_.q_NB = state.q_NB;
  truth_.v_NB_N = state.v_NB_N;
  truth_.w_NB_B = state.w_NB_B;
  truth_.wind_N = environment_.wind_N();
  truth_.air_density = vehicle_.air_density(-state.p_NB_N.z());
  for (int rotor = 0; rotor < kMaxRotors; ++rotor) {
    truth_.rotor_speed[static_cast<std::size_t>(rotor)] = plant_->rotors()[rotor];
  }
  truth_.battery_voltage = vehicle_.battery_voltage();
  truth_.battery_current = vehicle_.battery_current();
  truth_.battery_charge_used = vehicle_.battery_charge_used();
  truth_.in_contact = plant_->in_contact();
}

}  // namespace ironbird::simulator
