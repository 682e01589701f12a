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
///                 not fit together it has `static std::string_view conflict(const Params&)`; when some may
///                 not change much in flight, `static std::string_view danger(const Params& configured, const
///                 Params& now)`
template <class Base, class Params>
class Tunable : public Base {
 public:
  Tunable() = default;
  explicit Tunable(Params params) : params_(std::move(params)), configured_(params_) {}

  const Params& params() const { return params_; }

  /// Replaces all parameters at once and rebuilds what depends on them.
  void set_params(const Params& params) {
    params_ = params;
    parameters_configured();
  }

  void register_parameters(ParameterTable& table, const std::string& prefix) final {
    table.add(prefix, params_, this);
  }
  void parameters_changed() final { on_parameters(); }
  void parameters_configured() final {
    configured_ = params_;
    on_parameters();
  }
  void configured_like(const Module& predecessor) final {
    if (const auto* same = dynamic_cast<const Tunable*>(&predecessor)) configured_ = same->configured_;
  }
  std::string_view parameter_conflict() const final {
    if constexpr (requires { Params::conflict(params_); }) {
      return Params::conflict(params_);
    } else {
      return {};
    }
  }
  std::string_view parameter_danger() const final {
    if constexpr (requires { Params::danger(configured_, params_); }) {
      return Params::danger(configured_, params_);
    } else {
      return {};
    }
  }

 protected:
  /// Rebuilds constants derived from the parameters. Called after every change, between two ticks.
  virtual void on_parameters() {}

 private:
  Params params_;
  Params configured_ = params_;
};

}  // namespace ironbird::autopilot
