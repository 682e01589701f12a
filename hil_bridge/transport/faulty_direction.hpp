#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <span>
#include <string_view>
#include <vector>

#include "simulator/random/stream.hpp"

namespace ironbird::hil_bridge::transport {

/// What goes wrong with one direction of a line or a bus. A piece is what is lost or spoilt as a whole: a
/// frame.
struct DirectionFaults {
  double drop = 0.0;
  double burst_start = 0.0;
  double burst_end = 0.1;
  double corrupt = 0.0;
  double insert = 0.0;
  double duplicate = 0.0;
  double reorder = 0.0;
  double stall = 0.0;
  std::chrono::nanoseconds stall_time{};
  std::chrono::nanoseconds latency{};
  std::chrono::nanoseconds jitter{};
  double byte_rate = 0.0;
  double hang_up = 0.0;
  std::chrono::nanoseconds hang_up_time{};

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("drop", self.drop, "1", "probability that a piece is lost", 0.0, 1.0);
    visit("burst_start", self.burst_start, "1", "probability that a burst of losses begins with a piece", 0.0,
          1.0);
    visit("burst_end", self.burst_end, "1", "probability that it ends with a piece; 1/it is its mean length",
          1e-6, 1.0);
    visit("corrupt", self.corrupt, "1", "probability that a byte has a false bit", 0.0, 1.0);
    visit("insert", self.insert, "1", "probability that 1 to 16 bytes of noise come before a piece", 0.0,
          1.0);
    visit("duplicate", self.duplicate, "1", "probability that a piece comes twice", 0.0, 1.0);
    visit("reorder", self.reorder, "1", "probability that a piece comes after the one behind it", 0.0, 1.0);
    visit("stall", self.stall, "1", "probability that the line stands still with a piece", 0.0, 1.0);
    visit("stall_time", self.stall_time, "ns", "how long it stands", 0.0, 1e11);
    visit("latency", self.latency, "ns", "least delay of a piece", 0.0, 1e10);
    visit("jitter", self.jitter, "ns", "greatest delay on top, any as likely as another", 0.0, 1e10);
    visit("byte_rate", self.byte_rate, "byte/s", "what the line carries, a tenth of the baud rate; 0: any",
          0.0, 1e9);
    visit("hang_up", self.hang_up, "1", "probability that the line is cut with a piece", 0.0, 1.0);
    visit("hang_up_time", self.hang_up_time, "ns", "how long it cannot be opened again", 0.0, 1e11);
  }
};

/// Both directions, as seen from the end that has the fault: the bench's.
struct LinkFaultConfig {
  DirectionFaults outgoing;
  DirectionFaults incoming;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("outgoing", self.outgoing, "", "what is written here");
    visit("incoming", self.incoming, "", "what is read here");
  }
};

/// What the faults of one direction did.
struct FaultCounts {
  std::uint64_t pieces = 0;
  std::uint64_t dropped = 0;
  std::uint64_t corrupted_bytes = 0;
  std::uint64_t inserted_bytes = 0;
  std::uint64_t duplicated = 0;
  std::uint64_t reordered = 0;
  std::uint64_t stalls = 0;
  std::uint64_t hang_ups = 0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit&& visit) {
    visit("pieces", self.pieces, "1", "handed over");
    visit("dropped", self.dropped, "1", "pieces lost, bursts included");
    visit("corrupted_bytes", self.corrupted_bytes, "byte", "with a false bit");
    visit("inserted_bytes", self.inserted_bytes, "byte", "of noise");
    visit("duplicated", self.duplicated, "1", "pieces that came twice");
    visit("reordered", self.reordered, "1", "pieces that came after the one behind them");
    visit("stalls", self.stalls, "1", "times that the line stood still");
    visit("hang_ups", self.hang_ups, "1", "times that the line was cut");
  }
};

/// One direction of a faulty line or bus: pieces go in, what is left of them comes out when it is due. Pure;
/// every kind of fault draws from its own stream of random numbers, so that one does not move another.
class FaultyDirection {
 public:
  /// @param name  of the direction, in the names of its streams
  /// @throws std::invalid_argument naming key, value and bound
  FaultyDirection(const DirectionFaults& faults, std::uint64_t seed, std::string_view name);

  /// Other faults from now on; the streams go on. @throws as the constructor
  void set(const DirectionFaults& faults);
  const DirectionFaults& faults() const { return faults_; }

  /// Nothing more comes out before then, and nothing is lost.
  void stand_still(std::chrono::nanoseconds until);

  /// @return does the line hold?
  bool put(std::span<const std::uint8_t> piece, std::chrono::nanoseconds now);

  struct Due {
    std::chrono::nanoseconds when{};
    std::vector<std::uint8_t> bytes;
    bool noise = false;  ///< was never a piece
  };
  /// The next piece that is due by `now`, or null. It stays until `pop`.
  Due* due(std::chrono::nanoseconds now);
  void pop() { under_way_.pop_front(); }

  /// May more be put? A line that carries few bytes a second holds what a driver does, not all that is said.
  bool has_room(std::chrono::nanoseconds now) const;

  /// What is under way is lost.
  void clear();
  bool empty() const { return under_way_.empty(); }
  const FaultCounts& counts() const { return counts_; }

 private:
  bool lost();
  void deliver(std::vector<std::uint8_t> bytes, bool noise, std::chrono::nanoseconds now);
  void spoil(std::vector<std::uint8_t>& bytes);
  void make_noise(std::chrono::nanoseconds now);

  DirectionFaults faults_;
  simulator::Stream drop_;
  simulator::Stream burst_;
  simulator::Stream corrupt_;
  simulator::Stream insert_;
  simulator::Stream duplicate_;
  simulator::Stream reorder_;
  simulator::Stream stall_;
  simulator::Stream delay_;
  simulator::Stream hang_up_;
  bool in_burst_ = false;
  std::chrono::nanoseconds line_free_{};
  std::deque<Due> under_way_;
  FaultCounts counts_;
};

}  // namespace ironbird::hil_bridge::transport
