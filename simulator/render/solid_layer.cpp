#include "simulator/render/solid_layer.hpp"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <string_view>
#include <tuple>
#include <utility>

#include "simulator/frames/ned_nwu.hpp"
#include "simulator/render/offscreen_context.hpp"
#include "simulator/render/plain_words.hpp"
#include "simulator/render/root_scene.hpp"

namespace ironbird::simulator {
namespace {

constexpr const char* kRootName = "ironbird_scene.xml";
constexpr int kMaxGeoms = 4000;

/// The name of a rotor's body and of its joint.
std::string rotor_name(int rotor) {
  return "rotor_" + std::to_string(rotor);
}

/// What the scene lacks to be a vehicle's, or nothing.
std::string lack_of(const mjModel& model) {
  const int vehicle = mj_name2id(&model, mjOBJ_BODY, "vehicle");
  if (vehicle < 0) return "has no body named 'vehicle'";
  const int joint = model.body_jntadr[vehicle];
  if (joint < 0 || model.jnt_type[joint] != mjJNT_FREE) return "the body 'vehicle' has no free joint";
  for (int i = 0; i < kMaxRotors && mj_name2id(&model, mjOBJ_BODY, rotor_name(i).c_str()) >= 0; ++i) {
    const int hinge = mj_name2id(&model, mjOBJ_JOINT, rotor_name(i).c_str());
    if (hinge < 0 || model.jnt_type[hinge] != mjJNT_HINGE)
      return "the body '" + rotor_name(i) + "' has no hinge of its name";
  }
  return "";
}

/// The scene, or null and what is wrong with it.
mjModel* try_model(const std::string& vehicle, const std::string& field, std::string& wrong) {
  const std::string text = root_scene(vehicle, field);
  auto files = std::make_unique<mjVFS>();
  mj_defaultVFS(files.get());
  if (mj_makeEmptyFileVFS(files.get(), kRootName, static_cast<int>(text.size())) != 0) {
    throw std::runtime_error("no picture: the engine refuses a file in memory");
  }
  std::memcpy(files->filedata[mj_findFileVFS(files.get(), kRootName)], text.data(), text.size());
  std::array<char, 1000> error{};
  const std::string root = folder_of_scene(vehicle) + kRootName;
  mjModel* model = mj_loadXML(root.c_str(), files.get(), error.data(), static_cast<int>(error.size()));
  mj_deleteVFS(files.get());
  wrong = model == nullptr ? plain_words(error.data()) : lack_of(*model);
  if (wrong.empty()) return model;
  mj_deleteModel(model);
  return nullptr;
}

mjModel* load_model(const std::string& vehicle, const std::string& field) {
  std::string wrong;
  mjModel* model = try_model(vehicle, field, wrong);
  if (model == nullptr)
    throw std::invalid_argument("scene " + vehicle + " with field " + field + ": " + wrong);
  return model;
}

Vector3 engine_vector(const mjtNum* v) {
  return {v[0], v[1], v[2]};
}

void store(const Vector3& v, float* to) {
  for (int i = 0; i < 3; ++i) {
    to[i] = static_cast<float>(v[i]);
  }
}

struct Sphere {
  Vector3 center_N = Vector3::Zero();
  double radius = 0.0;
};

}  // namespace

void check_scene(const std::string& vehicle, const std::string& field) {
  // The vehicle alone first, so that the file that is wrong can be named.
  for (const std::string& with : {std::string(), field}) {
    std::string wrong;
    mjModel* model = try_model(vehicle, with, wrong);
    if (model == nullptr) throw std::invalid_argument((with.empty() ? vehicle : field) + ": " + wrong);
    mj_deleteModel(model);
  }
}

struct SolidLayer::Engine {
  // Declared before whatever needs OpenGL, so that it is destroyed last.
  OffscreenContext context;
  mjModel* model = nullptr;
  mjData* data = nullptr;
  mjvScene scene{};
  mjrContext renderer{};
  mjvOption option{};
  std::vector<mjvGeom> posed;
  std::vector<bool> hidden;  // by geom of the model
  int vehicle_body = 0;
  int vehicle_joint = 0;

