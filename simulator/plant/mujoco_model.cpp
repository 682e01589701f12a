#include "simulator/plant/mujoco_model.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cstring>
#include <iomanip>
#include <sstream>
#include <stdexcept>

#include "simulator/frames/ned_nwu.hpp"

namespace ironbird::simulator {
namespace {

constexpr int kVehicle = 1;  // the body after the world's
constexpr const char* kFileName = "vehicle.xml";
constexpr std::size_t kRowsOfContact = 3;   // of the solver: normal and two tangents
constexpr std::size_t kContactsOfBody = 8;  // between two boxes, at the most

/// The beginning of a model. No option is left to a default that could bring in a force which is not ours.
/// @param option  further attributes of the options
/// @param flag    further flags
/// @param contacts  the most there can be at once: the engine's own guess takes megabytes
std::string head(const std::string& option, const std::string& flag, std::size_t contacts) {
  const std::string rows = std::to_string(kRowsOfContact * contacts);
  return R"(<mujoco model="vehicle"><compiler angle="radian" inertiafromgeom="false"/>)"
         R"(<option integrator="RK4" density="0" viscosity="0" )" +
         option +
         R"(><flag equality="disable" frictionloss="disable" limit="disable" passive="disable" )"
         R"(clampctrl="disable" sensor="disable" )" +
         flag + R"(/></option><size nuserdata="1" nconmax=")" + std::to_string(contacts) + R"(" njmax=")" +
         rows + R"("/><worldbody>)";
}

constexpr const char* kBody = R"(<body><freejoint/><inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>)";
constexpr const char* kBodyEnd = "</body></worldbody>";
constexpr const char* kEnd = "</mujoco>";

std::ostringstream exact_text() {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << std::setprecision(17);
  return text;
}

void write(std::ostream& text, const char* attribute, const Vector3& value) {
  text << ' ' << attribute << "=\"" << value.x() << ' ' << value.y() << ' ' << value.z() << '"';
}

/// The beginning of a shape. @param name  kind of thing and number
void begin_geom(std::ostream& text, const char* kind, std::size_t number, const char* type) {
  text << "<geom name=\"" << kind << number << "\" type=\"" << type << '"';
}

/// @return their number
std::size_t write_obstacles(std::ostream& text, const FieldParams& field) {
  std::size_t count = 0;
  if (field.ground) {
    begin_geom(text, "obstacle", count++, "plane");
    text << R"( size="0 0 1"/>)";
  }
  for (const BoxObstacle& box : field.boxes) {
    begin_geom(text, "obstacle", count++, "box");
    write(text, "pos", ned_nwu(box.position));
    write(text, "size", box.half_size);
    text << " euler=\"0 0 " << -box.heading << "\"/>";
  }
  return count;
}

/// @return the number of its shapes
std::size_t write_vehicle(std::ostream& text, const ContactParams& vehicle) {
  std::size_t count = 0;
  for (const Vector3& foot : vehicle.feet) {
    begin_geom(text, "part", count++, "sphere");
    text << " size=\"" << vehicle.foot_radius << '"';
    write(text, "pos", ned_nwu(foot));
    text << "/>";
  }
  begin_geom(text, "part", count++, "box");
  write(text, "size", vehicle.body_half_size);
  text << "/>";
  return count;
}

/// What can touch what, all of it, so that the engine need not sort the shapes in every stage. The impedance
/// is the engine's usual one, but grows linearly with the depth: its usual curve takes two powers for each
/// contact.
void write_pairs(std::ostream& text, std::size_t parts, std::size_t obstacles, double friction) {
  text << "<contact>";
  for (std::size_t part = 0; part < parts; ++part) {
    for (std::size_t obstacle = 0; obstacle < obstacles; ++obstacle) {
      text << "<pair geom1=\"obstacle" << obstacle << "\" geom2=\"part" << part << "\" friction=\""
           << friction << ' ' << friction << R"( 0.005 0.0001 0.0001" solimp="0.9 0.95 0.001 0.5 1"/>)";
    }
  }
  text << "</contact>";
}

struct Principal {
  Vector3 moments;
  Quaternion axes;  // takes principal to body components
};

/// Diagonal matrices keep their axes, so that nothing is rounded.
Principal principal_axes(const Matrix3& J) {
  if (Matrix3(J.diagonal().asDiagonal()) == J) return {J.diagonal(), Quaternion::Identity()};
  const Eigen::SelfAdjointEigenSolver<Matrix3> solver(J);
  Matrix3 axes = solver.eigenvectors();
  if (axes.determinant() < 0.0) axes.col(2) *= -1.0;
  return {solver.eigenvalues(), Quaternion(axes)};
}

