#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "scenarios/record/log.hpp"

namespace ironbird::scenarios {

/// A column of a log as a function of time: the last value at or before it. Times must be asked in order.
class HeldColumn {
 public:
  /// @param topic  may be null: then always `otherwise`
  HeldColumn(const LogTopic* topic, const std::string& field, double otherwise);
  double at(double time);

 private:
  const std::vector<double>* time_ = nullptr;
  const std::vector<double>* value_ = nullptr;
  double otherwise_;
  std::size_t next_ = 0;
};

}  // namespace ironbird::scenarios
