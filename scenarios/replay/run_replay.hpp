#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/bench/logged_request.hpp"
#include "scenarios/record/byte_buffer.hpp"
#include "scenarios/replay/first_difference.hpp"
#include "scenarios/replay/replay.hpp"
#include "scenarios/replay/run_log.hpp"

namespace ironbird::scenarios {

/// Feeds the frames and requests of a run's log to an autopilot again, in the order of then, and holds
/// everything that it computes against what was logged, bit by bit.
///
/// With the configuration of then, and the same program, all of it must come out the same: that is a check of
/// the result. With another configuration it tells what that autopilot would have made of the same sensors;
/// it does not fly, so only its estimate means something.
class RunReplay {
 public:
  /// @param log, loaded  outlive this
  /// @throws as Replay
  RunReplay(const RunLog& log, const LoadedScenario& loaded, const autopilot::Modules& modules,
            ReplayOptions options);

  /// From the first message to the last. Called once. @throws UserError for a message that is damaged
  ReplayResult run();

 private:
  using Handler = std::function<void(const McapMessage&)>;
  using Encode = std::function<void(ByteBuffer&)>;

  /// One thing that the autopilot computes, and what became of it.
  struct Watched {
    std::string topic;
    Encode encode;  ///< as it is now
    std::vector<Ros2MessageType> types;
    std::uint64_t compared = 0;
    std::uint64_t different = 0;
    hil_bridge::Time first{};  ///< when it was different first
    FieldDifference how;
  };

  void wire(std::uint16_t id, const McapChannel& channel);
  template <class T>
  void watch(std::uint16_t id, const McapChannel& channel, const T& live);
  template <class T>
  void take_over(std::uint16_t id, const McapChannel& channel, T& live);
  template <class T>
  void pass_on(std::uint16_t id, const McapChannel& channel);
  void take_frame(const McapMessage& message);
  void take_request(const McapMessage& message);
  void compare(Watched& watched, const McapMessage& message);
  /// What was different first; null: nothing.
  const Watched* first_different() const;
  std::string difference_text(const Watched& first) const;
  CheckResult same_as_then() const;
  std::vector<std::string> remarks() const;

  const RunLog& log_;
  Replay replay_;
  bool same_configuration_;
  std::map<std::uint16_t, Handler> handlers_;
  std::map<std::uint16_t, Watched> watched_;  // by channel
  std::vector<std::string> not_compared_;     // topics
  LoggedRequest request_;                     // the newest, and what became of it
  ByteBuffer now_;                            // what was computed, as it would be logged
  std::uint32_t next_frame_ = 0;
  std::uint32_t frames_missing_ = 0;
  hil_bridge::Time last_frame_{};
  std::optional<hil_bridge::Time> whole_until_;  // no frame is missing up to this one; none: none at all
  bool more_ = true;
};

}  // namespace ironbird::scenarios
