#include "hil_bridge/executive/loop_timing.hpp"

#include <algorithm>
#include <limits>

namespace ironbird::hil_bridge {

namespace {

constexpr std::size_t kDecade = 10;
// 10^(k/10), rounded: the preferred numbers of ISO 3 and the like.
constexpr std::array<std::int64_t, kDecade> kSteps = {1000, 1259, 1585, 1995, 2512,
                                                      3162, 3981, 5012, 6310, 7943};

constexpr std::array<std::int64_t, Histogram::kBuckets> upper_bounds() {
  std::array<std::int64_t, Histogram::kBuckets> bounds{};
  std::int64_t decade = 1;
  for (std::size_t k = 0; k + 1 < bounds.size(); ++k) {
    if (k > 0 && k % kDecade == 0) decade *= 10;
    bounds[k] = kSteps[k % kDecade] * decade;
  }
  bounds.back() = std::numeric_limits<std::int64_t>::max();
  return bounds;
}

constexpr std::array<std::int64_t, Histogram::kBuckets> kUpperBounds = upper_bounds();

}  // namespace

Time Histogram::upper_bound(std::size_t bucket) {
  return Time{kUpperBounds[bucket]};
}

void Histogram::add(Time duration) {
  const auto* const bound = std::lower_bound(kUpperBounds.begin(), kUpperBounds.end(), duration.count());
  ++counts_[static_cast<std::size_t>(bound - kUpperBounds.begin())];
  ++count_;
  greatest_ = std::max(greatest_, static_cast<std::int64_t>(duration.count()));
}

Time Histogram::quantile(double share) const {
  const double wanted = share * static_cast<double>(count_);
  std::uint64_t seen = 0;
  for (std::size_t k = 0; k < kBuckets; ++k) {
    seen += counts_[k];
    if (seen > 0 && static_cast<double>(seen) >= wanted) return std::min(upper_bound(k), greatest());
  }
  return greatest();
}

}  // namespace ironbird::hil_bridge