  Engine(const std::string& vehicle, const std::string& field, int max_width, int max_height)
      : model(load_model(vehicle, field)) {
    model->vis.global.offwidth = max_width;
    model->vis.global.offheight = max_height;
    model->vis.quality.offsamples = 0;
    model->vis.quality.shadowsize = 0;
    model->vis.quality.numslices = 16;
    model->vis.quality.numstacks = 8;
    model->vis.quality.numquads = 1;
    data = mj_makeData(model);
    hidden.assign(static_cast<std::size_t>(model->ngeom), false);
    mjv_defaultScene(&scene);
    mjr_defaultContext(&renderer);
    mjv_defaultOption(&option);
    option.sitegroup[0] = 0;
    mjv_makeScene(model, &scene, kMaxGeoms);
    mjr_makeContext(model, &renderer, mjFONTSCALE_300);
    mjr_setBuffer(mjFB_OFFSCREEN, &renderer);
    for (const int flag : {mjRND_SHADOW, mjRND_REFLECTION, mjRND_SKYBOX, mjRND_FOG, mjRND_HAZE}) {
      scene.flags[flag] = 0;
    }
  }

  ~Engine() {
    context.make_current();
    mjr_freeContext(&renderer);
    mjv_freeScene(&scene);
    mj_deleteData(data);
    mj_deleteModel(model);
  }

  int find(mjtObj kind, const std::string& name, const char* what) const {
    const int id = mj_name2id(model, kind, name.c_str());
    if (id < 0) {
      throw std::invalid_argument(std::string("scene has no ") + what + " named '" + name + "'");
    }
    return id;
  }

  bool of_vehicle(int geom) const { return model->body_rootid[model->geom_bodyid[geom]] == vehicle_body; }

  bool belongs(int geom, SolidPart part) const {
    const int bit = static_cast<int>(of_vehicle(geom) ? SolidPart::kVehicle : SolidPart::kField);
    return model->geom_type[geom] != mjGEOM_PLANE && (static_cast<int>(part) & bit) != 0;
  }

  Sphere sphere(int geom) const {
    return {ned_nwu(engine_vector(data->geom_xpos + 3 * geom)), model->geom_rbound[geom]};
  }

  GroundMark mark(const char* site) const {
    const int id = mj_name2id(model, mjOBJ_SITE, site);
    if (id < 0) {
      return {};
    }
    return {ned_nwu(engine_vector(model->site_pos + 3 * id)), model->site_size[3 * id]};
  }

  GroundMark field_sphere() const {
    Vector3 low = Vector3::Constant(1e9);
    Vector3 high = Vector3::Constant(-1e9);
    bool any = false;
    for (int geom = 0; geom < model->ngeom; ++geom) {
      if (belongs(geom, SolidPart::kField)) {
        const Sphere s = sphere(geom);
        low = low.cwiseMin((s.center_N.array() - s.radius).matrix());
        high = high.cwiseMax((s.center_N.array() + s.radius).matrix());
        any = true;
      }
    }
    return any ? GroundMark{0.5 * (low + high), 0.5 * (high - low).norm()} : GroundMark{};
  }

  std::vector<RotorGeometry> find_rotors() const {
    std::vector<RotorGeometry> rotors;
    for (int i = 0; i < kMaxRotors; ++i) {
      const std::string name = rotor_name(i);
      const int body = mj_name2id(model, mjOBJ_BODY, name.c_str());
      if (body < 0) {
        break;
      }
      RotorGeometry rotor;
      rotor.p_B = ned_nwu(engine_vector(model->body_pos + 3 * body));
      rotor.joint_address = model->jnt_qposadr[find(mjOBJ_JOINT, name, "joint")];
      const int first = model->body_geomadr[body];
      for (int g = first; g < first + model->body_geomnum[body]; ++g) {
        const double reach =
            engine_vector(model->geom_pos + 3 * g).head<2>().norm() + model->geom_size[3 * g];
        rotor.radius = std::max(rotor.radius, reach);
      }
      rotors.push_back(rotor);
    }
    return rotors;
  }

  // Nearest and farthest depth of what is selected, with a little room, m.
  std::pair<double, double> depth_range(const Projection& projection) const {
    double nearest = 1e9;
    double farthest = 1.0;
    for (int i = 0; i < scene.ngeom; ++i) {
      const Sphere s = sphere(scene.geoms[i].objid);
      const double depth = projection.forward_N().dot(s.center_N - projection.p_N());
      nearest = std::min(nearest, depth - s.radius);
      farthest = std::max(farthest, depth + s.radius);
    }
    const double near = std::max(kNearPlane, 0.98 * nearest);
    return {near, std::max(1.02 * farthest, near + 1.0)};
  }

