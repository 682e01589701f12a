#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "hil_bridge/transport/byte_stream.hpp"
#include "hil_bridge/transport/faulty_direction.hpp"

namespace ironbird::hil_bridge::transport {

/// How long the piece is that these bytes begin with; 0: the rest of it has not come yet.
using PieceLength = std::size_t (*)(std::span<const std::uint8_t> bytes);

/// Cuts what comes in one go, or in several, into pieces.
class PieceCutter {
 public:
  /// @param length  null: what comes in one go is a piece
  explicit PieceCutter(PieceLength length) : length_(length) {}

  /// @param put  takes a piece; says false when nothing more is to come
  /// @return has every piece been put?
  template <class Put>
  bool take(std::span<const std::uint8_t> bytes, Put&& put) {
    begun_.insert(begun_.end(), bytes.begin(), bytes.end());
    std::span<const std::uint8_t> left(begun_);
    bool wanted = true;
    while (wanted && !left.empty()) {
      const std::size_t length = length_ == nullptr ? left.size() : length_(left);
      if (length == 0) break;
      wanted = put(left.first(length));
      left = left.subspan(length);
    }
    begun_.erase(begun_.begin(), begun_.end() - static_cast<std::ptrdiff_t>(left.size()));
    return wanted;
  }
  /// What has begun is lost.
  void clear() { begun_.clear(); }

 private:
  PieceLength length_;
  std::vector<std::uint8_t> begun_;  // a piece of which the rest has not come yet
};

/// A line that loses, delays, spoils and cuts, around any other. Time is told to it, so that a run in
/// simulated time has the same faults every time.
class LinkFault final : public ByteStream {
 public:
  /// @param line  outlives this
  /// @param pieces  cuts what is read and what is written; null: what is read or written at once is a piece
  LinkFault(ByteStream& line, const LinkFaultConfig& config, std::uint64_t seed,
            PieceLength pieces = nullptr);

  /// What is due by `now` goes out, and what has come in is taken.
  void advance(std::chrono::nanoseconds now);

  /// Other faults from now on. @throws std::invalid_argument naming key, value and bound
  void set(const LinkFaultConfig& config);
  /// Nothing goes either way until then; nothing is lost.
  void stand_still(std::chrono::nanoseconds until);
  /// Cuts the line; it cannot be opened again before then.
  void hang_up(std::chrono::nanoseconds until);

  std::size_t read(std::span<std::uint8_t> to) override;
  /// Takes all, or nothing: as long as the line has not taken what was due before, and while as much waits
  /// for a slow line as a driver holds.
  std::size_t write(std::span<const std::uint8_t> from) override;
  bool is_up() const override { return up_ && line_.is_up(); }
  bool reopen() override;
  int descriptor() const override { return line_.descriptor(); }
  std::string name() const override { return line_.name() + " with faults"; }

  /// Something is due that the line does not take yet.
  bool waiting() { return outgoing_.due(now_) != nullptr; }

  const FaultCounts& outgoing() const { return outgoing_.counts(); }
  const FaultCounts& incoming() const { return incoming_.counts(); }

 private:
  void take(std::span<const std::uint8_t> bytes);
  void cut(std::chrono::nanoseconds closed_for);
  void forget();
  void send_due();

  ByteStream& line_;
  FaultyDirection outgoing_;
  FaultyDirection incoming_;
  PieceCutter written_;
  PieceCutter read_;
  std::chrono::nanoseconds now_{};
  std::chrono::nanoseconds closed_until_{};
  bool up_ = true;
};

}  // namespace ironbird::hil_bridge::transport
