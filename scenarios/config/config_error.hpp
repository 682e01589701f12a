#pragma once

#include <string>
#include <utility>
#include <vector>

#include "scenarios/config/user_error.hpp"

namespace ironbird::scenarios {

/// What is wrong with a configuration, one line for each finding:
/// `file:line:column: path = value: what is wrong, what is allowed`.
class ConfigError : public UserError {
 public:
  explicit ConfigError(std::vector<std::string> findings)
      : UserError(joined(findings)), findings_(std::move(findings)) {}
  explicit ConfigError(const std::string& finding) : ConfigError(std::vector<std::string>{finding}) {}

  const std::vector<std::string>& findings() const { return findings_; }

 private:
  static std::string joined(const std::vector<std::string>& findings) {
    std::string text;
    for (const std::string& finding : findings) text += (text.empty() ? "" : "\n") + finding;
    return text;
  }

  std::vector<std::string> findings_;
};

}  // namespace ironbird::scenarios
