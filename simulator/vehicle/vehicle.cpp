#include "simulator/vehicle/vehicle.hpp"

#include <algorithm>
#include <cmath>

namespace ironbird::simulator {
namespace {

constexpr double kStillAir = 1e-3;     // m/s, below it there is no drag
constexpr double kDensityReach = 1.0;  // m, where the density's expansion is as good as the formula

double share(double value) {
  return value > 0.0 ? std::min(value, 1.0) : 0.0;  // also for what is not a number
}

}  // namespace

Vehicle::Vehicle(const VehicleParams& params, const Environment& environment)
    : params_((check(params), params)),
      environment_(&environment),
      rotor_(params.rotor),
      battery_(params.battery),
      mass_properties_{params.mass, params.inertia.matrix()},
      rotor_count_(static_cast<int>(params.rotors.size())),
      has_inertia_(params.rotor.inertia > 0.0),
      inverse_rotor_inertia_(has_inertia_ ? 1.0 / params.rotor.inertia : 0.0),
      drag_area_(0.5 * params.drag.CD * params.drag.area),
      voltage_(battery_.open_voltage()) {
  efficiency_.fill(1.0);
  for (int i = 0; i < rotor_count_; ++i) {
    x_[i] = params.rotors[i].position.x();
    y_[i] = params.rotors[i].position.y();
    direction_[i] = params.rotors[i].direction;
    hub_z_ += params.rotors[i].position.z() / rotor_count_;
  }
}

void Vehicle::set_commands(const RotorCommands& commands) {
  for (int i = 0; i < rotor_count_; ++i) {
    command_[i] = share(commands.throttle[i]);
    drive_[i] = efficiency_[i] > 0.0 ? command_[i] : 0.0;
  }
}

Forces Vehicle::evaluate(const RigidBodyState& state, const RotorSpeeds& rotors, double offset) {
  const double height = -state.p_NB_N.z();
  if (offset == 0.0) remember_density(height);
  const Flow flow = flow_at(state);
  Forces forces;
  if (has_inertia_) {
    add_rotors(rotors, flow, state.w_NB_B, forces);
  } else {
    add_rotors_without_inertia(flow, forces);
  }
  add_drag(flow, forces.wrench);
  if (params_.ground_effect.kind == GroundEffectKind::kPolynomial) {
    forces.wrench.F_Bcm_B.z() -= polynomial_force(height);
  }
  return forces;
}

void Vehicle::remember_density(double height) {
  if (std::abs(height - density_.height) > kDensityReach)
    density_ = environment_->air_density_profile(height);
}

double Vehicle::air_density(double height) const {
  const bool in_reach = std::abs(height - density_.height) <= kDensityReach;
  return in_reach ? density_.at(height) : environment_->air_density(height);
}

Vehicle::Flow Vehicle::flow_at(const RigidBodyState& state) const {
  const double height = -state.p_NB_N.z();
  const Matrix3 R_NB = state.q_NB.toRotationMatrix();
  Flow flow;
  flow.V_a_B = R_NB.transpose() * (state.v_NB_N - environment_->wind_N());
  flow.density = density_.at(height);
  flow.inflow = rotor_.inflow(-flow.V_a_B.z());
  flow.gain = thrust_gain(height);
  return flow;
}

double Vehicle::thrust_gain(double height) const {
  if (params_.ground_effect.kind != GroundEffectKind::kThrustProportional) return 1.0;
  // Nearer than half a radius the formula is outside its measurements.
  const double radius = 0.5 * params_.rotor.diameter;
  const double ratio = radius / (4.0 * std::max(height - hub_z_, 0.5 * radius));
  return 1.0 / (1.0 - ratio * ratio);
}

void Vehicle::add_rotors(const RotorSpeeds& rotors, const Flow& flow, const Vector3& w_NB_B,
                         Forces& forces) const {
  const double voltage = terminal_voltage(rotors);
  const double J_r = params_.rotor.inertia;
  const double K = params_.rotor.K_V;
  double thrust_sum = 0.0;
  double h_z = 0.0;  // angular momentum of the rotors along Bz
  Vector3 M_B = Vector3::Zero();
  for (int i = 0; i < rotor_count_; ++i) {
    const double speed = std::max(rotors[i], 0.0);
    const double thrust = efficiency_[i] * flow.gain * rotor_.thrust(speed, flow.inflow, flow.density);
    // Without power the blades still brake in the air, even when they count for nothing else.
    const double braking = efficiency_[i] > 0.0 ? efficiency_[i] : 1.0;
    const double torque = braking * rotor_.torque(speed, flow.inflow, flow.density);
    const double driven = drive_[i] > 0.0 ? rotor_.current(drive_[i] * voltage, speed) : 0.0;
    const double shaft_torque = K * (driven - rotor_.friction_current(speed));
    forces.rotor_acceleration[i] = (shaft_torque - torque) * inverse_rotor_inertia_;
    thrust_sum += thrust;
    M_B.x() -= y_[i] * thrust;
    M_B.y() += x_[i] * thrust;
    M_B.z() -= direction_[i] * shaft_torque;  // Q + J_r dw/dt
    h_z += direction_[i] * J_r * speed;
  }
  M_B.x() -= w_NB_B.y() * h_z;
  M_B.y() += w_NB_B.x() * h_z;
  forces.wrench.F_Bcm_B.z() = -thrust_sum;
  forces.wrench.M_Bcm_B = M_B;
}

void Vehicle::add_rotors_without_inertia(const Flow& flow, Forces& forces) const {
  double thrust_sum = 0.0;
  Vector3 M_B = Vector3::Zero();
  for (int i = 0; i < rotor_count_; ++i) {
    const double speed = rotor_.balance_speed(drive_[i] * voltage_, flow.inflow, flow.density);
    const double thrust = efficiency_[i] * flow.gain * rotor_.thrust(speed, flow.inflow, flow.density);
    const double torque = efficiency_[i] * rotor_.torque(speed, flow.inflow, flow.density);
    thrust_sum += thrust;
    M_B.x() -= y_[i] * thrust;
    M_B.y() += x_[i] * thrust;
    M_B.z() -= direction_[i] * torque;
  }
  forces.wrench.F_Bcm_B.z() = -thrust_sum;
  forces.wrench.M_Bcm_B = M_B;
}

void Vehicle::add_drag(const Flow& flow, Wrench& wrench) const {
  const double speed = flow.V_a_B.norm();
  if (speed < kStillAir) return;
  const double induced = params_.drag.induced * wrench.F_Bcm_B.z();  // thrust is along -Bz
  wrench.F_Bcm_B -= flow.density * drag_area_ * speed * flow.V_a_B;
  wrench.F_Bcm_B.x() += induced * flow.V_a_B.x();
  wrench.F_Bcm_B.y() += induced * flow.V_a_B.y();
}

double Vehicle::polynomial_force(double height) const {
  double force = 0.0;
  for (const double coefficient : params_.ground_effect.polynomial) force = force * height + coefficient;
  return std::max(force, 0.0);
}

double Vehicle::terminal_voltage(const RotorSpeeds& rotors) const {
  const double open = battery_.open_voltage();
  if (battery_.resistance() == 0.0) return open;
  // V = open - R_b sum of d_i (d_i V - K_V w_i)/R, solved for V.
  double squares = 0.0;
  double back_emf = 0.0;
  for (int i = 0; i < rotor_count_; ++i) {
    squares += drive_[i] * drive_[i];
    back_emf += drive_[i] * params_.rotor.K_V * std::max(rotors[i], 0.0);
  }
  const double ratio = battery_.resistance() * rotor_.conductance();
  return std::min((open + ratio * back_emf) / (1.0 + ratio * squares), open);
}

double Vehicle::drawn_current(double voltage, const RotorSpeeds& rotors) const {
  double current = 0.0;
  for (int i = 0; i < rotor_count_; ++i) {
    current += drive_[i] * rotor_.current(drive_[i] * voltage, std::max(rotors[i], 0.0));
  }
  return std::max(current, 0.0);
}

void Vehicle::settle(const RigidBodyState& state, RotorSpeeds& rotors) {
  if (has_inertia_) return;
  const Flow flow = flow_at(state);
  for (int i = 0; i < rotor_count_; ++i) {
    rotors[i] = rotor_.balance_speed(drive_[i] * voltage_, flow.inflow, flow.density);
  }
}

void Vehicle::finish_step(double dt, const RigidBodyState&, const RotorSpeeds& rotors) {
  voltage_ = terminal_voltage(rotors);
  current_ = drawn_current(voltage_, rotors);
  battery_.draw(current_, dt);
}

void Vehicle::set_rotor_efficiency(int rotor, double efficiency) {
  if (rotor < 0 || rotor >= rotor_count_) return;
  efficiency_[rotor] = share(efficiency);
  drive_[rotor] = efficiency_[rotor] > 0.0 ? command_[rotor] : 0.0;
}

void Vehicle::set_battery_charge(double fraction) {
  battery_.set_charge(fraction);
}

void Vehicle::set_payload(double payload) {
  mass_properties_.mass = params_.mass + std::max(payload, 0.0);
}

RotorSpeeds Vehicle::equilibrium_speeds() const {
  const double thrust = mass_properties_.mass * environment_->gravity() / rotor_count_;
  const double per_square = rotor_.thrust(1.0, 0.0, environment_->air_density(0.0));
  RotorSpeeds speeds = RotorSpeeds::Zero();
  speeds.head(rotor_count_).setConstant(std::sqrt(thrust / per_square));
  return speeds;
}

double Vehicle::equilibrium_command() const {
  const RotorParams& p = params_.rotor;
  const double speed = equilibrium_speeds()[0];
  const double torque = rotor_.torque(speed, 0.0, environment_->air_density(0.0));
  const double current = torque / p.K_V + p.no_load_current;
  const double wanted = p.K_V * speed + p.resistance * current;
  // wanted = c (open - R_b n c current), of which the smaller root is meant.
  const double open = battery_.open_voltage();
  const double discriminant = open * open - 4.0 * battery_.resistance() * rotor_count_ * current * wanted;
  return std::min(2.0 * wanted / (open + std::sqrt(std::max(discriminant, 0.0))), 1.0);
}

}  // namespace ironbird::simulator
