#include "scenarios/replay/imu_gaps.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

namespace ironbird::scenarios {

namespace {

using hil_bridge::Time;

constexpr std::size_t kReach = 4;            // samples on either side
constexpr std::size_t kMostMissing = 5;      // samples: a longer gap is a gap
constexpr std::size_t kEnoughWindows = 250;  // for eight weights
constexpr std::size_t kMostWindows = 4000;   // more tell no more
constexpr double kLoud = 10.0;               // medians of the energy: what is louder counts no more than this
constexpr double kRidge = 1e-9;              // of the mean square: the weights' sum is free otherwise
constexpr int kAxes = 6;
using Axes = Eigen::Matrix<double, kAxes, 1>;  // f_B, w_NB_B

Axes axes_of(const RecordedImuSample& sample) {
  return (Axes() << sample.f_B, sample.w_NB_B).finished();
}

double axis_of(const RecordedImuSample& sample, Eigen::Index axis) {
  return axis < 3 ? sample.f_B[axis] : sample.w_NB_B[axis - 3];
}

/// What lies on either side of missing samples.
struct Shape {
  std::size_t before, missing, after;
  std::size_t known() const { return before + after; }
  std::size_t length() const { return before + missing + after; }
  /// With no more than so many known samples on a side.
  Shape within(std::size_t reach) const { return {std::min(before, reach), missing, std::min(after, reach)}; }
  auto operator<=>(const Shape&) const = default;
};

/// How the missing samples follow from the known ones, for each axis: known x missing, beside the known ones'
/// mean.
using Weights = std::array<Eigen::MatrixXd, kAxes>;

/// Stretches in which nothing is missing, of one axis: a row each, the known samples' mean taken off.
struct Windows {
  Eigen::MatrixXd known;
  Eigen::MatrixXd missing;

  /// The weights of least squares; not finite when there is none.
  Eigen::MatrixXd weights() const {
    const Eigen::VectorXd trust = trusts();
    const Eigen::MatrixXd weighted = known.array().colwise() * trust.array();
    Eigen::MatrixXd squares = weighted.transpose() * known;
    const double ridge = kRidge * squares.trace() / static_cast<double>(known.cols());
    squares.diagonal().array() += std::max(ridge, std::numeric_limits<double>::min());
    return squares.ldlt().solve(weighted.transpose() * missing);
  }

 private:
  /// A crash, or one broken sample, must not decide for the whole flight.
  Eigen::VectorXd trusts() const {
    const Eigen::VectorXd energies = known.rowwise().squaredNorm() + missing.rowwise().squaredNorm();
    std::vector<double> sorted(energies.data(), energies.data() + energies.size());
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    const double most = kLoud * *middle;
    return energies.unaryExpr([most](double energy) { return energy > most ? most / energy : 1.0; });
  }
};

class GapFiller {
 public:
  explicit GapFiller(const std::vector<RecordedImuSample>& samples) : samples_(samples) {
    runs_.reserve(samples.size());
    for (std::size_t k = 0; k < samples.size(); ++k) {
      const bool goes_on = k > 0 && missing_before(k) == 0;
      if (!samples[k].is_finite()) {
        runs_.push_back(0);
      } else {
        runs_.push_back(goes_on ? runs_.back() + 1 : 1);
      }
    }
  }

  /// All samples, and those put in.
  std::vector<RecordedImuSample> filled() {
    std::vector<RecordedImuSample> all;
    all.reserve(samples_.size());
    for (std::size_t k = 0; k < samples_.size(); ++k) {
      const std::size_t missing = k > 0 ? missing_before(k) : 0;
      const bool has_ends = k > 0 && runs_[k] > 0 && runs_[k - 1] > 0;
      if (missing > 0 && missing <= kMostMissing && has_ends) {
        // Only what was recorded foretells: what follows from itself need not stay bounded.
        put_in(all, k, {runs_[k - 1], missing, run_from(k)});
      }
      all.push_back(samples_[k]);
    }
    return all;
  }

 private:
  /// Samples between sample `k` and the one before it, as far as it tells its length.
  std::size_t missing_before(std::size_t k) const {
    const auto length = static_cast<double>(samples_[k].length.count());
    if (length <= 0.0) return 0;
    const auto passed = static_cast<double>((samples_[k].stamp - samples_[k - 1].stamp).count());
    return static_cast<std::size_t>(std::max(std::round(passed / length) - 1.0, 0.0));
  }

  /// How many samples follow each other from this one on, as far as they are of use.
  std::size_t run_from(std::size_t k) const {
    std::size_t run = 1;
    while (run < kReach && k + run < samples_.size() && runs_[k + run] > run) ++run;
    return run;
  }

