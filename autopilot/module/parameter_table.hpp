#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace ironbird::autopilot {

class Module;

/// A value that a parameter can take.
using ParameterValue = std::variant<bool, int, double>;

/// One parameter: where it lives and what it may be. No `describe`: it is what a `describe` was read into.
struct ParameterSlot {
  std::string path;
  std::variant<bool*, int*, double*> value;
  std::string unit;
  std::string description;
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  Module* owner = nullptr;
};

/// What became of an attempt to set a parameter.
enum class SetOutcome : std::uint8_t {
  kAccepted,
  kUnknown,
  kWrongType,
  kOutOfBounds,
  kNotFinite,
  kConflict,    ///< it does not fit the other parameters of its module
  kNotInFlight  ///< the vehicle could fall or turn over
};

constexpr std::array<std::pair<SetOutcome, std::string_view>, 7> enumerators(SetOutcome) {
  return {{{SetOutcome::kAccepted, "accepted"},
           {SetOutcome::kUnknown, "unknown"},
           {SetOutcome::kWrongType, "wrong type"},
           {SetOutcome::kOutOfBounds, "out of bounds"},
           {SetOutcome::kNotFinite, "not finite"},
           {SetOutcome::kConflict, "does not fit"},
           {SetOutcome::kNotInFlight, "not in flight"}}};
}

/// A parameter and the value it is to have.
using ParameterSetting = std::pair<std::string, ParameterValue>;

/// Every parameter of the autopilot under its path, for example `estimator.gnss.sigma_position`.
class ParameterTable {
 public:
  /// Adds the described struct `params` under `prefix`. Leaves are bool, int and double; structs nest.
  template <class Params>
  void add(const std::string& prefix, Params& params, Module* owner) {
    Params::describe(params, Collector{*this, prefix, owner});
  }

  /// Forgets every parameter below `prefix`.
  void remove(std::string_view prefix);

  /// Sets one parameter and tells its module. Refused whole, with the reason, or done whole.
  /// @param in_flight  a value that could bring the vehicle down is refused; otherwise it is what it is
  /// configured to
  /// @param reason     what does not fit together, after kConflict, or what must stay, after kNotInFlight
  SetOutcome set(std::string_view path, const ParameterValue& value, bool in_flight = false,
                 std::string* reason = nullptr);

  /// Sets many parameters; only the last state need fit together. Those that cannot be set are passed over.
  /// @return what does not fit together, after the prefix of the module; empty when all does
  std::string set_all(const std::vector<ParameterSetting>& settings);

  /// The value at `path`, or none.
  std::optional<ParameterValue> get(std::string_view path) const;

  /// The slot at `path`, or null.
  const ParameterSlot* find(std::string_view path) const;

  /// All slots, in order of registration.
  const std::vector<ParameterSlot>& slots() const { return slots_; }

 private:
  struct Collector {
    ParameterTable& table;
    std::string prefix;
    Module* owner;

    template <class Value>
    void operator()(const char* name, Value& value, const char* unit, const char* description,
                    double lower = -std::numeric_limits<double>::infinity(),
                    double upper = std::numeric_limits<double>::infinity()) const {
      const std::string path = prefix + "." + name;
      if constexpr (std::is_same_v<Value, bool> || std::is_same_v<Value, int> ||
                    std::is_same_v<Value, double>) {
        table.slots_.push_back({path, &value, unit, description, lower, upper, owner});
      } else {
        Value::describe(value, Collector{table, path, owner});
      }
    }
  };

  std::vector<ParameterSlot> slots_;
};

}  // namespace ironbird::autopilot
