#include "scenarios/requirements/subject.hpp"

#include <stdexcept>

#include "scenarios/requirements/attitude.hpp"

namespace ironbird::scenarios {

Subject::Subject(Signal first, Signal second) : first_(std::move(first)), second_(std::move(second)) {
  if (first_.size() != second_->size() || first_.unit() != second_->unit()) {
    const auto kind = [](const Signal& s) {
      return s.path() + " (" + std::to_string(s.size()) + " in " + s.unit() + ")";
    };
    throw std::invalid_argument("no difference of " + kind(first_) + " and " + kind(*second_));
  }
}

std::string Subject::name() const {
  return second_ ? first_.path() + " - " + second_->path() : first_.path();
}

Eigen::Vector3d Subject::vector() const {
  if (!second_) return first_.vector();
  const Eigen::Vector3d difference = first_.vector() - second_->vector();
  return is_angle() ? Eigen::Vector3d(wrapped(difference.x()), 0.0, 0.0) : difference;
}

double Subject::magnitude() const {
  return size() == 1 ? vector().x() : vector().norm();
}

double Subject::offset_from(const Eigen::Vector3d& target) const {
  const Eigen::Vector3d offset = vector() - target;
  if (size() > 1) return offset.norm();
  return is_angle() ? wrapped(offset.x()) : offset.x();
}

}  // namespace ironbird::scenarios
