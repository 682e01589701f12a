#include "simulator/render/root_scene.hpp"

#include <algorithm>

namespace ironbird::simulator {
namespace {

/// `file` as seen from a folder, both absolute and without symbolic links.
std::string seen_from(const std::string& folder, const std::string& file) {
  std::string up;
  for (long i = std::count(folder.begin(), folder.end(), '/'); i > 1; --i) up += "../";
  return up + file.substr(1);
}

}  // namespace

std::string folder_of_scene(const std::string& file) {
  return file.substr(0, file.find_last_of('/') + 1);
}

std::string root_scene(const std::string& vehicle, const std::string& field) {
  const std::string folder = folder_of_scene(vehicle);
  return "<mujoco><option gravity='0 0 0'/><visual><headlight ambient='0.36 0.38 0.42' diffuse='0.16 0.16 "
         "0.17' "
         "specular='0.1 0.1 0.1'/></visual><include file='" +
         vehicle.substr(folder.size()) + "'/>" +
         (field.empty() ? "" : "<include file='" + seen_from(folder, field) + "'/>") + "</mujoco>";
}

}  // namespace ironbird::simulator
