#include "scenarios/record/held_column.hpp"

#include <cmath>

namespace ironbird::scenarios {

HeldColumn::HeldColumn(const LogTopic* topic, const std::string& field, double otherwise)
    : otherwise_(otherwise) {
  if (topic != nullptr && topic->has(field)) {
    time_ = &topic->time();
    value_ = &topic->column(field);
  }
}

double HeldColumn::at(double time) {
  if (value_ == nullptr) {
    return otherwise_;
  }
  while (next_ < time_->size() && (*time_)[next_] <= time) {
    ++next_;
  }
  const double value = next_ == 0 ? otherwise_ : (*value_)[next_ - 1];
  return std::isfinite(value) ? value : otherwise_;
}

}  // namespace ironbird::scenarios
