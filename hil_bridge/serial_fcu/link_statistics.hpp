#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "hil_bridge/fcu/fcu.hpp"
#include "hil_bridge/rosflight/dialect.hpp"
#include "hil_bridge/rosflight/stream_decoder.hpp"

namespace ironbird::hil_bridge {

/// How well a link does.
struct LinkHealth {
  double frame_rate = 0.0;
  double byte_rate = 0.0;
  double loss = 0.0;
  std::uint64_t bytes = 0;
  std::uint64_t lost = 0;
  std::uint64_t corrupted = 0;
  std::uint64_t foreign = 0;
  std::uint64_t unsent = 0;
  std::uint64_t unfetched = 0;
  Time age{};
  Time round_trip{};

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("frame_rate", self.frame_rate, "1/s", "frames received a second, over the last second");
    visit("byte_rate", self.byte_rate, "byte/s", "bytes received a second, over the last second");
    visit("loss", self.loss, "1", "share of the FCU's frames that did not arrive, over the last second");
    visit("bytes", self.bytes, "byte", "received since the start");
    visit("lost", self.lost, "1", "frames missing in the FCU's count, since the start");
    visit("corrupted", self.corrupted, "1", "frames whose checksum was wrong");
    visit("foreign", self.foreign, "1", "start bytes that were not of the dialect");
    visit("unsent", self.unsent, "1", "frames dropped here, because the line took no more");
    visit("unfetched", self.unfetched, "1", "messages dropped here, because nobody took them");
    visit("age", self.age, "ns", "since the last frame");
    visit("round_trip", self.round_trip, "ns", "of the latest time exchange");
  }
};

/// Counts what arrives. The FCU counts its frames, all kinds together, in a byte: gaps are losses.
class LinkStatistics {
 public:
  void take(const rosflight::Frame& frame, Time now);
  void count_unsent() { ++unsent_; }
  /// Looks once a second how much has come. Call it often.
  void advance(Time now, const rosflight::DecoderCounts& counts);
  /// The FCU began counting anew, or the line was cut.
  void restart() { sequence_.reset(); }

  LinkHealth health(Time now, const rosflight::DecoderCounts& counts, Time round_trip) const;
  /// Frames missing in the unit's count, since the start.
  std::uint64_t lost() const { return lost_; }
  /// Frames of one kind in the last whole second.
  int rate(std::size_t kind) const { return rates_[kind]; }

 private:
  std::optional<std::uint8_t> sequence_;
  std::optional<Time> last_frame_;
  std::uint64_t lost_ = 0;
  std::uint64_t unsent_ = 0;
  std::array<int, rosflight::kDialect.size()> counting_{};
  std::array<int, rosflight::kDialect.size()> rates_{};
  Time second_began_{};
  rosflight::DecoderCounts at_second_;
  std::uint64_t lost_at_second_ = 0;
  double frame_rate_ = 0.0;
  double byte_rate_ = 0.0;
  double loss_ = 0.0;
};

}  // namespace ironbird::hil_bridge
