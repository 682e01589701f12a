#include "scenarios/bench/probe_recorder.hpp"

#include <algorithm>
#include <cctype>
#include <limits>
#include <string_view>

namespace ironbird::scenarios {

namespace {

constexpr double kNobodyThere = std::numeric_limits<double>::quiet_NaN();

/// A name that a log's schema takes: small letters, digits, underscores.
std::string field_name(std::string_view name) {
  std::string field;
  for (const char c : name) {
    const auto letter = static_cast<unsigned char>(c);
    field += std::isalnum(letter) != 0 ? static_cast<char>(std::tolower(letter)) : '_';
  }
  return field;
}

class CollectFields final : public autopilot::ProbeVisitor {
 public:
  void operator()(std::string_view name, double, std::string_view unit) override {
    fields.push_back({field_name(name), std::string(unit), std::string(name)});
  }
  void operator()(std::string_view name, const autopilot::Vector3&, std::string_view unit) override {
    for (const char* axis : {"_x", "_y", "_z"}) {
      fields.push_back({field_name(name) + axis, std::string(unit), std::string(name)});
    }
  }
  std::vector<NumberField> fields;
};

/// Writes into a row that is as long as the module had fields when it was first watched.
class CollectValues final : public autopilot::ProbeVisitor {
 public:
  explicit CollectValues(std::vector<double>& row) : row_(row) {}
  void operator()(std::string_view, double value, std::string_view) override { put(value); }
  void operator()(std::string_view, const autopilot::Vector3& value, std::string_view) override {
    for (int axis = 0; axis < 3; ++axis) put(value(axis));
  }

 private:
  void put(double value) {
    if (next_ < row_.size()) row_[next_++] = value;
  }
  std::vector<double>& row_;
  std::size_t next_ = 0;
};

}  // namespace

void ProbeRecorder::watch(const std::string& slot, const std::string& kind, const autopilot::Module& module) {
  const std::string topic = "/autopilot/" + slot + "/" + kind + "/probe";
  for (Probe& probe : probes_) {
    if (probe.slot != slot) continue;
    probe.module = nullptr;
    std::fill(probe.values.begin(), probe.values.end(), kNobodyThere);
  }
  const auto known =
      std::find_if(probes_.begin(), probes_.end(), [&](const Probe& p) { return p.topic == topic; });
  if (known != probes_.end()) {
    known->module = &module;
    return;
  }
  CollectFields collect;
  module.probe(collect);
  if (collect.fields.empty()) return;
  probes_.push_back({slot, topic, &module, std::vector<double>(collect.fields.size(), kNobodyThere)});
  recorder_.add_numbers(topic, collect.fields, probes_.back().values.data(), period_);
}

void ProbeRecorder::observe(Time now) {
  if (now < next_) return;
  next_ = (now / period_ + 1) * period_;
  for (Probe& probe : probes_) {
    if (probe.module == nullptr) continue;
    CollectValues collect(probe.values);
    probe.module->probe(collect);
  }
}

}  // namespace ironbird::scenarios
