#include "scenarios/requirements/assertions.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <stdexcept>
#include <utility>

#include "scenarios/config/nearest_name.hpp"
#include "scenarios/requirements/event_assertions.hpp"
#include "scenarios/requirements/number_text.hpp"
#include "scenarios/requirements/quantity_text.hpp"
#include "scenarios/requirements/value_assertions.hpp"

namespace ironbird::scenarios {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Every kind with whether `config` gives it.
std::array<std::pair<const char*, bool>, 15> kinds_in(const CheckConfig& c) {
  return {{{"rms_below", c.rms_below.has_value()},
           {"stays_below", c.stays_below.has_value()},
           {"stays_above", c.stays_above.has_value()},
           {"stays_within", c.stays_within.has_value()},
           {"final_below", c.final_below.has_value()},
           {"settles", c.settles.has_value()},
           {"overshoot_below", c.overshoot_below.has_value()},
           {"stays_within_tube", c.stays_within_tube.has_value()},
           {"reaches", c.reaches.has_value()},
           {"order_of_events", c.order_of_events.has_value()},
           {"none_of_events", c.none_of_events.has_value()},
           {"happens", c.happens.has_value()},
           {"never_happens", c.never_happens.has_value()},
           {"metric_below", c.metric_below.has_value()},
           {"metric_above", c.metric_above.has_value()}}};
}

Signal find(const SignalTable& table, const std::string& path, const char* key) {
  try {
    return table.find(path);
  } catch (const std::invalid_argument& wrong) {
    throw std::invalid_argument(std::string(key) + " = \"" + path + "\": " + wrong.what());
  }
}

Condition condition(const SignalTable& table, const std::string& text, const std::string& key) {
  try {
    return Condition::read(text, table);
  } catch (const std::invalid_argument& wrong) {
    throw std::invalid_argument(key + " = \"" + text + "\": " + wrong.what());
  }
}

Subject subject_of(const CheckConfig& config, const SignalTable& table) {
  if (!config.error.empty() && !config.signal.empty())
    throw std::invalid_argument("needs either signal or error, has both");
  if (!config.signal.empty()) return Subject(find(table, config.signal, "signal"));
  if (config.error.size() != 2) throw std::invalid_argument("needs a signal, or an error of two signals");
  if (config.error[0] == config.error[1])
    throw std::invalid_argument("error: both signals are " + config.error[0] +
                                ", whose difference is always 0");
  const Signal first = find(table, config.error[0], "error[0]");
  const Signal second = find(table, config.error[1], "error[1]");
  try {
    return {first, second};
  } catch (const std::invalid_argument& wrong) {
    throw std::invalid_argument(std::string("error: ") + wrong.what());
  }
}

/// What the kinds about values share.
struct Reader {
  const CheckConfig& config;
  const CheckContext& context;
  Subject subject;

  double quantity(const std::string& text, const char* key) const {
    return read_quantity(text, subject.unit(), key);
  }
  double positive(const std::string& text, const char* key, std::string_view unit) const {
    const double value = read_quantity(text, unit, key);
    if (value < 0.0) throw std::invalid_argument(std::string(key) + " = " + text + ", must be >= 0");
    return value;
  }
  Wording wording(const std::string& bound) const {
    return {bound, subject.name(), subject.unit(), subject.angles()};
  }
  std::string in_words(double value) const { return with_unit(value, subject.unit(), subject.angles()); }

