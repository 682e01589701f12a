#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <utility>

#include "hil_bridge/transport/byte_stream.hpp"

namespace ironbird::hil_bridge::transport {

/// Two ends of a line inside one program: what goes in at one end comes out at the other, at once. For tests
/// and for runs that want bytes without a kernel in between.
class StreamPair {
 public:
  /// @param room  bytes that each direction holds before it takes no more
  explicit StreamPair(std::size_t room = 1U << 20U);

  ByteStream& near() { return near_; }
  ByteStream& far() { return far_; }

  /// Cuts the line: both ends go down and what was under way is lost.
  void hang_up();

 private:
  class End final : public ByteStream {
   public:
    End(std::deque<std::uint8_t>& in, std::deque<std::uint8_t>& out, std::size_t room, std::string name)
        : in_(in), out_(out), room_(room), name_(std::move(name)) {}
    std::size_t read(std::span<std::uint8_t> to) override;
    std::size_t write(std::span<const std::uint8_t> from) override;
    bool is_up() const override { return up_; }
    bool reopen() override { return up_ = true; }
    std::string name() const override { return name_; }
    void cut() { up_ = false; }

   private:
    std::deque<std::uint8_t>& in_;
    std::deque<std::uint8_t>& out_;
    std::size_t room_;
    std::string name_;
    bool up_ = true;
  };

  std::deque<std::uint8_t> to_near_;
  std::deque<std::uint8_t> to_far_;
  End near_;
  End far_;
};

}  // namespace ironbird::hil_bridge::transport