  // Points the engine's camera so that the viewport is exactly `rect` of the whole picture.
  void aim(const Projection& projection, const PixelRect& rect, double near, double far) {
    mjvGLCamera& camera = scene.camera[0];
    const double scale = near / projection.focal();
    store(ned_nwu(projection.p_N()), camera.pos);
    store(ned_nwu(projection.forward_N()), camera.forward);
    store(ned_nwu(Vector3(-projection.down_N())), camera.up);
    camera.frustum_center =
        static_cast<float>(scale * (0.5 * (rect.left + rect.right) - projection.center_u()));
    camera.frustum_top = static_cast<float>(scale * (projection.center_v() - rect.top));
    camera.frustum_bottom = static_cast<float>(scale * (projection.center_v() - rect.bottom));
    camera.frustum_near = static_cast<float>(near);
    camera.frustum_far = static_cast<float>(far);
    scene.camera[1] = camera;
  }

  void collect() {
    mjvCamera free_camera;
    mjv_defaultCamera(&free_camera);
    mjv_updateScene(model, data, &option, nullptr, &free_camera, mjCAT_ALL, &scene);
    posed.assign(scene.geoms, scene.geoms + scene.ngeom);
  }

  void select(SolidPart part) {
    scene.ngeom = 0;
    for (const mjvGeom& geom : posed) {
      if (geom.objtype == mjOBJ_GEOM && belongs(geom.objid, part) &&
          !hidden[static_cast<std::size_t>(geom.objid)]) {
        scene.geoms[scene.ngeom++] = geom;
      }
    }
    // Nothing is translucent, so the order of drawing does not matter to the picture.
  }
};

SolidLayer::SolidLayer(const std::string& vehicle, const std::string& field, int max_width, int max_height)
    : engine_(std::make_unique<Engine>(vehicle, field, max_width, max_height)) {
  Engine& engine = *engine_;
  const mjModel& model = *engine.model;
  engine.vehicle_body = engine.find(mjOBJ_BODY, "vehicle", "body");
  engine.vehicle_joint = model.jnt_qposadr[model.body_jntadr[engine.vehicle_body]];
  mj_kinematics(engine.model, engine.data);
  rotors_ = engine.find_rotors();
  for (int geom = 0; geom < model.ngeom; ++geom) {
    if (engine.belongs(geom, SolidPart::kVehicle)) {
      const Sphere s = engine.sphere(geom);
      vehicle_radius_ = std::max(vehicle_radius_, s.center_N.norm() + s.radius);
    }
  }
  const int sun = mj_name2id(&model, mjOBJ_LIGHT, "sun");
  sun_N_ = sun < 0 ? Vector3(0.4, 0.5, -0.77).normalized()
                   : Vector3(-ned_nwu(engine_vector(model.light_dir + 3 * sun)).normalized());
  if (const int ground = mj_name2id(&model, mjOBJ_GEOM, "ground"); ground >= 0) {
    const int material = model.geom_matid[ground];
    const float* rgba = material < 0 ? model.geom_rgba + 4 * ground : model.mat_rgba + 4 * material;
    ground_color_ = Vector3(rgba[0], rgba[1], rgba[2]);
  }
  helipad_ = engine.mark("helipad");
  compass_rose_ = engine.mark("compass_rose");
  obstacles_ = engine.field_sphere();
}

SolidLayer::~SolidLayer() = default;

void SolidLayer::pose(const RenderSample& sample, double blur_speed) {
  Engine& engine = *engine_;
  mjtNum* at = engine.data->qpos + engine.vehicle_joint;
  const Vector3 position = ned_nwu(sample.pose.p_NB_N);
  const Quaternion attitude = ned_nwu(sample.pose.q_NB.normalized());
  std::copy_n(position.data(), 3, at);
  at[3] = attitude.w();
  at[4] = attitude.x();
  at[5] = attitude.y();
  at[6] = attitude.z();
  for (std::size_t i = 0; i < rotors_.size(); ++i) {
    engine.data->qpos[rotors_[i].joint_address] = sample.rotor_angle[i];
    const int body = mj_name2id(engine.model, mjOBJ_BODY, rotor_name(static_cast<int>(i)).c_str());
    const bool blurred = std::abs(sample.rotor_speed[i]) > blur_speed;
    for (int k = 0; k < engine.model->body_geomnum[body]; ++k) {
      const int geom = engine.model->body_geomadr[body] + k;
      engine.hidden[static_cast<std::size_t>(geom)] =
          blurred && engine.model->geom_type[geom] != mjGEOM_CYLINDER;
    }
  }
  mj_kinematics(engine.model, engine.data);
  mj_comPos(engine.model, engine.data);
  mj_camlight(engine.model, engine.data);
  engine.collect();
}

PixelRect SolidLayer::bounds(const Projection& projection, SolidPart part) const {
  const PixelRect whole{0, 0, projection.width(), projection.height()};
  PixelRect box{whole.right, whole.bottom, 0, 0};
  for (int geom = 0; geom < engine_->model->ngeom; ++geom) {
    if (!engine_->belongs(geom, part)) {
      continue;
    }
    const Sphere s = engine_->sphere(geom);
    const double depth = projection.forward_N().dot(s.center_N - projection.p_N());
    if (depth < -s.radius) {
      continue;
    }
    const std::optional<ScreenPoint> center = projection.project(s.center_N);
    if (!center || depth < s.radius + kNearPlane) {
      return whole;
    }
    // The silhouette of a sphere off the axis is an ellipse, longest towards the centre of the picture.
    const double slant = std::hypot(center->u - projection.center_u(), center->v - projection.center_v());
    const double stretch = std::sqrt(1.0 + slant * slant / (projection.focal() * projection.focal()));
    const double reach = projection.focal() * s.radius / (depth - s.radius) * stretch + 2.0;
    box.left = std::min(box.left, static_cast<int>(std::clamp(std::floor(center->u - reach), 0.0, 1e5)));
    box.top = std::min(box.top, static_cast<int>(std::clamp(std::floor(center->v - reach), 0.0, 1e5)));
    box.right = std::max(box.right, static_cast<int>(std::clamp(std::ceil(center->u + reach), -1.0, 1e5)));
    box.bottom = std::max(box.bottom, static_cast<int>(std::clamp(std::ceil(center->v + reach), -1.0, 1e5)));
  }
  box.right = std::min(box.right, whole.right);
  box.bottom = std::min(box.bottom, whole.bottom);
  return box;
}

const SolidPicture& SolidLayer::draw(const Projection& projection, PixelRect rect, int samples,
                                     SolidPart part) {
  Engine& engine = *engine_;
  engine.context.make_current();
  engine.select(part);
  picture_.rect = rect;
  picture_.samples = samples;
  std::tie(picture_.near, picture_.far) = engine.depth_range(projection);
  engine.aim(projection, rect, picture_.near, picture_.far);
  const mjrRect viewport{0, 0, rect.width() * samples, rect.height() * samples};
  mjr_render(viewport, &engine.scene, &engine.renderer);
  const std::size_t count =
      static_cast<std::size_t>(viewport.width) * static_cast<std::size_t>(viewport.height);
  picture_.rgba.resize(4 * count);
  picture_.window_depth.resize(count);
  engine.context.read_colours(viewport.width, viewport.height, picture_.rgba.data());
  engine.context.read_depths(viewport.width, viewport.height, picture_.window_depth.data());
  return picture_;
}

SolidLayer::RawGlyph SolidLayer::glyph(char character) {
  engine_->context.make_current();
  const mjrContext& renderer = engine_->renderer;
  const int advance = renderer.charWidthBig[static_cast<unsigned char>(character)];
  const int height = renderer.charHeightBig;
  const mjrRect viewport{0, 0, advance + 2 * kGlyphMargin, height + 2 * kGlyphMargin};
  mjr_rectangle(viewport, 0.0F, 0.0F, 0.0F, 1.0F);
  engine_->context.set_viewport(viewport.width, viewport.height);
  const char text[2] = {character, '\0'};
  mjr_text(mjFONT_BIG, text, &renderer, static_cast<float>(kGlyphMargin) / static_cast<float>(viewport.width),
           static_cast<float>(kGlyphMargin) / static_cast<float>(viewport.height), 1.0F, 1.0F, 1.0F);
  std::vector<std::uint8_t> rgba(4 * static_cast<std::size_t>(viewport.width * viewport.height));
  engine_->context.read_colours(viewport.width, viewport.height, rgba.data());
  RawGlyph glyph{viewport.width, viewport.height, {}};
  for (int y = viewport.height - 1; y >= 0; --y) {
    for (int x = 0; x < viewport.width; ++x) {
      glyph.coverage.push_back(rgba[4 * static_cast<std::size_t>(y * viewport.width + x)]);
    }
  }
  return glyph;
}

}  // namespace ironbird::simulator
