#include "hil_bridge/transport/in_process_bus.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "hil_bridge/transport/bounded_queue.hpp"
#include "simulator/types/bounds.hpp"

namespace ironbird::hil_bridge::transport {

namespace {

constexpr int kWarningLimit = 96;
constexpr int kPassiveLimit = 128;
constexpr int kOffLimit = 256;
constexpr std::size_t kEventQueue = 64;
/// Error flag, delimiter and the pause before the next frame.
constexpr double kErrorBits = 20.0;

/// In the order in which frames win: the first 11 bits, then short identifiers, then the rest; data before
/// requests.
std::uint64_t urgency(const CanFrame& frame) {
  const std::uint64_t key = frame.extended
                                ? (frame.identifier >> 18U) << 19U | 1U << 18U | (frame.identifier & 0x3FFFFU)
                                : frame.identifier << 19U;
  return key << 1U | (frame.remote ? 1U : 0U);
}

}  // namespace

class InProcessBus::End final : public FrameBus {
 public:
  explicit End(const InProcessBusParams& params)
      : outgoing(static_cast<std::size_t>(params.send_queue)),
        incoming(static_cast<std::size_t>(params.receive_queue)),
        fd_(params.fd) {
    filters_.reserve(kMostFilters);
  }

  bool send(const CanFrame& frame) override {
    const bool taken =
        state_ != BusState::kOff && can::is_sendable(frame) && (fd_ || !frame.fd) && outgoing.push(frame);
    ++(taken ? counters_.sent : counters_.refused);
    return taken;
  }
  std::optional<ReceivedFrame> receive() override {
    std::optional<ReceivedFrame> frame = incoming.pop();
    if (frame) ++counters_.received;
    return frame;
  }
  std::optional<BusEvent> take_event() override { return events_.pop(); }
  void set_filters(std::span<const FrameFilter> filters) override {
    filters_.assign(filters.begin(), filters.begin() + std::min(filters.size(), kMostFilters));
  }
  BusState state() const override { return state_; }
  bool fd() const override { return fd_; }
  const BusCounters& counters() const override { return counters_; }

  bool takes_part() const { return plugged && state_ != BusState::kOff; }

  void hear(const CanFrame& frame, Time stamp) {
    // Above the limit a good frame brings the count back to where trust begins.
    receive_errors = receive_errors >= kPassiveLimit ? kPassiveLimit - 8 : std::max(receive_errors - 1, 0);
    judge(stamp);
    const bool wanted =
        filters_.empty() || std::any_of(filters_.begin(), filters_.end(),
                                        [&](const FrameFilter& filter) { return filter.passes(frame); });
    if (!wanted || incoming.push({frame, stamp})) return;
    ++counters_.lost;
    report({BusEventKind::kLost, stamp, 1});
  }
  void report(BusEvent event) {
    event.send_errors = static_cast<std::uint16_t>(send_errors);
    event.receive_errors = static_cast<std::uint16_t>(receive_errors);
    if (!events_.push(event)) ++counters_.events_lost;
  }
  /// Draws the consequence of the error counters.
  void judge(Time stamp) {
    const int most = std::max(send_errors, receive_errors);
    const BusState now = send_errors >= kOffLimit ? BusState::kOff
                         : most >= kPassiveLimit  ? BusState::kPassive
                         : most >= kWarningLimit  ? BusState::kWarning
                                                  : BusState::kActive;
    if (now == state_) return;
    state_ = now;
    constexpr BusEventKind kKinds[] = {BusEventKind::kActive, BusEventKind::kWarning, BusEventKind::kPassive,
                                       BusEventKind::kOff};
    report({kKinds[static_cast<std::size_t>(now)], stamp});
    if (now == BusState::kOff) {
      outgoing.clear();
      off_since = stamp;
    }
  }
  void restart(Time stamp) {
    send_errors = 0;
    receive_errors = 0;
    state_ = BusState::kActive;
    report({BusEventKind::kRestarted, stamp});
  }

  BoundedQueue<CanFrame> outgoing;
  BoundedQueue<ReceivedFrame> incoming;
  int send_errors = 0;
  int receive_errors = 0;
  bool plugged = true;
  bool retried = false;
  Time off_since{};

