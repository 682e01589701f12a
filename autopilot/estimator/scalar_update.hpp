#pragma once

#include <Eigen/Core>

namespace ironbird::autopilot {

/// The correction that one or more scalar measurements give to a state of N components.
///
/// All rows of C belong to the same linearisation point. Fused one after the other, with the innovation of
/// each row reduced by what the earlier rows already explained, independent measurements give exactly the
/// joint update x + K (y - h), P = (I - K C) P (I - K C)^T + K R K^T (docs/equations.md, section 4). The
/// covariance stays symmetric to the last bit.
template <int N>
struct ScalarUpdate {
  using Vector = Eigen::Matrix<double, N, 1>;
  using Matrix = Eigen::Matrix<double, N, N>;

  Vector correction = Vector::Zero();  ///< to be added to the state when all rows are fused
  Vector PCt;                          ///< P C^T of the last row
  double variance = 0.0;               ///< S = C P C^T + R of the last row

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("variance", self.variance, "SI", "S of the last row, in the squared unit of its measurement");
  }

  /// Fuses one row.
  /// @param innovation  y - h at the linearisation point
  /// @param PCt_row  P C^T of the row, with the present P
  /// @param CPCt  C P C^T
  /// @param C_correction  C times the correction so far
  /// @param R  variance of the measurement, > 0
  void fuse(Matrix& P, double innovation, const Vector& PCt_row, double CPCt, double C_correction, double R) {
    PCt = PCt_row;
    variance = CPCt + R;
    const Vector K = PCt / variance;
    correction += K * (innovation - C_correction);
    // Joseph's form multiplied out for one row: P - K d^T - d K^T + S K K^T with d = P C^T, which is
    // P - K e^T - e K^T with e = d - S K / 2. Holds for any gain K, not only the optimal one.
    const Vector e = PCt - (0.5 * variance) * K;
    for (int column = 0; column < N; ++column) {
      P.col(column) -= K * e(column) + e * K(column);
    }
  }

  /// Fuses a row that picks components `first` .. `first + size(C) - 1` of the state.
  template <int Size>
  void fuse_block(Matrix& P, double innovation, const Eigen::Matrix<double, 1, Size>& C, int first,
                  double R) {
    const Vector d = P.template middleCols<Size>(first) * C.transpose();
    const double CPCt = C.dot(d.template segment<Size>(first));
    const double C_correction = C.dot(correction.template segment<Size>(first));
    fuse(P, innovation, d, CPCt, C_correction, R);
  }

  /// Fuses a row that is one component of the state, times `slope`.
  void fuse_component(Matrix& P, double innovation, int component, double slope, double R) {
    const Vector d = slope * P.col(component);
    fuse(P, innovation, d, slope * d(component), slope * correction(component), R);
  }
};

}  // namespace ironbird::autopilot
