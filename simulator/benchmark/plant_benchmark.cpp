// What a step of 2.5 ms costs, beside yardsticks: a bare step of the engine on the leanest model, the
// engine's step on the model one would write first, and our own integrator. The promise is a ratio within one
// run: our MuJoCo step with all forces, in the air, costs at most 1.25 bare lean steps.

#include <benchmark/benchmark.h>

#include <memory>
#include <string_view>
#include <utility>

#include "ci/yardstick/bare_mujoco.hpp"
#include "ci/yardstick/in_turns.hpp"
#include "simulator/plant/mujoco_plant.hpp"
#include "simulator/plant/ode_plant.hpp"
#include "simulator/plant/rigid_body_plant.hpp"
#include "simulator/vehicle/vehicle.hpp"

namespace ironbird::simulator {
namespace {

constexpr double kStep = 2.5e-3;                    // s
constexpr double kContactStep = 0.5e-3;             // s
constexpr int kRestart = 10000;                     // steps
constexpr int kBatch = 400;                         // steps in one turn
constexpr double kHoverThrust = 0.25 * 3.5 * 9.81;  // N, of one rotor of the naive model

VehicleParams vehicle_params() {
  VehicleParams params = reference_multirotor();
  params.rotor.inertia = 3e-4;
  params.rotor.resistance = 0.108;
  params.ground_effect.kind = GroundEffectKind::kThrustProportional;
  params.battery = {.cells = 6, .resistance = 0.015};
  return params;
}

/// The model one would write first.
constexpr std::string_view kNaiveModel =
    R"(<mujoco><option timestep="0.0025" integrator="RK4" density="1.2" viscosity="2e-5"/>
  <worldbody><geom type="plane" size="0 0 1"/><body><freejoint/>
  <geom type="box" size="0.1 0.1 0.03" mass="2.3"/>
  <geom type="cylinder" size="0.19 0.005" pos="0.18 -0.18 0.03" mass="0.3"/>
  <geom type="cylinder" size="0.19 0.005" pos="-0.18 -0.18 0.03" mass="0.3"/>
  <geom type="cylinder" size="0.19 0.005" pos="-0.18 0.18 0.03" mass="0.3"/>
  <geom type="cylinder" size="0.19 0.005" pos="0.18 0.18 0.03" mass="0.3"/>
  <geom type="box" size="0.15 0.15 0.01" pos="0 0 -0.15"/>
  <site name="a" pos="0.18 -0.18 0.03"/><site name="b" pos="-0.18 -0.18 0.03"/>
  <site name="c" pos="-0.18 0.18 0.03"/><site name="d" pos="0.18 0.18 0.03"/></body></worldbody>
  <actuator><motor site="a" gear="0 0 1 0 0 -0.0187"/><motor site="b" gear="0 0 1 0 0 0.0187"/>
  <motor site="c" gear="0 0 1 0 0 -0.0187"/><motor site="d" gear="0 0 1 0 0 0.0187"/></actuator></mujoco>)";

/// The whole vehicle on a plant: one call is one step of 2.5 ms, or of 0.5 ms at rest on the ground.
class Flight {
 public:
  explicit Flight(std::unique_ptr<Plant> plant, bool on_ground = false)
      : plant_(std::move(plant)), dt_(on_ground ? kContactStep : kStep) {
    plant_->configure(vehicle_.mass_properties(), environment_.gravity());
    start_.p_NB_N.z() = on_ground ? -0.22 : -1e4;
    if (!on_ground) {
      speeds_ = vehicle_.equilibrium_speeds();
      hover_ = vehicle_.equilibrium_command();
    }
    plant_->reset(start_, speeds_);
  }
  Flight(const Flight&) = delete;
  Flight& operator=(const Flight&) = delete;

