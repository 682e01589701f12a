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
constexpr double kMostMissing = 5.0;         // samples: a longer gap is a gap
constexpr std::size_t kEnoughWindows = 250;  // for eight weights
constexpr std::size_t kMostWindows = 4000;   // more tell no more
constexpr double kRidge = 1e-9;              // of the mean square: the weights' sum is free otherwise
constexpr int kAxes = 6;
using Axes = Eigen::Matrix<double, kAxes, 1>;  // force, rate

Axes axes_of(const ImuSample& sample) {
  return (Axes() << sample.force, sample.rate).finished();
}

/// What lies on either side of missing samples.
struct Shape {
  std::size_t before, missing, after;
  std::size_t known() const { return before + after; }
  std::size_t length() const { return before + missing + after; }
  auto operator<=>(const Shape&) const = default;
};

/// How the missing samples follow from the known ones, for each axis: missing x known, beside their mean.
using Weights = std::array<Eigen::MatrixXd, kAxes>;

class GapFiller {
 public:
  explicit GapFiller(const std::vector<ImuSample>& samples) : samples_(samples) {
    runs_.reserve(samples.size());
    for (std::size_t k = 0; k < samples.size(); ++k) {
      const bool goes_on = k > 0 && missing_before(k) == 0.0;
      runs_.push_back(!samples[k].is_finite() ? 0 : goes_on ? runs_.back() + 1 : 1);
    }
  }

  /// All samples, and those put in. @param count  how many these are
  std::vector<ImuSample> filled(std::size_t& count) {
    count = 0;
    std::vector<ImuSample> all;
    all.reserve(samples_.size());
    std::size_t unbroken = 0;  // samples at the end of `all` between which nothing is missing
    for (std::size_t k = 0; k < samples_.size(); ++k) {
      const double missing = k > 0 ? missing_before(k) : 0.0;
      const bool finite = samples_[k].is_finite();
      if (missing >= 1.0 && missing <= kMostMissing && unbroken > 0 && finite) {
        const Shape shape{std::min(unbroken, kReach), static_cast<std::size_t>(missing), run_from(k)};
        put_in(all, k, shape);
        count += shape.missing;
        unbroken += shape.missing;
      } else if (missing != 0.0) {
        unbroken = 0;
      }
      unbroken = finite ? unbroken + 1 : 0;
      all.push_back(samples_[k]);
    }
    return all;
  }

 private:
  /// Samples between sample `k` and the one before it; 0 where that is not told.
  double missing_before(std::size_t k) const {
    const auto length = static_cast<double>(samples_[k].length.count());
    if (length <= 0.0) return 0.0;
    const auto passed = static_cast<double>((samples_[k].when - samples_[k - 1].when).count());
    return std::max(std::round(passed / length) - 1.0, 0.0);
  }

  /// How many samples follow each other from this one on, as far as they are of use.
  std::size_t run_from(std::size_t k) const {
    std::size_t run = 1;
    while (run < kReach && k + run < samples_.size() && runs_[k + run] > run) ++run;
    return run;
  }

