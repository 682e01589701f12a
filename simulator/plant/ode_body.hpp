#pragma once

#include <ode/ode.h>

#include "simulator/plant/field.hpp"
#include "simulator/plant/plant.hpp"
#include "simulator/vehicle/vehicle_params.hpp"

namespace ironbird::simulator {

/// One free body in a world of ODE's, with shapes on it and obstacles around. NED and FRD outside.
class OdeBody {
 public:
  OdeBody(const ContactParams& vehicle, const FieldParams& field);
  ~OdeBody();
  OdeBody(const OdeBody&) = delete;
  OdeBody& operator=(const OdeBody&) = delete;

  void configure(const MassProperties& mass, double gravity);
  void write(const RigidBodyState& state);
  RigidBodyState read() const;

  /// Makes a joint of every point of contact. @param dt the coming step, s. @return their number
  int find_contacts(double dt);
  void forget_contacts();

  /// One step of the engine's own with force and torque held, both in N. The engine adds gravity.
  /// @param gyroscopic  let the engine add the gyroscopic torque, in its damping form
  void step(double dt, const Vector3& F_N, const Vector3& M_N, bool gyroscopic);

 private:
  static constexpr int kMostContacts = 8;  // between two shapes

  void add_obstacles(const FieldParams& field);
  void add_shapes(const ContactParams& vehicle);
  int find_contacts_between(dGeomID shape, dGeomID obstacle, const dSurfaceParameters& surface);

  dThreadingImplementationID threading_;
  dWorldID world_;
  dBodyID body_;
  dSpaceID shapes_;
  dSpaceID obstacles_;
  dJointGroupID contacts_;
  double friction_;
  int feet_;
  double mass_ = 1.0;
};

}  // namespace ironbird::simulator
