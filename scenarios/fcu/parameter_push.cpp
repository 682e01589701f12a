#include "scenarios/fcu/parameter_push.hpp"

#include <chrono>
#include <cstdio>
#include <functional>

#include "hil_bridge/transport/byte_stream.hpp"
#include "scenarios/app/interrupt.hpp"

namespace ironbird::scenarios {

namespace {

using hil_bridge::Connection;
using hil_bridge::ParameterClient;
using hil_bridge::ParameterDifference;
using hil_bridge::ParameterRecord;
using hil_bridge::Time;

constexpr int kPasses = 3;             // a value may change others: a canned mixer rewrites 220
constexpr double kSetPatience = 60.0;  // s, for a whole file over a bad line
constexpr double kSettle = 0.5;        // s in which the unit says what else has changed
constexpr Time kPushTellPeriod = std::chrono::seconds(2);
constexpr Time kQuiet = std::chrono::seconds(1);  // without a report: worth a word
constexpr Time kPushSilence =
    std::chrono::seconds(5);  // fifty reports: no line of which half arrives loses them

constexpr const char* kSilent = "the unit has fallen silent";
constexpr const char* kArmed = "the unit was armed";
constexpr const char* kInterrupted = "interrupted";

/// Waits for a unit that may fall silent or be armed meanwhile.
class Waiting {
 public:
  using Progress = std::function<std::string()>;

  explicit Waiting(UnitOnLine& unit) : unit_(unit) {}

  /// @param armed_too  an armed unit does what is waited for
  /// @param progress  how far it is
  /// @return empty when it is done or out of time, else why it is not waited for any more
  std::string wait(double seconds, bool armed_too, const Progress& progress,
                   const std::function<bool()>& done) {
    heard_ = told_ = unit_.now();
    std::string broken_off;
    unit_.until(seconds, [&] {
      if (done()) return true;
      broken_off = look(armed_too);
      tell(progress);
      return !broken_off.empty();
    });
    return interrupt_requested() ? kInterrupted : broken_off;
  }

 private:
  std::string look(bool armed_too) {
    const Time now = unit_.now();
    const Connection& connection = unit_.connection();
    const bool armed = connection.armed(now);
    if (armed || connection.disarmed(now)) heard_ = now;
    if (armed && !armed_too) return kArmed;
    return now - heard_ > kPushSilence ? kSilent : "";
  }

  void tell(const Progress& progress) {
    const Time now = unit_.now();
    if (now - told_ < kPushTellPeriod) return;
    told_ = now;
    const bool quiet = now - heard_ > kQuiet;
    std::fprintf(stderr, "%s%s\n", progress().c_str(), quiet ? "; the unit is silent, waiting for it" : "");
  }

  UnitOnLine& unit_;
  Time heard_{};
  Time told_{};
};

std::string of(std::size_t some, std::size_t all) {
  return std::to_string(some) + " of " + std::to_string(all) + " parameters";
}

void require_disarmed(UnitOnLine& unit) {
  if (unit.until(1.0, [&] { return unit.connection().disarmed(unit.now()); })) return;
  throw hil_bridge::transport::LinkError(
      "the unit does not report that it is disarmed; nothing was set. Disarm it first");
}

/// @return empty, or why not everything could be tried
std::string set_all(const std::vector<ParameterRecord>& wanted, UnitOnLine& unit) {
  ParameterClient& client = unit.connection().parameters();
  const auto changes = [&] { return hil_bridge::not_as_wanted(wanted, client.known()); };
  const auto progress = [&] {
    return of(wanted.size() - changes().size(), wanted.size()) + " are as wanted";
  };
  // After a cut of the line everything is found out anew, and set in the next pass.
  const auto done = [&] { return client.idle() && client.progress().complete; };
  Waiting waiting(unit);
  for (int pass = 0; pass < kPasses; ++pass) {
    const auto left = changes();
    if (left.empty()) return {};
    if (pass == 0) require_disarmed(unit);
    for (const ParameterDifference& change : left) client.set(*change.one);
    const std::string broken_off = waiting.wait(kSetPatience, false, progress, done);
    if (!broken_off.empty()) return broken_off;
    unit.until(kSettle, [] { return false; });
  }
  return {};
}

/// Asks for everything anew. @return empty, or why not all was told
std::string read_all(UnitOnLine& unit) {
  ParameterClient& client = unit.connection().parameters();
  client.start_download(unit.now());
  const auto& told = client.progress();
  const auto progress = [&] {
    return "reading back: " + of(static_cast<std::size_t>(told.known), static_cast<std::size_t>(told.count));
  };
  const std::string broken_off =
      Waiting(unit).wait(unit.patience() + kSetPatience, true, progress, [&] { return told.complete; });
  if (!broken_off.empty() || told.complete) return broken_off;
  return "the unit did not tell all of its parameters again";
}

}  // namespace

PushResult push_parameters(const std::vector<ParameterRecord>& wanted, UnitOnLine& unit) {
  ParameterClient& client = unit.connection().parameters();
  std::string broken_off = set_all(wanted, unit);
  if (!broken_off.empty()) client.forget_sets();  // it may be disarmed again while it is read
  // Nothing more is heard of a unit that is silent; an armed one still answers.
  std::vector<ParameterRecord> told = client.known();
  if (broken_off.empty() || broken_off == kArmed) {
    const std::string unread = read_all(unit);
    if (unread.empty()) told = client.known();
    if (broken_off.empty()) broken_off = unread;
  }
  return {hil_bridge::not_as_wanted(wanted, told), broken_off};
}

}  // namespace ironbird::scenarios