  void put_in(std::vector<ImuSample>& all, std::size_t next, const Shape& shape) {
    const ImuSample& after = samples_[next];
    const ImuSample before = all.back();
    Eigen::Matrix<double, kAxes, Eigen::Dynamic> known(kAxes, shape.known());
    for (std::size_t i = 0; i < shape.before; ++i) {
      known.col(static_cast<Eigen::Index>(i)) = axes_of(all[all.size() - shape.before + i]);
    }
    for (std::size_t i = 0; i < shape.after; ++i) {
      known.col(static_cast<Eigen::Index>(shape.before + i)) = axes_of(samples_[next + i]);
    }
    const std::optional<Weights>& weights = weights_for(shape);
    const Axes mean = known.rowwise().mean();
    const auto gap = static_cast<double>((after.when - before.when - after.length).count());
    for (std::size_t j = 1; j <= shape.missing; ++j) {
      const auto nth = static_cast<double>(j);
      const auto missing = static_cast<double>(shape.missing);
      ImuSample sample;
      sample.when = before.when + Time(std::llround(gap * nth / missing));
      sample.length = after.length;
      Axes value = axes_of(before) + nth / (missing + 1.0) * (axes_of(after) - axes_of(before));
      for (int axis = 0; weights && axis < kAxes; ++axis) {
        const Eigen::MatrixXd& rule = (*weights)[static_cast<std::size_t>(axis)];
        value[axis] =
            mean[axis] +
            rule.row(static_cast<Eigen::Index>(j - 1)).dot((known.row(axis).array() - mean[axis]).matrix());
      }
      sample.force = value.head<3>();
      sample.rate = value.tail<3>();
      all.push_back(sample);
    }
  }

  /// Learnt from stretches of this shape in which nothing is missing; nothing when there are too few.
  const std::optional<Weights>& weights_for(const Shape& shape) {
    const auto [entry, is_new] = learnt_.try_emplace(shape);
    if (!is_new) return entry->second;
    std::vector<std::size_t> windows;
    for (std::size_t last = shape.length() - 1; last < samples_.size(); ++last) {
      if (runs_[last] >= shape.length()) windows.push_back(last + 1 - shape.length());
    }
    if (windows.size() < kEnoughWindows) return entry->second;
    const std::size_t stride = 1 + windows.size() / kMostWindows;
    const auto known = static_cast<Eigen::Index>(shape.known());
    const auto missing = static_cast<Eigen::Index>(shape.missing);
    const auto before = static_cast<Eigen::Index>(shape.before);
    const auto after = static_cast<Eigen::Index>(shape.after);
    std::array<Eigen::MatrixXd, kAxes> squares;
    std::array<Eigen::MatrixXd, kAxes> products;
    squares.fill(Eigen::MatrixXd::Zero(known, known));
    products.fill(Eigen::MatrixXd::Zero(known, missing));
    Eigen::MatrixXd window(static_cast<Eigen::Index>(shape.length()), kAxes);
    Eigen::VectorXd x(known);
    for (std::size_t w = 0; w < windows.size(); w += stride) {
      for (std::size_t i = 0; i < shape.length(); ++i) {
        window.row(static_cast<Eigen::Index>(i)) = axes_of(samples_[windows[w] + i]).transpose();
      }
      for (int axis = 0; axis < kAxes; ++axis) {
        x << window.col(axis).head(before), window.col(axis).tail(after);
        const double mean = x.mean();
        x.array() -= mean;
        const auto index = static_cast<std::size_t>(axis);
        squares[index].selfadjointView<Eigen::Lower>().rankUpdate(x);
        products[index] +=
            x * (window.col(axis).segment(before, missing).array() - mean).matrix().transpose();
      }
    }
    entry->second.emplace();
    for (std::size_t axis = 0; axis < kAxes; ++axis) {
      const double ridge = kRidge * squares[axis].trace() / static_cast<double>(known);
      squares[axis].diagonal().array() += std::max(ridge, std::numeric_limits<double>::min());
      const Eigen::MatrixXd full = squares[axis].selfadjointView<Eigen::Lower>();
      (*entry->second)[axis] = full.ldlt().solve(products[axis]).transpose();
      if ((*entry->second)[axis].allFinite()) continue;
      entry->second.reset();
      break;
    }
    return entry->second;
  }

  const std::vector<ImuSample>& samples_;
  std::vector<std::size_t> runs_;  // of samples up to this one between which nothing is missing
  std::map<Shape, std::optional<Weights>> learnt_;
};

}  // namespace

std::size_t fill_gaps(std::vector<ImuSample>& samples) {
  std::size_t count = 0;
  samples = GapFiller(samples).filled(count);
  return count;
}

}  // namespace ironbird::scenarios
