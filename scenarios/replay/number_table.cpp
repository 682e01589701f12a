#include "scenarios/replay/number_table.hpp"

#include "scenarios/config/nearest_name.hpp"

namespace ironbird::scenarios {

std::string instead_of(const std::string& column, const std::vector<std::string>& columns) {
  const std::string nearest = nearest_name(column, columns);
  if (!nearest.empty()) return "; did you mean '" + nearest + "'?";
  std::string names;
  for (const std::string& name : columns) names += (names.empty() ? "" : ", ") + name;
  return "; there are: " + names;
}

}  // namespace ironbird::scenarios