 private:
  BoundedQueue<BusEvent> events_{kEventQueue};
  std::vector<FrameFilter> filters_;
  BusCounters counters_;
  BusState state_ = BusState::kActive;
  bool fd_;
};

InProcessBus::InProcessBus(const InProcessBusParams& params) : params_(params), dice_(params.seed) {
  simulator::check_bounds(params_, "in_process_bus");
}

InProcessBus::~InProcessBus() = default;

FrameBus& InProcessBus::attach() {
  ends_.push_back(std::make_unique<End>(params_));
  return *ends_.back();
}

void InProcessBus::advance(Time until) {
  while (true) {
    if (sending_ == nullptr) {
      const Time begin = std::max(free_at_, now_);
      if (begin >= until) break;
      restart_due(begin);
      sending_ = winner();
      if (sending_ == nullptr) break;
      free_at_ = begin + duration(sending_->outgoing.front());
    }
    if (free_at_ > until) break;
    finish(free_at_);
  }
  now_ = until;
  restart_due(until);
}

InProcessBus::End* InProcessBus::winner() const {
  End* best = nullptr;
  for (const auto& end : ends_) {
    if (!end->takes_part() || end->outgoing.empty()) continue;
    if (best == nullptr || urgency(end->outgoing.front()) < urgency(best->outgoing.front())) best = end.get();
  }
  return best;
}

/// The frame on the wire has reached its end.
void InProcessBus::finish(Time stamp) {
  End& sender = *sending_;
  sending_ = nullptr;
  if (!sender.takes_part()) return;
  const bool heard = std::any_of(ends_.begin(), ends_.end(),
                                 [&](const auto& end) { return end.get() != &sender && end->takes_part(); });
  const bool broken = shorted_ || corrupt_next_ > 0 || chance() < params_.corruption;
  if (broken && corrupt_next_ > 0) --corrupt_next_;
  if (broken || !heard) {
    fail(sender, broken ? BusEventKind::kBusError : BusEventKind::kNoAcknowledge, stamp);
    return;
  }
  sender.send_errors = std::max(sender.send_errors - 1, 0);
  sender.retried = false;
  sender.judge(stamp);
  const CanFrame frame = *sender.outgoing.pop();
  if (lose_next_ > 0) {
    --lose_next_;
  } else {
    deliver(sender, frame, stamp);
  }
}

void InProcessBus::fail(End& sender, BusEventKind cause, Time stamp) {
  free_at_ += Time(std::llround(kErrorBits * 1e9 / params_.bit_rate));
  // A controller that is alone does not drive itself off the bus.
  const bool alone_and_passive = cause == BusEventKind::kNoAcknowledge && sender.send_errors >= kPassiveLimit;
  if (!alone_and_passive) sender.send_errors += 8;
  // One report for each frame, not for each attempt.
  if (!sender.retried) sender.report({cause, stamp});
  sender.retried = true;
  sender.judge(stamp);
  if (sender.state() == BusState::kOff) sender.retried = false;
  if (cause != BusEventKind::kBusError || shorted_) return;
  for (const auto& end : ends_) {
    if (end.get() == &sender || !end->takes_part()) continue;
    end->receive_errors = std::min(end->receive_errors + 1, kPassiveLimit);
    end->judge(stamp);
  }
}

void InProcessBus::deliver(const End& sender, const CanFrame& frame, Time stamp) {
  for (const auto& end : ends_) {
    if (end.get() != &sender && end->takes_part() && chance() >= params_.loss) end->hear(frame, stamp);
  }
}

void InProcessBus::restart_due(Time now) {
  if (params_.restart_delay == Time(0)) return;
  for (const auto& end : ends_) {
    if (end->state() == BusState::kOff && end->off_since + params_.restart_delay <= now) {
      end->restart(end->off_since + params_.restart_delay);
    }
  }
}

/// Bits of head, tail and pause; stuff bits are not counted.
Time InProcessBus::duration(const CanFrame& frame) const {
  const double identifier = frame.extended ? 20.0 : 0.0;
  double at_bit_rate = 47.0 + identifier + (frame.remote ? 0.0 : 8.0 * frame.size);
  double at_data_rate = 0.0;
  if (frame.fd) {
    at_bit_rate = 30.0 + identifier;
    at_data_rate = 10.0 + 8.0 * frame.size + (frame.size > 16 ? 27.0 : 22.0);
  }
  const double data_rate = frame.bit_rate_switch ? params_.data_bit_rate : params_.bit_rate;
  return Time(std::llround(at_bit_rate * 1e9 / params_.bit_rate + at_data_rate * 1e9 / data_rate));
}

/// splitmix64, as a number from 0 to 1.
double InProcessBus::chance() {
  std::uint64_t z = (dice_ += 0x9E3779B97F4A7C15U);
  z = (z ^ z >> 30U) * 0xBF58476D1CE4E5B9U;
  z = (z ^ z >> 27U) * 0x94D049BB133111EBU;
  return static_cast<double>((z ^ z >> 31U) >> 11U) * 0x1.0p-53;
}

InProcessBus::End& InProcessBus::find(FrameBus& end) {
  const auto found =
      std::find_if(ends_.begin(), ends_.end(), [&](const auto& one) { return one.get() == &end; });
  if (found == ends_.end()) throw std::invalid_argument("in_process_bus: this end belongs to another bus");
  return **found;
}

void InProcessBus::plug(FrameBus& end, bool in) {
  find(end).plugged = in;
}

void InProcessBus::restart(FrameBus& end) {
  if (end.state() == BusState::kOff) find(end).restart(now_);
}

}  // namespace ironbird::hil_bridge::transport
