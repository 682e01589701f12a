#include "simulator/plant/proximity.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ironbird::simulator {
namespace {

// Contact comes on at margin + speed times look-ahead, and goes off at twice that. The look-ahead is several
// of the longest steps, in which no vehicle changes its speed much.
constexpr double kMargin = 0.05;     // m
constexpr double kLookAhead = 0.03;  // s

double distance(const BoxObstacle& box, const Vector3& p_N) {
  const Vector3 from_centre = p_N - box.position;
  const double c = std::cos(box.heading);
  const double s = std::sin(box.heading);
  const Vector3 in_box(c * from_centre.x() + s * from_centre.y(), c * from_centre.y() - s * from_centre.x(),
                       from_centre.z());
  const Vector3 outside = (in_box.cwiseAbs() - box.half_size).cwiseMax(0.0);
  return outside.norm();
}

// In 2.5 ms at these speeds a foot moves by less than the depth to which soft ground gives way under the
// weight.
constexpr double kSlow = 0.02;      // m/s
constexpr double kSlowTurn = 0.05;  // rad/s

}  // namespace

bool nearly_at_rest(const RigidBodyState& state) {
  return state.v_NB_N.squaredNorm() < kSlow * kSlow && state.w_NB_B.squaredNorm() < kSlowTurn * kSlowTurn;
}

Proximity::Proximity(const ContactParams& vehicle, const FieldParams& field) : field_(field) {
  reach_ = vehicle.body_half_size.norm();
  for (const Vector3& foot : vehicle.feet) reach_ = std::max(reach_, foot.norm() + vehicle.foot_radius);
}

double Proximity::clearance(const Vector3& p_NB_N) const {
  double least = field_.ground ? -p_NB_N.z() : std::numeric_limits<double>::infinity();
  for (const BoxObstacle& box : field_.boxes) least = std::min(least, distance(box, p_NB_N));
  return least - reach_;
}

bool Proximity::update(const Vector3& p_NB_N, double speed) {
  const double margin = (kMargin + speed * kLookAhead) * (near_ ? 2.0 : 1.0);
  near_ = clearance(p_NB_N) < margin;
  return near_;
}

}  // namespace ironbird::simulator
