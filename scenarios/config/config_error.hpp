#pragma once

#include <string>
#include <utility>
#include <vector>

#include "scenarios/config/one_line.hpp"
#include "scenarios/config/user_error.hpp"

namespace ironbird::scenarios {

/// What is wrong with a configuration, one line for each finding:
/// `file:line:column: path = value: what is wrong, what is allowed`. Of very many only the first are told.
class ConfigError : public UserError {
 public:
  explicit ConfigError(const std::vector<std::string>& findings) : ConfigError(told(findings)) {}
  explicit ConfigError(const std::string& finding) : ConfigError(std::vector<std::string>{finding}) {}

  const std::vector<std::string>& findings() const { return findings_; }

 private:
  struct Told {
    std::vector<std::string> findings;
  };
  explicit ConfigError(Told told) : UserError(joined(told.findings)), findings_(std::move(told.findings)) {}

  static Told told(const std::vector<std::string>& findings) {
    constexpr std::size_t kMost = 100;
    Told told;
    for (std::size_t i = 0; i < findings.size() && i < kMost; ++i) {
      told.findings.push_back(on_one_line(findings[i]));
    }
    if (findings.size() > kMost) {
      told.findings.push_back("and " + std::to_string(findings.size() - kMost) + " findings more");
    }
    return told;
  }

  static std::string joined(const std::vector<std::string>& findings) {
    std::string text;
    for (const std::string& finding : findings) text += (text.empty() ? "" : "\n") + finding;
    return text;
  }

  std::vector<std::string> findings_;
};

}  // namespace ironbird::scenarios
