#include "scenarios/requirements/verdict_json.hpp"

#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

#include "scenarios/config/user_error.hpp"
#include "scenarios/config/write_file.hpp"
#include "scenarios/requirements/difference_metrics.hpp"

namespace ironbird::scenarios {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kMinusInfinity = "-infinity";
/// Said of a margin that people read in radians; of others nothing is.
constexpr const char* kRadians = "radians";

/// JSON has no word for infinite: null for "none", a text for a margin without end.
Json number(double value) {
  if (value == -std::numeric_limits<double>::infinity()) return kMinusInfinity;
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

double number_at(const Json& object, const char* key) {
  const Json& value = object.at(key);
  if (value == kMinusInfinity) return -std::numeric_limits<double>::infinity();
  return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
}

Outcome outcome_from(const std::string& text) {
  for (const auto& [value, name] : enumerators(Outcome{})) {
    if (name == text) return value;
  }
  throw std::invalid_argument("\"" + text + "\" is no verdict");
}

Json check_to_json(const CheckResult& check) {
  Json json{{"name", check.name},
            {"kind", check.kind},
            {"verdict", name_of(check.outcome)},
            {"margin", number(check.margin)},
            {"unit", check.unit},
            {"time", number(check.time)},
            {"explanation", check.explanation}};
  if (check.angles == Angles::kRadians) json["angles"] = kRadians;
  return json;
}

CheckResult check_from_json(const Json& json) {
  return {.name = json.at("name"),
          .kind = json.at("kind"),
          .outcome = outcome_from(json.at("verdict")),
          .margin = number_at(json, "margin"),
          .unit = json.at("unit"),
          .time = number_at(json, "time"),
          .explanation = json.at("explanation"),
          .angles = json.value("angles", "") == kRadians ? Angles::kRadians : Angles::kDegrees};
}

Json timing_to_json(const BenchTiming& timing) {
  Json stages = Json::array();
  for (const DurationCounts& stage : timing.stages) {
    Json buckets = Json::array();
    for (std::size_t i = 0; i < stage.counts.size(); ++i) {
      buckets.push_back(Json::array({number(stage.up_to[i]), stage.counts[i]}));
    }
    stages.push_back({{"name", stage.name},
                      {"meaning", stage.meaning},
                      {"count", stage.count},
                      {"p50_s", stage.p50},
                      {"p99_s", stage.p99},
                      {"greatest_s", stage.greatest},
                      {"buckets_up_to_s", std::move(buckets)}});
  }
  return {{"passes", timing.passes},
          {"missed_periods", timing.missed},
          {"most_missed_in_a_row", timing.most_missed},
          {"page_faults", timing.page_faults},
          {"stages", std::move(stages)}};
}

BenchTiming timing_from_json(const Json& json) {
  BenchTiming timing{{},
                     json.at("passes"),
                     json.at("missed_periods"),
                     json.at("most_missed_in_a_row"),
                     json.value("page_faults", std::uint64_t{})};
  for (const Json& stage : json.at("stages")) {
    DurationCounts counts{stage.at("name"),
                          stage.at("meaning"),
                          stage.at("count"),
                          stage.at("p50_s"),
                          stage.at("p99_s"),
                          stage.at("greatest_s"),
                          {},
                          {}};
    for (const Json& bucket : stage.at("buckets_up_to_s")) {
      const bool bounded = !bucket.at(0).is_null();
      counts.up_to.push_back(bounded ? bucket.at(0).get<double>() : std::numeric_limits<double>::infinity());
      counts.counts.push_back(bucket.at(1));
    }
    timing.stages.push_back(std::move(counts));
  }
  return timing;
}

Json flight_to_json(const ReplayedFlight& flight) {
  return {{"file", flight.file},
          {"recorder", flight.recorder},
          {"compared_with", flight.compared_with},
          {"simulated", flight.simulated},
          {"magnetometer", flight.magnetometer ? Json(*flight.magnetometer) : Json(nullptr)},
          {"magnetometer_source", flight.magnetometer_source},
          {"declination_rad", number(flight.declination)},
          {"declination_source", flight.declination_source},
          {"gnss_delay_s", number(flight.gnss_delay)},
          {"gnss_delay_source", flight.gnss_delay_source},
          {"window_s", Json::array({number(flight.window_begin), number(flight.window_end)})},
          {"window_source", flight.window_source}};
}

ReplayedFlight flight_from_json(const Json& json) {
  ReplayedFlight flight;
  flight.file = json.at("file");
  flight.recorder = json.at("recorder");
  flight.compared_with = json.at("compared_with");
  flight.simulated = json.at("simulated");
  if (!json.at("magnetometer").is_null()) flight.magnetometer = json.at("magnetometer").get<int>();
  flight.magnetometer_source = json.at("magnetometer_source");
  flight.declination = number_at(json, "declination_rad");
  flight.declination_source = json.at("declination_source");
  flight.gnss_delay = number_at(json, "gnss_delay_s");
  flight.gnss_delay_source = json.at("gnss_delay_source");
  flight.window_begin = json.at("window_s").at(0);
  flight.window_end = json.at("window_s").at(1);
  flight.window_source = json.at("window_source");
  return flight;
}

/// Unit and meaning of a metric; empty for one that this version does not know.
Metric known_metric(const std::string& name) {
  for (Metric& metric : RunMetrics::names_and_units()) {
    if (metric.name == name) return metric;
  }
  for (Metric& metric : difference_metrics("the recorded estimate")) {
    if (metric.name == name) return metric;
  }
  return {name, 0.0, "", ""};
}

}  // namespace

std::string to_json(const Verdict& verdict) {
  Json checks = Json::array();
  for (const CheckResult& check : verdict.checks) checks.push_back(check_to_json(check));
  Json metrics = Json::object();
  for (const Metric& metric : verdict.metrics) metrics[metric.name] = number(metric.value);
  Json events = Json::array();
  for (const RunEvent& event : verdict.events) {
    events.push_back({{"time", number(event.time)}, {"kind", event.kind}, {"text", event.text}});
  }
  Json json{{"scenario", verdict.run.scenario},
            {"title", verdict.run.title},
            {"seed", verdict.run.seed},
            {"digest", verdict.run.digest},
            {"verdict", name_of(verdict.outcome)},
            {"reasons", verdict.reasons},
            {"warnings", verdict.warnings},
            {"checks", std::move(checks)},
            {"metrics", std::move(metrics)},
            {"events", std::move(events)}};
  if (verdict.timing) json["timing"] = timing_to_json(*verdict.timing);
  if (verdict.flight) json["flight"] = flight_to_json(*verdict.flight);
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Verdict verdict_from_json(const std::string& text) {
  Verdict verdict;
  try {
    const Json json = Json::parse(text);
    verdict.run = {json.at("scenario"), json.at("title"), json.at("seed"), json.at("digest")};
    verdict.outcome = outcome_from(json.at("verdict"));
    verdict.reasons = json.at("reasons").get<std::vector<std::string>>();
    verdict.warnings = json.value("warnings", std::vector<std::string>{});
    for (const Json& check : json.at("checks")) verdict.checks.push_back(check_from_json(check));
    for (const auto& [name, value] : json.at("metrics").items()) {
      verdict.metrics.push_back(known_metric(name));
      verdict.metrics.back().value = number_at(json.at("metrics"), name.c_str());
    }
    for (const Json& event : json.at("events")) {
      verdict.events.push_back({number_at(event, "time"), event.at("kind"), event.at("text")});
    }
    if (json.contains("timing")) verdict.timing = timing_from_json(json.at("timing"));
    if (json.contains("flight")) verdict.flight = flight_from_json(json.at("flight"));
  } catch (const Json::exception& error) {
    throw std::invalid_argument(std::string("no verdict: ") + error.what());
  }
  return verdict;
}

void write_verdict(const Verdict& verdict, const std::filesystem::path& file) {
  write_file(file, to_json(verdict));
}

Verdict read_verdict(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  if (!stream) throw UserError(file.string() + ": cannot be read");
  try {
    return verdict_from_json(text.str());
  } catch (const std::invalid_argument& error) {
    throw UserError(file.string() + ": " + error.what() + "; move it away to see the log without a verdict");
  }
}

}  // namespace ironbird::scenarios