  Eigen::Vector3d target() const {
    if (config.to_point && (subject.size() != 3 || !config.to.empty())) {
      throw std::invalid_argument("to_point is for a signal of three components, instead of to");
    }
    if (config.to_point) return *config.to_point;
    if (config.to.empty()) return Eigen::Vector3d::Zero();
    if (subject.size() != 1) throw std::invalid_argument("to is for a number, use to_point");
    return {quantity(config.to, "to"), 0.0, 0.0};
  }
  std::optional<double> tolerated_for() const {
    if (config.tolerated_for.empty()) return std::nullopt;
    return positive(config.tolerated_for, "tolerated_for", "s");
  }
  std::string tolerated_words() const {
    return config.tolerated_for.empty()
               ? ""
               : ", but for up to " + with_unit(*tolerated_for(), "s") + " at a stretch";
  }
};

std::unique_ptr<Assertion> make_stays(const std::string& kind, const Reader& read) {
  double low = -kInfinity, high = kInfinity;
  std::string words;
  if (kind == "stays_below") {
    high = read.quantity(*read.config.stays_below, "stays_below");
    words = "below " + read.in_words(high);
  } else if (kind == "stays_above") {
    low = read.quantity(*read.config.stays_above, "stays_above");
    words = "above " + read.in_words(low);
  } else {
    low = read.quantity(read.config.stays_within->low, "stays_within.low");
    high = read.quantity(read.config.stays_within->high, "stays_within.high");
    if (low > high) throw std::invalid_argument("stays_within.low is above stays_within.high");
    words = "between " + read.in_words(low) + " and " + read.in_words(high);
  }
  return std::make_unique<StaysBetween>(read.subject, read.wording(words + read.tolerated_words()),
                                        read.tolerated_for(), read.context.tick, low, high);
}

std::unique_ptr<Assertion> make_tube(const Reader& read) {
  if (read.subject.size() != 3 || read.subject.unit() != "m") {
    throw std::invalid_argument("stays_within_tube is for a position of three components");
  }
  if (read.context.autopilot == nullptr) throw std::invalid_argument("stays_within_tube: there is no route");
  const double radius = read.positive(*read.config.stays_within_tube, "stays_within_tube", "m");
  Wording wording =
      read.wording("within " + with_unit(radius, "m") + " of the path" + read.tolerated_words());
  wording.what += " distance from the path";
  return std::make_unique<StaysInTube>(read.subject, wording, read.tolerated_for(), read.context.tick, radius,
                                       *read.context.autopilot);
}

std::unique_ptr<Assertion> make_targeted(const std::string& kind, const Reader& read) {
  const std::string& unit = read.subject.unit();
  if (kind == "final_below") {
    const double bound = read.positive(*read.config.final_below, "final_below", unit);
    return std::make_unique<FinalBelow>(read.subject, read.wording("below " + read.in_words(bound)), bound,
                                        read.target());
  }
  if (kind == "settles") {
    const double band = read.positive(read.config.settles->band, "settles.band", unit);
    const double time = read.positive(read.config.settles->time, "settles.time", "s");
    const std::string words = "within " + read.in_words(band) + " after " + with_unit(time, "s");
    return std::make_unique<Settles>(read.subject, read.wording(words), band, time, read.target(),
                                     !read.config.after.empty());
  }
  if (kind == "overshoot_below") {
    if (read.subject.size() != 1)
      throw std::invalid_argument("overshoot_below is for a number, name a component");
    const double bound = read.positive(*read.config.overshoot_below, "overshoot_below", unit);
    return std::make_unique<OvershootBelow>(read.subject, read.wording("below " + read.in_words(bound)),
                                            bound, read.target());
  }
  const ReachesConfig& reaches = *read.config.reaches;
  const double tolerance = read.positive(reaches.tolerance, "reaches.tolerance", unit);
  const double by = reaches.by.empty() ? kInfinity : read.positive(reaches.by, "reaches.by", "s");
  std::string words = "within " + read.in_words(tolerance);
  if (!reaches.by.empty()) words += " by " + with_unit(by, "s");
  return std::make_unique<Reaches>(read.subject, read.wording(words), tolerance, by, read.target(),
                                   !read.config.after.empty());
}

std::string nearest_metric(const std::string& wrong, const std::vector<Metric>& known) {
  std::vector<std::string> names;
  for (const Metric& metric : known) names.push_back(metric.name);
  const std::string nearest = nearest_name(wrong, names);
  if (!nearest.empty()) return "; did you mean '" + nearest + "'?";
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "; there are " : ", ") + name;
  return all;
}

