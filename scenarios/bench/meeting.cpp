#include "scenarios/bench/meeting.hpp"

#include "scenarios/bench/fcu_config.hpp"

namespace ironbird::scenarios {

namespace {

constexpr std::size_t kToldAtMost = 5;

std::string option_for(const std::string& line) {
  return line.starts_with(kUdp) ? "--udp " + line.substr(kUdp.size()) : "--port " + line;
}

}  // namespace

std::string why_not_met(const hil_bridge::SerialFcu& fcu, hil_bridge::Time now, double patience) {
  const hil_bridge::LinkHealth link = fcu.health(now);
  const hil_bridge::Connection& connection = fcu.connection();
  if (connection.state() == hil_bridge::ConnectionState::kSilent) {
    if (link.age != hil_bridge::Time::max())
      return "it was heard, and is silent now; is the unit still there?";
    return link.bytes > 0
               ? "bytes come, but no frame of ROSflight 2.0; is the baud rate right, and is this the unit?"
               : "nothing is heard; is the unit powered, and is this its port?";
  }
  if (connection.armed(now)) return "the unit is armed, and tells nothing then: disarm it, and run again";
  const auto& progress = connection.parameters().progress();
  return "it is heard, but in " + std::to_string(static_cast<int>(patience)) + " s it told " +
         (connection.version().empty() ? "no version and " : "its version and ") +
         std::to_string(progress.known) + " of its parameters; try again with a greater --patience";
}

std::string text_about(const std::vector<hil_bridge::ParameterDifference>& differences,
                       const std::string& line) {
  std::string told;
  std::string push = "ironbird fcu params " + option_for(line) + " set";
  for (std::size_t i = 0; i < differences.size(); ++i) {
    const auto& [name, wanted, found] = differences[i];
    push += " " + name + " " + value_text(*wanted);
    if (i >= kToldAtMost) continue;
    told += "\n  " + name + " is " + (found ? value_text(*found) : "not there") + ", must be " +
            value_text(*wanted);
  }
  if (differences.size() > kToldAtMost)
    told += "\n  and " + std::to_string(differences.size() - kToldAtMost) + " more";
  return std::to_string(differences.size()) +
         (differences.size() == 1 ? " parameter of the unit is" : " parameters of the unit are") +
         " not the scenario's:" + told + "\n  push them with: " + push + " --keep";
}

}  // namespace ironbird::scenarios
