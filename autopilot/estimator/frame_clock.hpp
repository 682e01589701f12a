#pragma once

#include "autopilot/types/time.hpp"

namespace ironbird::autopilot {

/// Carries the stamps of the frames to a time that never goes back, whatever the sender's clock does.
///
/// A stamp that is older than the newest, or further ahead than a gap of the IMU may be, is doubted: one wild
/// stamp among good ones changes nothing. When the doubted stamps agree with each other the sender's clock
/// has moved for good. Forward that is a gap. Back, nobody knows how long the sender was away: the time then
/// goes on after an assumed pause, long enough that nothing from before counts as fresh.
class FrameClock {
 public:
  /// Whether a frame with this stamp is to be worked with.
  bool admits(Time stamp) {
    const Time ahead = stamp + shift_ - newest_;
    if (!started_ || (ahead >= Time{0} && ahead <= kLongestGap)) return go_on(stamp);
    ++refused_;
    const bool agrees = doubting_ && stamp >= doubted_ && stamp - doubted_ <= kLongestGap;
    if (!agrees) doubted_since_ = stamp;
    agreeing_ = agrees ? agreeing_ + 1 : 0;
    doubting_ = true;
    doubted_ = stamp;
    const Time span = doubted_ - doubted_since_;
    if (ahead > Time{0}) return span > Time{0} && go_on(stamp);
    if (span < kPatience || agreeing_ < kLeastAgreeing) return false;
    shift_ += kAssumedPause + span - ahead;
    return go_on(stamp);
  }

  /// To be added to the stamps of the frame that was admitted last.
  Time shift() const { return shift_; }

  /// So many frames in a row were refused that the last estimate says nothing about the present.
  bool lost() const { return refused_ > kMostRefused; }

  /// A gap of the IMU beyond which the attitude is anybody's guess.
  static constexpr Time kLongestGap = std::chrono::milliseconds(500);

 private:
  static constexpr Time kPatience = std::chrono::milliseconds(50);
  static constexpr Time kAssumedPause = std::chrono::seconds(1);
  static constexpr int kLeastAgreeing = 4;  // with the one before; stamps at random do not
  static constexpr int kMostRefused = 20;   // 50 ms of a common IMU; the stamps cannot tell

  bool go_on(Time stamp) {
    started_ = true;
    newest_ = stamp + shift_;
    refused_ = 0;
    doubting_ = false;
    return true;
  }

  bool started_ = false;
  Time newest_{0};
  Time shift_{0};
  bool doubting_ = false;
  Time doubted_{0};
  Time doubted_since_{0};
  int agreeing_ = 0;
  int refused_ = 0;
};

}  // namespace ironbird::autopilot
