#pragma once

#include <string>
#include <string_view>
#include <utility>

#include "autopilot/module/module.hpp"

namespace ironbird::autopilot {

/// Gives a module a plain, described struct of parameters that can be read and changed by path.
///
/// @tparam Base    the module interface, for example Estimator
/// @tparam Params  a struct with `describe`; its member initialisers are the defaults. When some values do
///                 not fit together it has `static std::string_view conflict(const Params&)`
template <class Base, class Params>
class Tunable : public Base {
 public:
  Tunable() = default;
  explicit Tunable(Params params) : params_(std::move(params)) {}

  const Params& params() const { return params_; }

  /// Replaces all parameters at once and rebuilds what depends on them.
  void set_params(const Params& params) {
    params_ = params;
    on_parameters();
  }

  void register_parameters(ParameterTable& table, const std::string& prefix) final {
    table.add(prefix, params_, this);
  }
  void parameters_changed() final { on_parameters(); }
  std::string_view parameter_conflict() const final {
    if constexpr (requires { Params::conflict(params_); }) {
      return Params::conflict(params_);
    } else {
      return {};
    }
  }

 protected:
  /// Rebuilds constants derived from the parameters. Called after every change, between two ticks.
  virtual void on_parameters() {}

 private:
  Params params_;
};

}  // namespace ironbird::autopilot
