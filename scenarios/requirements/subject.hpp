#pragma once

#include <optional>

#include <Eigen/Core>

#include "scenarios/requirements/signal_table.hpp"

namespace ironbird::scenarios {

/// What a check looks at: one signal, or the difference of two.
class Subject {
 public:
  Subject() = default;
  explicit Subject(Signal signal) : first_(std::move(signal)) {}

  /// The difference `first - second`. @throws std::invalid_argument when units or sizes differ
  Subject(Signal first, Signal second);

  /// Its name in messages.
  std::string name() const;
  const std::string& unit() const { return first_.unit(); }
  Angles angles() const { return first_.angles(); }
  int size() const { return first_.size(); }
  bool is_angle() const { return first_.is_angle(); }
  bool present() const { return first_.present() && (!second_ || second_->present()); }

  /// Component 0 of a number, all of a vector.
  Eigen::Vector3d vector() const;

  /// A number as it is, a vector's norm.
  double magnitude() const;

  /// How far it is from `target`: signed for a number (angles the short way), the distance for a vector.
  double offset_from(const Eigen::Vector3d& target) const;

 private:
  Signal first_;
  std::optional<Signal> second_;
};

}  // namespace ironbird::scenarios