std::unique_ptr<Assertion> make_metric_bound(bool below, const CheckConfig& config) {
  const std::vector<Metric> known = RunMetrics::names_and_units();
  const auto metric = std::find_if(known.begin(), known.end(),
                                   [&](const Metric& candidate) { return candidate.name == config.metric; });
  if (metric == known.end())
    throw std::invalid_argument("metric = \"" + config.metric + "\": there is no such metric" +
                                nearest_metric(config.metric, known));
  if (metric->name == "real_time_factor") {
    throw std::invalid_argument("metric = \"real_time_factor\" depends on the machine, no verdict may");
  }
  const std::string key = below ? "metric_below" : "metric_above";
  const double bound = read_quantity(below ? *config.metric_below : *config.metric_above, metric->unit, key);
  return std::make_unique<MetricBound>(config.metric, bound, below);
}

std::unique_ptr<Assertion> make_without_subject(const std::string& kind, const CheckConfig& config,
                                                const SignalTable& table) {
  if (!config.signal.empty() || !config.error.empty()) {
    throw std::invalid_argument(kind + " takes neither signal nor error");
  }
  if (kind == "happens") {
    return std::make_unique<ConditionAssertion>(condition(table, *config.happens, kind), true,
                                                !config.after.empty());
  }
  if (kind == "never_happens") {
    return std::make_unique<ConditionAssertion>(condition(table, *config.never_happens, kind), false,
                                                !config.after.empty());
  }
  if (kind == "order_of_events") {
    if (config.order_of_events->empty()) throw std::invalid_argument("order_of_events names no event");
    return std::make_unique<OrderOfEvents>(*config.order_of_events);
  }
  if (kind == "none_of_events") {
    if (config.none_of_events->empty()) throw std::invalid_argument("none_of_events names no event");
    return std::make_unique<NoneOfEvents>(*config.none_of_events);
  }
  return make_metric_bound(kind == "metric_below", config);
}

/// The keys that a kind takes besides its own.
bool takes(const std::string& kind, const std::string& key) {
  if (key == "metric") return kind.starts_with("metric_");
  if (key == "after" || key == "until") return !kind.starts_with("metric_");
  if (key == "tolerated_for") return kind.starts_with("stays_");
  const bool has_target = kind == "final_below" || kind == "settles" || kind == "reaches";
  return has_target || (key == "to" && kind == "overshoot_below");
}

void refuse_unused(const std::string& kind, const CheckConfig& config) {
  const std::array<std::pair<const char*, bool>, 6> given{{{"after", !config.after.empty()},
                                                           {"until", !config.until.empty()},
                                                           {"to", !config.to.empty()},
                                                           {"to_point", config.to_point.has_value()},
                                                           {"tolerated_for", !config.tolerated_for.empty()},
                                                           {"metric", !config.metric.empty()}}};
  for (const auto& [key, is_given] : given) {
    if (is_given && !takes(kind, key))
      throw std::invalid_argument(std::string(key) + ": " + kind + " does not take " + key);
  }
}

bool has_subject(const std::string& kind) {
  return !kind.ends_with("_of_events") && kind != "happens" && kind != "never_happens" &&
         !kind.starts_with("metric_");
}

}  // namespace

std::string kind_of(const CheckConfig& config) {
  std::string kind, all;
  for (const auto& [name, given] : kinds_in(config)) {
    all += (all.empty() ? "" : ", ") + std::string(name);
    if (!given) continue;
    if (!kind.empty()) throw std::invalid_argument("both " + kind + " and " + name + " given, must be one");
    kind = name;
  }
  if (kind.empty()) throw std::invalid_argument("asserts nothing, must have one of " + all);
  return kind;
}

bool is_about_all_of_its_window(const std::string& kind) {
  return kind != "happens" && kind != "reaches" && kind != "order_of_events";
}

std::unique_ptr<Assertion> make_assertion(const std::string& kind, const CheckConfig& config,
                                          const CheckContext& context) {
  refuse_unused(kind, config);
  if (!has_subject(kind)) return make_without_subject(kind, config, *context.signals);
  const Reader read{config, context, subject_of(config, *context.signals)};
  if (kind == "stays_within_tube") return make_tube(read);
  if (kind.starts_with("stays_")) return make_stays(kind, read);
  if (kind != "rms_below") return make_targeted(kind, read);
  const double bound = read.positive(*config.rms_below, "rms_below", read.subject.unit());
  return std::make_unique<RmsBelow>(read.subject, read.wording("below " + read.in_words(bound)), bound);
}

}  // namespace ironbird::scenarios