  void step() {
    RotorCommands commands;
    commands.throttle.fill(hover_);
    commands.throttle[0] += (++count_ & 1) != 0 ? 1e-3 : -1e-3;
    if (count_ % kRestart == 0) {  // or the battery would run down and the vehicle come to the ground
      vehicle_.set_battery_charge(1.0);
      plant_->reset(start_, speeds_);
    }
    vehicle_.set_commands(commands);
    plant_->step(dt_, vehicle_);
    vehicle_.finish_step(dt_, plant_->state(), plant_->rotors());
  }

  const char* failure() const { return plant_->failure(); }

 private:
  std::unique_ptr<Plant> plant_;
  double dt_;
  Environment environment_{EnvironmentParams{}, 1};
  Vehicle vehicle_{vehicle_params(), environment_};
  RigidBodyState start_;
  RotorSpeeds speeds_ = RotorSpeeds::Zero();
  double hover_ = 0.0;
  int count_ = 0;
};

std::unique_ptr<Plant> mujoco() {
  return make_mujoco_plant(vehicle_params(), FieldParams{});
}
std::unique_ptr<Plant> ode() {
  return make_ode_plant(vehicle_params(), FieldParams{});
}

void beside_engine(benchmark::State& state, double goal, std::unique_ptr<Plant> plant, bool on_ground,
                   std::string_view model = yardstick::kLeanModel) {
  Flight flight(std::move(plant), on_ground);
  yardstick::BareMujoco bare(model);
  bare.set_controls(kHoverThrust);
  yardstick::in_turns(
      state, {.goal = goal, .batch = kBatch}, [&] { flight.step(); }, [&] { bare.step(); }, [] {});
  if (flight.failure() != nullptr) state.SkipWithError(flight.failure());
}

void MujocoInFlightBesideBareMujoco(benchmark::State& state) {
  beside_engine(state, 1.25, mujoco(), false);
}
void MujocoInFlightBesideNaiveMujoco(benchmark::State& state) {
  beside_engine(state, 0.35, mujoco(), false, kNaiveModel);
}
void MujocoAtRestBesideBareMujoco(benchmark::State& state) {
  beside_engine(state, 0.0, mujoco(), true);
}
void OdeInFlightBesideBareMujoco(benchmark::State& state) {
  beside_engine(state, 0.0, ode(), false);
}
void OdeAtRestBesideBareMujoco(benchmark::State& state) {
  beside_engine(state, 0.0, ode(), true);
}
void OwnInFlightBesideRk4(benchmark::State& state) {
  Flight flight(std::make_unique<RigidBodyPlant>());
  yardstick::beside_rk4(state, 0.0, [&] { flight.step(); });
}

void ForcesOfOneStageBesideRk4(benchmark::State& timing) {
  Environment environment(EnvironmentParams{}, 1);
  Vehicle vehicle(vehicle_params(), environment);
  RotorCommands commands;
  commands.throttle.fill(vehicle.equilibrium_command());
  vehicle.set_commands(commands);
  RigidBodyState state;
  state.p_NB_N.z() = -50.0;
  state.v_NB_N = {1.0, 2.0, -3.0};
  const RotorSpeeds speeds = vehicle.equilibrium_speeds();
  yardstick::beside_rk4(timing, 0.0, [&] {
    benchmark::DoNotOptimize(state);
    benchmark::DoNotOptimize(vehicle.evaluate(state, speeds, 1e-3));
  });
}

BENCHMARK(MujocoInFlightBesideBareMujoco)->UseManualTime();
BENCHMARK(MujocoInFlightBesideNaiveMujoco)->UseManualTime();
BENCHMARK(OdeInFlightBesideBareMujoco)->UseManualTime();
BENCHMARK(OwnInFlightBesideRk4)->UseManualTime();
BENCHMARK(ForcesOfOneStageBesideRk4)->UseManualTime();
BENCHMARK(MujocoAtRestBesideBareMujoco)->UseManualTime();
BENCHMARK(OdeAtRestBesideBareMujoco)->UseManualTime();

}  // namespace
}  // namespace ironbird::simulator
