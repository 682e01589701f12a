#include "hil_bridge/can/dynamic_node_id.hpp"

#include <algorithm>

namespace ironbird::hil_bridge::can {

namespace {

/// Bytes of the unique id in one classic frame.
constexpr std::size_t kPart = 6;
constexpr double kLeastWait = 0.6;
constexpr double kGreatestWait = 1.0;
constexpr double kGreatestFollowUp = 0.4;

Time seconds_of(double seconds) {
  return Time(static_cast<std::int64_t>(seconds * 1e9));
}

}  // namespace

NodeIdClient::NodeIdClient(const UniqueId& unique_id, std::uint8_t wish, Time now)
    : unique_id_(unique_id), dice_(0), wish_(wish) {
  for (const std::uint8_t byte : unique_id) dice_ = (dice_ ^ byte) * 0x100000001B3U;
  start_over(now);
}

void NodeIdClient::start_over(Time now) {
  told_ = 0;
  due_ = now + seconds_of(kLeastWait + (kGreatestWait - kLeastWait) * chance());
}

std::optional<Allocation> NodeIdClient::step(Time now) {
  if (node_ || now < due_) return std::nullopt;
  Allocation message;
  message.node_id = told_ == 0 ? wish_ : std::uint8_t{0};
  message.first_part_of_unique_id = told_ == 0;
  const std::size_t end = std::min(told_ + kPart, unique_id_.size());
  for (std::size_t k = told_; k < end; ++k) message.unique_id.push(unique_id_[k]);
  // Without an answer it begins again.
  start_over(now);
  return message;
}

void NodeIdClient::take(const Allocation& message, bool anonymous, Time now) {
  if (node_) return;
  start_over(now);
  const std::span<const std::uint8_t> heard = message.unique_id.view();
  if (anonymous || heard.empty() || !std::equal(heard.begin(), heard.end(), unique_id_.begin())) return;
  if (heard.size() < unique_id_.size()) {
    told_ = heard.size();
    due_ = now + seconds_of(kGreatestFollowUp * chance());
  } else if (message.node_id != 0) {
    node_ = message.node_id;
  }
}

/// splitmix64, as a number from 0 to 1.
double NodeIdClient::chance() {
  std::uint64_t z = (dice_ += 0x9E3779B97F4A7C15U);
  z = (z ^ z >> 30U) * 0xBF58476D1CE4E5B9U;
  z = (z ^ z >> 27U) * 0x94D049BB133111EBU;
  return static_cast<double>((z ^ z >> 31U) >> 11U) * 0x1.0p-53;
}

std::optional<Allocation> NodeIdServer::take(const Allocation& wish, Time now,
                                             const std::function<bool(std::uint8_t)>& taken) {
  if (now - last_ > kFollowUp) count_ = 0;
  const std::span<const std::uint8_t> part = wish.unique_id.view();
  if (wish.first_part_of_unique_id) {
    count_ = 0;
    wish_ = wish.node_id;
  } else if (count_ == 0) {
    return std::nullopt;
  }
  // Parts of six bytes and the rest of four, or, in CAN FD, all of it at once.
  const std::size_t left = heard_.size() - count_;
  if (part.size() != std::min(kPart, left) && !(count_ == 0 && part.size() == left)) return std::nullopt;
  std::copy(part.begin(), part.end(), heard_.begin() + static_cast<std::ptrdiff_t>(count_));
  count_ += part.size();
  last_ = now;
  Allocation answer;
  for (std::size_t k = 0; k < count_; ++k) answer.unique_id.push(heard_[k]);
  if (count_ < heard_.size()) return answer;
  count_ = 0;
  const std::optional<std::uint8_t> node = grant(taken);
  if (!node) return std::nullopt;
  answer.node_id = *node;
  return answer;
}

/// The number of before, else the next free one from the wish upwards, else downwards from it.
std::optional<std::uint8_t> NodeIdServer::grant(const std::function<bool(std::uint8_t)>& taken) {
  const auto before = std::find(owners_.begin(), owners_.end(), std::optional(heard_));
  if (before != owners_.end()) return static_cast<std::uint8_t>(before - owners_.begin());
  const int wish = wish_ == 0 || wish_ > kGreatestGrant ? kGreatestGrant : wish_;
  const auto free = [&](int node) {
    return !owner(static_cast<std::uint8_t>(node)) && !taken(static_cast<std::uint8_t>(node));
  };
  int node = wish;
  while (node <= kGreatestGrant && !free(node)) ++node;
  if (node > kGreatestGrant) {
    node = wish;
    while (node >= 1 && !free(node)) --node;
  }
  if (node < 1) return std::nullopt;
  owners_[static_cast<std::size_t>(node)] = heard_;
  return static_cast<std::uint8_t>(node);
}

}  // namespace ironbird::hil_bridge::can
