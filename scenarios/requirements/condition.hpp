#pragma once

#include <string>

#include "scenarios/requirements/signal_table.hpp"

namespace ironbird::scenarios {

/// A comparison such as `autopilot.flight.phase == offboard` or `truth.p_NB_N.z < -5 m`, bound to its signal.
///
/// The right side is a quantity in the signal's unit, the name of a value of an enumeration, `true` or
/// `false`. A signal alone is true when it is not zero.
class Condition {
 public:
  /// @throws std::invalid_argument naming what does not fit
  static Condition read(const std::string& text, const SignalTable& table);

  const std::string& text() const { return text_; }

  /// Unit of the margin: the signal's, or 1 for what only holds or does not.
  const std::string& unit() const { return unit_; }
  Angles angles() const { return signal_.angles(); }

  bool present() const { return signal_.present(); }

  /// The number compared, SI.
  double value() const { return signal_.value(); }

  /// How far it is from changing: positive when it holds, negative when not, never 0; 1 and -1 for
  /// equalities. Not a number when the signal is none.
  double margin() const;

 private:
  enum class Comparison { kEqual, kDifferent, kBelow, kAtMost, kAbove, kAtLeast };

  /// A check that forbids what no value of an enumeration fulfils would never fail.
  void refuse_impossible() const;

  std::string text_;
  std::string unit_;
  Signal signal_;
  Comparison comparison_ = Comparison::kEqual;
  double value_ = 0.0;
};

}  // namespace ironbird::scenarios