Matrix3 ned_nwu_inertia(const Matrix3& J) {
  const Vector3 signs = ned_nwu(Vector3(1.0, 1.0, 1.0));
  return signs.asDiagonal() * J * signs.asDiagonal();
}

mjModel* load(const std::string& mjcf) {
  const std::unique_ptr<mjVFS> files = std::make_unique<mjVFS>();
  mj_defaultVFS(files.get());
  const int size = static_cast<int>(mjcf.size());
  if (mj_makeEmptyFileVFS(files.get(), kFileName, size) != 0) {
    throw std::invalid_argument("field.boxes: the model is too large for the engine");
  }
  std::copy(mjcf.begin(), mjcf.end(), static_cast<char*>(files->filedata[0]));
  char complaint[500] = "";
  mjModel* model = mj_loadXML(kFileName, files.get(), complaint, sizeof complaint);
  mj_deleteVFS(files.get());
  if (model == nullptr)
    throw std::invalid_argument("the engine refuses the model: " +
                                std::string(complaint, std::strcspn(complaint, "\n")));
  return model;
}

}  // namespace

std::string flight_model() {
  return head("", R"(constraint="disable" contact="disable")", 1) + kBody + kBodyEnd + kEnd;
}

std::string contact_model(const ContactParams& vehicle, const FieldParams& field) {
  std::ostringstream text = exact_text();
  // Soft contacts creep under a steady side force; the extra iterations hold them.
  const std::size_t things = field.boxes.size() + 1;
  text << head(R"(cone="elliptic" noslip_iterations="5" collision="predefined")", "",
               things * (vehicle.feet.size() + kContactsOfBody));
  const std::size_t obstacles = write_obstacles(text, field);
  text << kBody;
  const std::size_t parts = write_vehicle(text, vehicle);
  text << kBodyEnd;
  write_pairs(text, parts, obstacles, vehicle.friction);
  text << kEnd;
  return text.str();
}

MujocoModel::MujocoModel(const std::string& mjcf) : model_(load(mjcf)), data_(mj_makeData(model_.get())) {
  if (data_ == nullptr) throw std::invalid_argument("the engine cannot allocate its data");
}

void MujocoModel::configure(const MassProperties& mass, double gravity) {
  const Principal principal = principal_axes(ned_nwu_inertia(mass.J_Bcm_B));
  const Quaternion& axes = principal.axes;
  mjModel& m = *model_;
  m.body_mass[kVehicle] = mass.mass;
  std::copy_n(principal.moments.data(), 3, m.body_inertia + 3 * kVehicle);
  const mjtNum quaternion[4] = {axes.w(), axes.x(), axes.y(), axes.z()};
  std::copy_n(quaternion, 4, m.body_iquat + 4 * kVehicle);
  // The engine's short cuts hold only when the principal axes are the body's.
  const bool aligned = axes.vec().isZero(0.0);
  m.body_sameframe[kVehicle] = aligned;
  m.body_simple[kVehicle] = aligned;
  for (int dof = 0; dof < m.nv; ++dof) m.dof_simplenum[dof] = aligned ? m.nv - dof : 0;
  m.opt.gravity[0] = m.opt.gravity[1] = 0.0;
  m.opt.gravity[2] = -gravity;

  RigidBodyState state;
  read(state);
  mj_setConst(&m, data_.get());
  reset(state);
}

void MujocoModel::reset(const RigidBodyState& state) {
  const Vector3 p = ned_nwu(state.p_NB_N);
  const Quaternion q = ned_nwu(state.q_NB);
  const Vector3 v = ned_nwu(state.v_NB_N);
  const Vector3 w = ned_nwu(state.w_NB_B);
  mj_resetData(model_.get(), data_.get());
  const mjtNum qpos[7] = {p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z()};
  const mjtNum qvel[6] = {v.x(), v.y(), v.z(), w.x(), w.y(), w.z()};
  std::copy_n(qpos, 7, data_->qpos);
  std::copy_n(qvel, 6, data_->qvel);
}

void MujocoModel::read(RigidBodyState& state) const {
  const mjtNum* p = data_->qpos;
  const mjtNum* v = data_->qvel;
  state.p_NB_N = ned_nwu(Vector3(p[0], p[1], p[2]));
  state.q_NB = ned_nwu(Quaternion(p[3], p[4], p[5], p[6]));
  state.v_NB_N = ned_nwu(Vector3(v[0], v[1], v[2]));
  state.w_NB_B = ned_nwu(Vector3(v[3], v[4], v[5]));
}

int MujocoModel::bad_values() const {
  const mjWarningStat* w = data_->warning;
  return w[mjWARN_BADQPOS].number + w[mjWARN_BADQVEL].number + w[mjWARN_BADQACC].number;
}

}  // namespace ironbird::simulator
