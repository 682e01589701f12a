#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace ironbird::scenarios {

/// The file that makes a folder a vehicle.
inline constexpr const char* kVehicleFile = "vehicle.toml";

/// The vehicle's folder of that name in these folders. @return an empty path when there is none
std::filesystem::path find_vehicle(const std::string& name,
                                   const std::vector<std::filesystem::path>& folders);

/// The field's file of that name in these folders. @return an empty path when there is none
std::filesystem::path find_field(const std::string& name, const std::vector<std::filesystem::path>& folders);

/// The vehicles that there are, as a scenario names them: those in the first of the folders, and those in
/// models/ of any. For messages.
std::string vehicles_in(const std::vector<std::filesystem::path>& folders);

/// The same of fields, in models/fields.
std::string fields_in(const std::vector<std::filesystem::path>& folders);

}  // namespace ironbird::scenarios
