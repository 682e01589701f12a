# Finds MuJoCo. To be included by every folder that links it: imported targets are visible below their folder only.
find_package(mujoco REQUIRED)

# Debian's package names the headers of a library that MuJoCo was built with and that nobody needs to have installed.
get_target_property(mujoco_includes mujoco::mujoco INTERFACE_INCLUDE_DIRECTORIES)
list(FILTER mujoco_includes EXCLUDE REGEX "qhull")
set_target_properties(mujoco::mujoco PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${mujoco_includes}")
