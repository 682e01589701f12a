#include "hil_bridge/transport/faulty_direction.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "simulator/types/bounds.hpp"

namespace ironbird::hil_bridge::transport {

namespace {

using std::chrono::nanoseconds;

constexpr double kNanoseconds = 1e9;
constexpr std::size_t kGreatestNoise = 16;

DirectionFaults checked(const DirectionFaults& faults) {
  simulator::check_bounds(faults, "link_fault");
  return faults;
}

simulator::Stream stream(std::uint64_t seed, std::string_view direction, std::string_view kind) {
  return {seed, "link/" + std::string(direction) + "/" + std::string(kind)};
}

}  // namespace

FaultyDirection::FaultyDirection(const DirectionFaults& faults, std::uint64_t seed, std::string_view name)
    : faults_(checked(faults)),
      drop_(stream(seed, name, "drop")),
      burst_(stream(seed, name, "burst")),
      corrupt_(stream(seed, name, "corrupt")),
      insert_(stream(seed, name, "insert")),
      duplicate_(stream(seed, name, "duplicate")),
      reorder_(stream(seed, name, "reorder")),
      stall_(stream(seed, name, "stall")),
      delay_(stream(seed, name, "delay")),
      hang_up_(stream(seed, name, "hang_up")) {}

void FaultyDirection::set(const DirectionFaults& faults) {
  faults_ = checked(faults);
}

void FaultyDirection::stand_still(nanoseconds until) {
  line_free_ = std::max(line_free_, until);
  for (Due& piece : under_way_) piece.when = std::max(piece.when, until);
}

bool FaultyDirection::put(std::span<const std::uint8_t> piece, nanoseconds now) {
  ++counts_.pieces;
  if (hang_up_.uniform() < faults_.hang_up) {
    ++counts_.hang_ups;
    // The cut goes through the piece: the first part of it is on its way already.
    const auto part = static_cast<std::size_t>(hang_up_.uniform() * static_cast<double>(piece.size()));
    deliver({piece.begin(), piece.begin() + static_cast<std::ptrdiff_t>(part)}, false, now);
    return false;
  }
  if (lost()) {
    ++counts_.dropped;
    return true;
  }
  std::vector<std::uint8_t> bytes(piece.begin(), piece.end());
  spoil(bytes);
  make_noise(now);
  const bool twice = duplicate_.uniform() < faults_.duplicate;
  if (twice) {
    ++counts_.duplicated;
    deliver(bytes, false, now);
  }
  deliver(std::move(bytes), false, now);
  return true;
}

bool FaultyDirection::lost() {
  in_burst_ = in_burst_ ? burst_.uniform() >= faults_.burst_end : burst_.uniform() < faults_.burst_start;
  return drop_.uniform() < faults_.drop || in_burst_;
}

void FaultyDirection::spoil(std::vector<std::uint8_t>& bytes) {
  if (faults_.corrupt <= 0.0) return;
  for (std::uint8_t& byte : bytes) {
    if (corrupt_.uniform() >= faults_.corrupt) continue;
    byte ^= static_cast<std::uint8_t>(1U << static_cast<unsigned>(corrupt_.uniform() * 8.0));
    ++counts_.corrupted_bytes;
  }
}

void FaultyDirection::make_noise(nanoseconds now) {
  if (insert_.uniform() >= faults_.insert) return;
  std::vector<std::uint8_t> noise(1 + static_cast<std::size_t>(insert_.uniform() * kGreatestNoise));
  for (std::uint8_t& byte : noise) byte = static_cast<std::uint8_t>(insert_.uniform() * 256.0);
  counts_.inserted_bytes += noise.size();
  deliver(std::move(noise), true, now);
}

void FaultyDirection::deliver(std::vector<std::uint8_t> bytes, bool noise, nanoseconds now) {
  if (stall_.uniform() < faults_.stall) {
    ++counts_.stalls;
    line_free_ = std::max(line_free_, now) + faults_.stall_time;
  }
  line_free_ = std::max(line_free_, now);
  if (faults_.byte_rate > 0.0) {
    line_free_ += nanoseconds(
        static_cast<std::int64_t>(static_cast<double>(bytes.size()) / faults_.byte_rate * kNanoseconds));
  }
  const auto jitter =
      static_cast<std::int64_t>(delay_.uniform() * static_cast<double>(faults_.jitter.count()));
  nanoseconds when = line_free_ + faults_.latency + nanoseconds(jitter);
  // Pieces keep their order: jitter moves them, it does not let them pass.
  if (!under_way_.empty()) when = std::max(when, under_way_.back().when);
  under_way_.push_back({when, std::move(bytes), noise});
  if (under_way_.size() > 1 && reorder_.uniform() < faults_.reorder) {
    ++counts_.reordered;
    Due& before = *std::prev(under_way_.end(), 2);
    std::swap(under_way_.back().bytes, before.bytes);
    std::swap(under_way_.back().noise, before.noise);
  }
}

FaultyDirection::Due* FaultyDirection::due(nanoseconds now) {
  return under_way_.empty() || under_way_.front().when > now ? nullptr : &under_way_.front();
}

bool FaultyDirection::has_room(nanoseconds now) const {
  constexpr double kDriversQueue = 4096.0;  // bytes, as the Linux serial core has
  return std::chrono::duration<double>(line_free_ - now).count() * faults_.byte_rate < kDriversQueue;
}

void FaultyDirection::clear() {
  under_way_.clear();
  line_free_ = {};
}

}  // namespace ironbird::hil_bridge::transport
