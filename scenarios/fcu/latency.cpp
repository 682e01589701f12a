#include "scenarios/fcu/latency.hpp"

#include <poll.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "hil_bridge/executive/real_time_rights.hpp"
#include "hil_bridge/transport/machine_clock.hpp"
#include "scenarios/app/interrupt.hpp"
#include "scenarios/bench/run_time.hpp"
#include "scenarios/fcu/printed.hpp"
#include "scenarios/fcu/side_process.hpp"

namespace ironbird::scenarios {

namespace {

using hil_bridge::Time;
using hil_bridge::transport::machine_time;
namespace rosflight = hil_bridge::rosflight;

constexpr int kLookPatience = 100;  // ms
constexpr int kAskedOf = 4;         // every so many IMU frames: 100 questions a second of 400 Hz
// Upper ends of the bins, us.
constexpr std::array kBins = {10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10000};

double microseconds(Time time) {
  return 1e-3 * static_cast<double>(time.count());
}

std::array<std::size_t, kBins.size() + 1> counted(const Spread& spread) {
  std::array<std::size_t, kBins.size() + 1> counts{};
  for (const Time time : spread.times) {
    const auto bin =
        std::find_if(kBins.begin(), kBins.end(), [&](int end) { return microseconds(time) <= end; });
    ++counts[static_cast<std::size_t>(bin - kBins.begin())];
  }
  return counts;
}

std::string summary(const char* name, const Spread& spread, const std::string& meaning) {
  return printed("  %-12s p50 %8.1f us   p99 %8.1f us   greatest %8.1f us   %zu times", name,
                 microseconds(spread.quantile(0.5)), microseconds(spread.quantile(0.99)),
                 microseconds(spread.quantile(1.0)), spread.times.size()) +
         ": " + meaning + "\n";
}

constexpr const char* kJitterMeaning =
    "how late this machine woke a sleeper without priority in the same time";

nlohmann::ordered_json json_of(const Spread& spread, const std::string& meaning) {
  return {{"meaning", meaning},
          {"count", spread.times.size()},
          {"p50_us", microseconds(spread.quantile(0.5))},
          {"p99_us", microseconds(spread.quantile(0.99))},
          {"greatest_us", microseconds(spread.quantile(1.0))},
          {"histogram_us", kBins},
          {"histogram", counted(spread)}};
}

/// One look at the line: takes what came, asks for the clock when it is time to.
class Asker {
 public:
  explicit Asker(UnitOnLine& unit) : unit_(unit) {
    unit_.listen([this](const hil_bridge::Arrival& arrival) { take(arrival); });
  }

  void look() {
    pollfd state{unit_.descriptor(), POLLIN, 0};
    poll(&state, 1, kLookPatience);
    const Time woken = machine_time();
    asked_ = false;
    unit_.step();
    if (asked_) turn_around.push_back(machine_time() - woken);
  }

  std::vector<Time> round_trip;
  std::vector<Time> turn_around;

 private:
  void take(const hil_bridge::Arrival& arrival) {
    if (const auto* answer = std::get_if<rosflight::Timesync>(&arrival.message);
        answer != nullptr && answer->tc1 > 0)
      round_trip.push_back(machine_time() - Time{answer->ts1});
    if (!std::holds_alternative<rosflight::SmallImu>(arrival.message) || ++frames_ % kAskedOf != 0) return;
    unit_.fcu().send(rosflight::Timesync{.tc1 = 0, .ts1 = machine_time().count()});
    asked_ = true;
  }

  UnitOnLine& unit_;
  int frames_ = 0;
  bool asked_ = false;
};

}  // namespace

Spread::Spread(std::vector<Time> unordered) : times(std::move(unordered)) {
  std::sort(times.begin(), times.end());
}

Time Spread::quantile(double share) const {
  if (times.empty()) return Time::zero();
  const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(times.size())));
  return times[std::max<std::size_t>(rank, 1) - 1];
}

std::vector<std::string> take_rights_of_a_run(const hil_bridge::transport::AwakeCores& awake) {
  std::vector<std::string> missing{hil_bridge::take_real_time_rights(), awake.missing()};
  std::erase(missing, "");
  return missing;
}

std::string latency_text(const LatencyReport& report) {
  std::string text = "latency at " + report.where + "\n";
  for (const std::string& right : report.missing) text += "  " + right + "\n";
  text += summary("round trip", report.round_trip, report.round_trip_meaning);
  text += summary("turn-around", report.turn_around, report.turn_around_meaning);
  text += summary("jitter", report.jitter, kJitterMeaning);
  text += printed("  %14s %12s %12s %12s\n", "up to", "round trip", "turn-around", "jitter");
  const auto trips = counted(report.round_trip);
  const auto turns = counted(report.turn_around);
  const auto jitter = counted(report.jitter);
  for (std::size_t k = 0; k < trips.size(); ++k) {
    const std::string end = k < kBins.size() ? std::to_string(kBins[k]) + " us" : "more";
    text += printed("  %14s %12zu %12zu %12zu\n", end.c_str(), trips[k], turns[k], jitter[k]);
  }
  return text;
}

std::string latency_json(const LatencyReport& report) {
  nlohmann::ordered_json json;
  json["where"] = report.where;
  json["round_trip"] = json_of(report.round_trip, report.round_trip_meaning);
  json["turn_around"] = json_of(report.turn_around, report.turn_around_meaning);
  json["jitter"] = json_of(report.jitter, kJitterMeaning);
  json["missing"] = report.missing;
  return json.dump(2) + "\n";
}

LatencyReport latency_of_line(const UnitAddress& address, double seconds) {
  SharedTimes late(kHourOfWakings);
  UnitOnLine unit(address, UnitOnLine::Talk::kQuestions);
  unit.meet();
  const hil_bridge::transport::AwakeCores awake;
  const SideProcess sleeper([&] { measure_jitter(late); });
  LatencyReport report;
  report.missing = take_rights_of_a_run(awake);
  Asker asker(unit);
  const Time end = machine_time() + from_seconds(seconds);
  while (machine_time() < end && !interrupt_requested()) asker.look();
  if (asker.round_trip.empty() && !interrupt_requested()) {
    throw hil_bridge::transport::LinkError(unit.name() + ": the unit answered no question for its clock");
  }
  report.where = unit.name();
  report.round_trip_meaning = "question for the unit's clock to its answer; a unit answers in its next pass";
  report.round_trip = Spread(asker.round_trip);
  report.turn_around_meaning = "woken by an IMU frame to the question handed to the line";
  report.turn_around = Spread(asker.turn_around);
  report.jitter = Spread(late.all());
  return report;
}

}  // namespace ironbird::scenarios
