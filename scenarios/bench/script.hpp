#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ironbird::scenarios {

/// Which of a scenario's items are due: those with a time of their own, and those that wait for an event to
/// happen first.
///
/// Items are numbered in the order in which they were added, and become due in that order when their times
/// are equal.
class Script {
 public:
  using Time = std::chrono::nanoseconds;

  /// How an item stands to the end of the run.
  enum class Role {
    kIndifferent,   ///< given out at its time, at the end as well
    kBeforeTheEnd,  ///< would come to nothing at the end: left when an end is due, too
    kEnd            ///< is the end
  };

  /// Adds an item that is due `delay` after the start, or, with `after` not empty, after the event of that
  /// name first happened.
  /// @return its number
  std::size_t add(const std::string& after, Time delay, Role role = Role::kIndifferent);

  /// An event happened: items waiting for it get their time. Later events of the same name change nothing.
  void happened(std::string_view name, Time now);

  /// The next item that is due at `now` and was not given out before, or nothing.
  std::optional<std::size_t> next_due(Time now);

  /// An item that was never given out.
  struct Left {
    std::size_t item = 0;
    std::string after;        ///< the event that it waits for
    std::optional<Time> due;  ///< when it would have been due; none: the event has not happened
  };

  /// What is left, in the order in which it was added.
  std::vector<Left> left() const;

 private:
  struct Item {
    std::string after;
    Time delay{};
    Role role = Role::kIndifferent;
    std::optional<Time> due;
    bool given_out = false;
  };

  std::vector<Item> items_;
  Time earliest_{Time::max()};
  void find_earliest();
  bool ends_by(Time now) const;
};

}  // namespace ironbird::scenarios
