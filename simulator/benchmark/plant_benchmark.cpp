// What a step of 2.5 ms costs, beside yardsticks: a bare step of the engine on the leanest model, the
// engine's step on the model one would write first, and our own integrator. The promise is a ratio within one
// run: our MuJoCo step with all forces, in the air, costs at most 1.25 bare lean steps.

#include <benchmark/benchmark.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <memory>
#include <string>

#include "simulator/plant/mujoco_plant.hpp"
#include "simulator/plant/ode_plant.hpp"
#include "simulator/plant/rigid_body_plant.hpp"
#include "simulator/vehicle/vehicle.hpp"

namespace ironbird::simulator {
namespace {

constexpr double kStep = 2.5e-3;         // s
constexpr double kContactStep = 0.5e-3;  // s
constexpr int kRestart = 10000;          // steps

VehicleParams vehicle_params() {
  VehicleParams params = reference_multirotor();
  params.rotor.inertia = 3e-4;
  params.rotor.resistance = 0.108;
  params.ground_effect.kind = GroundEffectKind::kThrustProportional;
  params.battery = {.cells = 6, .resistance = 0.015};
  return params;
}

void fly(benchmark::State& timing, Plant& plant, double height, double dt) {
  Environment environment(EnvironmentParams{}, 1);
  Vehicle vehicle(vehicle_params(), environment);
  plant.configure(vehicle.mass_properties(), environment.gravity());
  RigidBodyState state;
  state.p_NB_N.z() = -height;
  const RotorSpeeds speeds = height > 1.0 ? vehicle.equilibrium_speeds() : RotorSpeeds::Zero();
  plant.reset(state, speeds);
  const double hover = height > 1.0 ? vehicle.equilibrium_command() : 0.0;
  int i = 0;
  for (auto _ : timing) {
    RotorCommands commands;
    commands.throttle.fill(hover);
    commands.throttle[0] += (++i & 1) != 0 ? 1e-3 : -1e-3;
    if (i % kRestart == 0) {  // or the battery would run down and the vehicle come to the ground
      vehicle.set_battery_charge(1.0);
      plant.reset(state, speeds);
    }
    vehicle.set_commands(commands);
    plant.step(dt, vehicle);
    vehicle.finish_step(dt, plant.state(), plant.rotors());
  }
  benchmark::DoNotOptimize(plant.state().p_NB_N.x());
  if (plant.failure() != nullptr) timing.SkipWithError(plant.failure());
}

void MujocoInFlight(benchmark::State& timing) {
  fly(timing, *make_mujoco_plant(vehicle_params(), FieldParams{}), 1e4, kStep);
}
void OdeInFlight(benchmark::State& timing) {
  fly(timing, *make_ode_plant(vehicle_params(), FieldParams{}), 1e4, kStep);
}
void OwnInFlight(benchmark::State& timing) {
  RigidBodyPlant plant;
  fly(timing, plant, 1e4, kStep);
}
void MujocoAtRest(benchmark::State& timing) {
  fly(timing, *make_mujoco_plant(vehicle_params(), FieldParams{}), 0.22, kContactStep);
}
void OdeAtRest(benchmark::State& timing) {
  fly(timing, *make_ode_plant(vehicle_params(), FieldParams{}), 0.22, kContactStep);
}

/// The engine alone: a model as text, one step after the other.
void step_bare(benchmark::State& timing, const std::string& mjcf) {
  const std::unique_ptr<mjVFS> files = std::make_unique<mjVFS>();
  mj_defaultVFS(files.get());
  mj_makeEmptyFileVFS(files.get(), "bare.xml", static_cast<int>(mjcf.size()));
  std::copy(mjcf.begin(), mjcf.end(), static_cast<char*>(files->filedata[0]));
  char complaint[500] = "";
  mjModel* model = mj_loadXML("bare.xml", files.get(), complaint, sizeof complaint);
  mj_deleteVFS(files.get());
  if (model == nullptr) {
    timing.SkipWithError(complaint);
    return;
  }
  mjData* data = mj_makeData(model);
  data->qpos[2] = 1e6;
  std::fill_n(data->ctrl, model->nu, 0.25 * 3.5 * 9.81);
  data->qvel[3] = 0.1;
  for (auto _ : timing) mj_step(model, data);
  mj_deleteData(data);
  mj_deleteModel(model);
}

void BareLeanMujoco(benchmark::State& timing) {
  step_bare(timing, R"(<mujoco><option timestep="0.0025" integrator="RK4">
    <flag equality="disable" frictionloss="disable" limit="disable" constraint="disable" contact="disable"
     passive="disable" clampctrl="disable" sensor="disable"/></option>
    <worldbody><body><freejoint/><inertial pos="0 0 0" mass="3.5" diaginertia="0.08 0.08 0.12"/></body>
    </worldbody></mujoco>)");
}

void NaiveMujoco(benchmark::State& timing) {
  step_bare(timing, R"(<mujoco><option timestep="0.0025" integrator="RK4" density="1.2" viscosity="2e-5"/>
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
    <motor site="c" gear="0 0 1 0 0 -0.0187"/><motor site="d" gear="0 0 1 0 0 0.0187"/></actuator></mujoco>)");
}

void ForcesOfOneStage(benchmark::State& timing) {
  Environment environment(EnvironmentParams{}, 1);
  Vehicle vehicle(vehicle_params(), environment);
  RotorCommands commands;
  commands.throttle.fill(vehicle.equilibrium_command());
  vehicle.set_commands(commands);
  RigidBodyState state;
  state.p_NB_N.z() = -50.0;
  state.v_NB_N = {1.0, 2.0, -3.0};
  const RotorSpeeds speeds = vehicle.equilibrium_speeds();
  for (auto _ : timing) {
    benchmark::DoNotOptimize(state);
    benchmark::DoNotOptimize(vehicle.evaluate(state, speeds, 1e-3));
  }
}

BENCHMARK(BareLeanMujoco);
BENCHMARK(MujocoInFlight);
BENCHMARK(NaiveMujoco);
BENCHMARK(OwnInFlight);
BENCHMARK(OdeInFlight);
BENCHMARK(ForcesOfOneStage);
BENCHMARK(MujocoAtRest);
BENCHMARK(OdeAtRest);

}  // namespace
}  // namespace ironbird::simulator
