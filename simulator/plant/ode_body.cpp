#include "simulator/plant/ode_body.hpp"

#include <array>
#include <cstdarg>
#include <stdexcept>

#include "simulator/frames/ned_nwu.hpp"

namespace ironbird::simulator {
namespace {

static_assert(sizeof(dReal) == sizeof(double), "ODE must be built in double precision");

/// A vehicle on its feet is a critically damped oscillator of this frequency: it sinks in by g over its
/// square.
constexpr double kContactFrequency = 150.0;  // rad/s

[[noreturn]] void on_error(int, const char* message, va_list) {
  throw std::runtime_error(message);
}

void on_message(int, const char*, va_list) {}

/// Opens the library before and closes it after everything that uses it.
struct Library {
  Library() {
    dInitODE2(0);
    dSetErrorHandler(on_error);
    dSetDebugHandler(on_error);
    dSetMessageHandler(on_message);
  }
  ~Library() { dCloseODE(); }
};

const Library kLibrary;

Vector3 vector_of(const dReal* v) {
  return {v[0], v[1], v[2]};
}

}  // namespace

OdeBody::OdeBody(const ContactParams& vehicle, const FieldParams& field)
    : threading_(dThreadingAllocateSelfThreadedImplementation()),
      world_(dWorldCreate()),
      body_(dBodyCreate(world_)),
      shapes_(dSimpleSpaceCreate(nullptr)),
      obstacles_(dSimpleSpaceCreate(nullptr)),
      contacts_(dJointGroupCreate(0)),
      friction_(vehicle.friction),
      feet_(static_cast<int>(vehicle.feet.size())) {
  // Left alone all worlds share one queue of jobs, and two threads must not step at once.
  dWorldSetStepThreadingImplementation(world_, dThreadingImplementationGetFunctions(threading_), threading_);
  dBodySetFiniteRotationMode(body_, 1);
  dBodySetAutoDisableFlag(body_, 0);
  add_obstacles(field);
  add_shapes(vehicle);
}

OdeBody::~OdeBody() {
  dJointGroupDestroy(contacts_);
  dSpaceDestroy(shapes_);
  dSpaceDestroy(obstacles_);
  dWorldDestroy(world_);
  dThreadingFreeImplementation(threading_);
}

void OdeBody::add_obstacles(const FieldParams& field) {
  if (field.ground) dCreatePlane(obstacles_, 0.0, 0.0, 1.0, 0.0);
  for (const BoxObstacle& box : field.boxes) {
    const Vector3 size = 2.0 * box.half_size;
    const Vector3 position = ned_nwu(box.position);
    const dGeomID geom = dCreateBox(obstacles_, size.x(), size.y(), size.z());
    dMatrix3 rotation;
    dRFromAxisAndAngle(rotation, 0.0, 0.0, 1.0, -box.heading);
    dGeomSetPosition(geom, position.x(), position.y(), position.z());
    dGeomSetRotation(geom, rotation);
  }
}

void OdeBody::add_shapes(const ContactParams& vehicle) {
  for (const Vector3& foot : vehicle.feet) {
    const Vector3 position = ned_nwu(foot);
    const dGeomID geom = dCreateSphere(shapes_, vehicle.foot_radius);
    dGeomSetBody(geom, body_);
    dGeomSetOffsetPosition(geom, position.x(), position.y(), position.z());
  }
  const Vector3 size = 2.0 * vehicle.body_half_size;
  dGeomSetBody(dCreateBox(shapes_, size.x(), size.y(), size.z()), body_);
}

void OdeBody::configure(const MassProperties& mass, double gravity) {
  const Vector3 signs = ned_nwu(Vector3(1.0, 1.0, 1.0));
  const Matrix3 J = signs.asDiagonal() * mass.J_Bcm_B * signs.asDiagonal();
  dMass parameters;
  dMassSetParameters(&parameters, mass.mass, 0.0, 0.0, 0.0, J(0, 0), J(1, 1), J(2, 2), J(0, 1), J(0, 2),
                     J(1, 2));
  dBodySetMass(body_, &parameters);
  dWorldSetGravity(world_, 0.0, 0.0, -gravity);
  mass_ = mass.mass;
}

void OdeBody::write(const RigidBodyState& state) {
  const Vector3 p = ned_nwu(state.p_NB_N);
  const Quaternion q = ned_nwu(state.q_NB);
  const Vector3 v = ned_nwu(state.v_NB_N);
  const Vector3 w = ned_nwu(Vector3(state.q_NB * state.w_NB_B));
  const dQuaternion quaternion = {q.w(), q.x(), q.y(), q.z()};
  dBodySetPosition(body_, p.x(), p.y(), p.z());
  dBodySetQuaternion(body_, quaternion);
  dBodySetLinearVel(body_, v.x(), v.y(), v.z());
  dBodySetAngularVel(body_, w.x(), w.y(), w.z());
}

RigidBodyState OdeBody::read() const {
  const dReal* q = dBodyGetQuaternion(body_);
  RigidBodyState state;
  state.p_NB_N = ned_nwu(vector_of(dBodyGetPosition(body_)));
  state.q_NB = ned_nwu(Quaternion(q[0], q[1], q[2], q[3]));
  state.v_NB_N = ned_nwu(vector_of(dBodyGetLinearVel(body_)));
  state.w_NB_B = state.q_NB.conjugate() * ned_nwu(vector_of(dBodyGetAngularVel(body_)));
  return state;
}

int OdeBody::find_contacts(double dt) {
  dAllocateODEDataForThread(dAllocateMaskAll);  // does nothing when this thread has been here before
  // A spring and a damper as ODE wants them: soft error reduction and constraint force mixing.
  const double stiffness = mass_ * kContactFrequency * kContactFrequency / feet_;
  const double damping = 2.0 * mass_ * kContactFrequency / feet_;
  dSurfaceParameters surface{};
  surface.mode = dContactSoftERP | dContactSoftCFM | dContactApprox1;
  surface.mu = friction_;
  surface.soft_erp = dt * stiffness / (dt * stiffness + damping);
  surface.soft_cfm = 1.0 / (dt * stiffness + damping);
  int found = 0;
  for (int i = 0; i < dSpaceGetNumGeoms(shapes_); ++i) {
    for (int k = 0; k < dSpaceGetNumGeoms(obstacles_); ++k) {
      found += find_contacts_between(dSpaceGetGeom(shapes_, i), dSpaceGetGeom(obstacles_, k), surface);
    }
  }
  return found;
}

int OdeBody::find_contacts_between(dGeomID shape, dGeomID obstacle, const dSurfaceParameters& surface) {
  std::array<dContactGeom, kMostContacts> points;
  const int found = dCollide(shape, obstacle, kMostContacts, points.data(), sizeof(dContactGeom));
  for (int i = 0; i < found; ++i) {
    dContact contact{};
    contact.surface = surface;
    contact.geom = points[i];
    dJointAttach(dJointCreateContact(world_, contacts_, &contact), body_, nullptr);
  }
  return found;
}

void OdeBody::forget_contacts() {
  dJointGroupEmpty(contacts_);
}

void OdeBody::step(double dt, const Vector3& F_N, const Vector3& M_N, bool gyroscopic) {
  const Vector3 F = ned_nwu(F_N);
  const Vector3 M = ned_nwu(M_N);
  dBodySetGyroscopicMode(body_, gyroscopic);
  dBodyAddForce(body_, F.x(), F.y(), F.z());
  dBodyAddTorque(body_, M.x(), M.y(), M.z());
  dWorldStep(world_, dt);
}

}  // namespace ironbird::simulator
