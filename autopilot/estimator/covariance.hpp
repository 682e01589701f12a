#pragma once

#include "autopilot/types/linear_algebra.hpp"

namespace ironbird::autopilot {

// What both filters do with their covariance, whatever its size.

inline double square(double a) {
  return a * a;
}

/// Standard deviations; rounding may have left a variance of -1e-20.
inline Vector3 root_of(const Vector3& variances) {
  return variances.cwiseMax(0.0).cwiseSqrt();
}

/// Copies the upper triangle into the lower one.
template <class Matrix>
void mirror_upper(Matrix& P) {
  for (int column = 0; column < P.cols(); ++column) {
    for (int row = column + 1; row < P.rows(); ++row) P(row, column) = P(column, row);
  }
}

/// Makes `size` components from `first` on independent of all others, with this variance each.
template <class Matrix>
void decorrelate(Matrix& P, int first, int size, double variance) {
  P.middleRows(first, size).setZero();
  P.middleCols(first, size).setZero();
  P.diagonal().segment(first, size).setConstant(variance);
}

}  // namespace ironbird::autopilot
