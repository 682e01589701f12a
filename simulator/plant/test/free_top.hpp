#pragma once

#include <cmath>

#include "simulator/plant/plant.hpp"

namespace ironbird::simulator {

/// A free asymmetric top in closed form, from principal moments J1 < J2 < J3 and rates whose angular momentum
/// is nearer to axis 3: L^2 > 2 E J2. Landau and Lifshitz, Mechanics, section 37. Shares no step with a
/// plant.
class FreeTop {
 public:
  FreeTop(const Vector3& J, const Vector3& w) : J_(J), L_(J.cwiseProduct(w).norm()) {
    const double x = w.x() * w.x(), y = w.y() * w.y(), z = w.z() * w.z();
    // Differences of twice the energy times a moment and L^2, as sums without loss of digits.
    const double below_3 = J.x() * (J.z() - J.x()) * x + J.y() * (J.z() - J.y()) * y;
    const double above_1 = J.y() * (J.y() - J.x()) * y + J.z() * (J.z() - J.x()) * z;
    const double above_2 = J.z() * (J.z() - J.y()) * z - J.x() * (J.y() - J.x()) * x;
    amplitude_ = {std::sqrt(below_3 / (J.x() * (J.z() - J.x()))),
                  std::sqrt(below_3 / (J.y() * (J.z() - J.y()))),
                  std::sqrt(above_1 / (J.z() * (J.z() - J.x())))};
    rate_ = std::sqrt((J.z() - J.y()) * above_1 / (J.x() * J.y() * J.z()));
    k_ = std::sqrt((J.y() - J.x()) * below_3 / ((J.z() - J.y()) * above_1));
    k_other_ = std::sqrt((J.z() - J.x()) * above_2 / ((J.z() - J.y()) * above_1));
    start_ = std::ellint_1(k_, std::atan2(w.y() / amplitude_.y(), w.x() / amplitude_.x()));
  }

  /// rad/s, in body axes.
  Vector3 rates(double t) const {
    const double phi = amplitude(start_ + rate_ * t);
    const double sine = std::sin(phi), cosine = std::cos(phi);
    const double delta = std::sqrt(cosine * cosine + k_other_ * k_other_ * sine * sine);
    return amplitude_.cwiseProduct(Vector3(cosine, sine, delta));
  }

  /// s, from one zero of the middle rate to the next.
  double between_flips() const { return 2.0 * std::comp_ellint_1(k_) / rate_; }

  /// How the body has turned from time 0 to t: takes B at t to B at 0.
  Quaternion turned(double t) const {
    return (about_momentum(0.0, 0.0).conjugate() * about_momentum(t, precession(t))).normalized();
  }

 private:
  /// Jacobi's amplitude by descending Landen steps. Abramowitz and Stegun, 16.4.
  double amplitude(double u) const {
    constexpr int kSteps = 8;  // convergence is quadratic: rounding after six of k = 0.9999
    double a = 1.0, b = k_other_;
    double ratio[kSteps + 1] = {};
    for (int n = 1; n <= kSteps; ++n) {
      const double c = 0.5 * (a - b);
      const double mean = 0.5 * (a + b);
      b = std::sqrt(a * b);
      a = mean;
      ratio[n] = c / a;
    }
    double phi = std::ldexp(a * u, kSteps);
    for (int n = kSteps; n > 0; --n) phi = 0.5 * (phi + std::asin(ratio[n] * std::sin(phi)));
    return phi;
  }

  /// Of the line of nodes about the angular momentum, rad/s.
  double precession_rate(double t) const {
    const Vector3 w = rates(t);
    const double energy = J_.x() * w.x() * w.x() + J_.y() * w.y() * w.y();
    return L_ * energy / (J_.cwiseProduct(w).head<2>().squaredNorm());
  }

  double precession(double t) const {
    constexpr int kIntervals = 40000;  // Simpson's: 0.25 ms each of ten seconds, error below rounding
    const double h = t / kIntervals;
    double sum = precession_rate(0.0) + precession_rate(t);
    for (int i = 1; i < kIntervals; ++i) sum += (i % 2 == 0 ? 2.0 : 4.0) * precession_rate(i * h);
    return sum * h / 3.0;
  }

  /// Takes B to axes of which the third is along the angular momentum.
  Quaternion about_momentum(double t, double phi) const {
    const Vector3 L_B = J_.cwiseProduct(rates(t));
    const double nutation = std::atan2(L_B.head<2>().norm(), L_B.z());
    const double own = std::atan2(L_B.x(), L_B.y());
    const auto turn = [](double angle, const Vector3& axis) {
      return Quaternion(Eigen::AngleAxis<double>(angle, axis));
    };
    return turn(phi, Vector3::UnitZ()) * turn(nutation, Vector3::UnitX()) * turn(own, Vector3::UnitZ());
  }

  Vector3 J_;
  double L_;
  Vector3 amplitude_;
  double rate_ = 0.0;
  double k_ = 0.0;
  double k_other_ = 1.0;  ///< sqrt(1 - k^2)
  double start_ = 0.0;
};

}  // namespace ironbird::simulator
