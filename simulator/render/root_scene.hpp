#pragma once

#include <string>

namespace ironbird::simulator {

/// The folder of a scene's file, with its last slash.
std::string folder_of_scene(const std::string& file);

/// The scene as a file beside the vehicle's. There the engine looks for whatever a scene names: the vehicle's
/// meshes and textures lie where whoever made it put them.
/// @param field  may be empty: none
std::string root_scene(const std::string& vehicle, const std::string& field);

}  // namespace ironbird::simulator