  /// Before sample `next`.
  void put_in(std::vector<RecordedImuSample>& all, std::size_t next, const Shape& widest) {
    const RecordedImuSample& before = samples_[next - 1];
    const RecordedImuSample& after = samples_[next];
    const auto missing = static_cast<double>(widest.missing);
    const auto gap = static_cast<double>((after.stamp - before.stamp - after.length).count());
    const Eigen::MatrixXd values = foretold(next, widest);
    for (std::size_t j = 0; j < widest.missing; ++j) {
      const Axes value = values.row(static_cast<Eigen::Index>(j));
      const Time since_before(std::llround(gap * static_cast<double>(j + 1) / missing));
      all.push_back({before.stamp + since_before, after.length, value.head<3>(), value.tail<3>()});
    }
  }

  /// The missing samples before sample `next`, a row each.
  Eigen::MatrixXd foretold(std::size_t next, const Shape& widest) {
    for (std::size_t reach = kReach; reach > 0; --reach) {
      const Shape shape = widest.within(reach);
      if (const auto& weights = weights_for(shape)) return weighted(next, shape, *weights);
    }
    Eigen::MatrixXd values(static_cast<Eigen::Index>(widest.missing), kAxes);
    const Axes before = axes_of(samples_[next - 1]);
    const Axes step = (axes_of(samples_[next]) - before) / static_cast<double>(widest.missing + 1);
    for (Eigen::Index j = 0; j < values.rows(); ++j) {
      values.row(j) = before + static_cast<double>(j + 1) * step;
    }
    return values;
  }

  Eigen::MatrixXd weighted(std::size_t next, const Shape& shape, const Weights& weights) const {
    Eigen::MatrixXd known(static_cast<Eigen::Index>(shape.known()), kAxes);
    for (std::size_t i = 0; i < shape.known(); ++i) {
      known.row(static_cast<Eigen::Index>(i)) = axes_of(samples_[next - shape.before + i]);
    }
    Eigen::MatrixXd values(static_cast<Eigen::Index>(shape.missing), kAxes);
    for (int axis = 0; axis < kAxes; ++axis) {
      const double mean = known.col(axis).mean();
      const Eigen::VectorXd beside = known.col(axis).array() - mean;
      values.col(axis) = (weights[static_cast<std::size_t>(axis)].transpose() * beside).array() + mean;
    }
    return values;
  }

  /// Learnt from stretches of this shape in which nothing is missing; nothing when there are too few.
  const std::optional<Weights>& weights_for(const Shape& shape) {
    const auto [entry, is_new] = learnt_.try_emplace(shape);
    if (!is_new) return entry->second;
    const std::vector<std::size_t> begins = whole_stretches(shape.length());
    if (begins.size() < kEnoughWindows) return entry->second;
    Weights weights;
    for (std::size_t axis = 0; axis < kAxes; ++axis) {
      weights[axis] = windows_of(begins, shape, axis).weights();
      if (!weights[axis].allFinite()) return entry->second;
    }
    entry->second = std::move(weights);
    return entry->second;
  }

  /// Where stretches of this length begin in which nothing is missing, spread over the flight.
  std::vector<std::size_t> whole_stretches(std::size_t length) const {
    std::vector<std::size_t> begins;
    for (std::size_t last = length - 1; last < samples_.size(); ++last) {
      if (runs_[last] >= length) begins.push_back(last + 1 - length);
    }
    const std::size_t stride = 1 + begins.size() / kMostWindows;
    std::vector<std::size_t> some;
    for (std::size_t k = 0; k < begins.size(); k += stride) some.push_back(begins[k]);
    return some;
  }

  Windows windows_of(const std::vector<std::size_t>& begins, const Shape& shape, std::size_t axis) const {
    const auto count = static_cast<Eigen::Index>(begins.size());
    const auto before = static_cast<Eigen::Index>(shape.before);
    const auto missing = static_cast<Eigen::Index>(shape.missing);
    const auto after = static_cast<Eigen::Index>(shape.after);
    Windows windows{Eigen::MatrixXd(count, before + after), Eigen::MatrixXd(count, missing)};
    Eigen::RowVectorXd stretch(before + missing + after);
    for (Eigen::Index row = 0; row < count; ++row) {
      const std::size_t begin = begins[static_cast<std::size_t>(row)];
      for (Eigen::Index i = 0; i < stretch.size(); ++i) {
        stretch[i] = axis_of(samples_[begin + static_cast<std::size_t>(i)], static_cast<Eigen::Index>(axis));
      }
      windows.known.row(row) << stretch.head(before), stretch.tail(after);
      const double mean = windows.known.row(row).mean();
      windows.known.row(row).array() -= mean;
      windows.missing.row(row) = stretch.segment(before, missing).array() - mean;
    }
    return windows;
  }

  const std::vector<RecordedImuSample>& samples_;
  std::vector<std::size_t> runs_;  // of samples up to this one between which nothing is missing
  std::map<Shape, std::optional<Weights>> learnt_;
};

}  // namespace

std::size_t fill_gaps(std::vector<RecordedImuSample>& samples) {
  const std::size_t recorded = samples.size();
  samples = GapFiller(samples).filled();
  return samples.size() - recorded;
}

}  // namespace ironbird::scenarios
