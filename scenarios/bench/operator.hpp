#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <string>

#include "autopilot/autopilot.hpp"
#include "scenarios/bench/scenario_loader.hpp"
#include "scenarios/requirements/judge.hpp"

namespace ironbird::scenarios {

/// The autopilot of a scenario, with its parameters and its route.
/// @throws std::invalid_argument when the planner refuses the route
std::unique_ptr<autopilot::Autopilot> make_autopilot(const LoadedScenario& loaded,
                                                     const autopilot::Modules& modules);

/// Asks of the autopilot what a scenario's operator asks, and tells the judge.
class Operator {
 public:
  using Time = std::chrono::nanoseconds;
  /// Hears of a module that now flies in a slot: slot, kind, module.
  using OnSwap = std::function<void(const std::string&, const std::string&, const autopilot::Module&)>;

  /// All outlive this.
  Operator(const LoadedScenario& loaded, autopilot::Autopilot& pilot, Judge& judge)
      : loaded_(loaded), pilot_(pilot), judge_(judge) {}

  /// Hears of everything that is asked, and of what became of it.
  using OnRequest =
      std::function<void(const autopilot::Request&, const autopilot::RequestOutcome&, Time now)>;

  void on_swap(OnSwap hears) { on_swap_ = std::move(hears); }

  void on_request(OnRequest hears) { on_request_ = std::move(hears); }

  /// Does what an event asks of the autopilot; there is nothing else that it asks.
  void perform(const EventConfig& event, Time now);

  /// Asks; the judge hears of it. @return whether the autopilot accepted it
  bool ask(const autopilot::Request& request, const std::string& what, Time now);

  /// Asks what is asked again and again until it is granted; the judge hears of that only.
  /// @return whether the autopilot accepted it
  bool ask_until_granted(const autopilot::Request& request, const std::string& what, Time now);

 private:
  autopilot::RequestOutcome put(const autopilot::Request& request, Time now);
  void swap_module(const EventConfig& event, Time now);

  const LoadedScenario& loaded_;
  autopilot::Autopilot& pilot_;
  Judge& judge_;
  OnSwap on_swap_;
  OnRequest on_request_;
};

}  // namespace ironbird::scenarios
