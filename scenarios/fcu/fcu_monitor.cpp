#include <cstdio>
#include <memory>

#include "scenarios/app/exit_code.hpp"
#include "scenarios/app/interrupt.hpp"
#include "scenarios/app/terminal.hpp"
#include "scenarios/app/verb_options.hpp"
#include "scenarios/bench/run_time.hpp"
#include "scenarios/config/config_error.hpp"
#include "scenarios/fcu/fcu_verb.hpp"
#include "scenarios/fcu/latency.hpp"
#include "scenarios/fcu/monitor_text.hpp"
#include "scenarios/fcu/unit_line.hpp"

namespace ironbird::scenarios {

namespace {

constexpr double kRedraw = 0.1;      // s
constexpr double kLinePeriod = 1.0;  // s
constexpr double kMeasured = 60.0;   // s

struct MonitorArguments {
  UnitAddress address;
  double seconds = 0.0;
  bool json = false;
  bool latency = false;
  std::string self;
};

/// Draws over what it drew before.
class Screen {
 public:
  explicit Screen(bool colour) : colour_(colour) {}

  void draw(const Monitored& unit) {
    const Terminal terminal = Terminal::of_standard_output();
    std::vector<std::string> lines = monitor_screen(unit, terminal.columns, colour_);
    if (terminal.rows > 1 && lines.size() > terminal.rows - 1) lines.resize(terminal.rows - 1);
    std::string text = drawn_ > 0 ? "\033[" + std::to_string(drawn_) + "A\r" : "";
    for (const std::string& line : lines) text += line + "\033[K\n";
    std::fputs((text + "\033[J").c_str(), stdout);
    std::fflush(stdout);
    drawn_ = lines.size();
  }

 private:
  bool colour_;
  std::size_t drawn_ = 0;
};

/// Says once how the unit is, in the manner that was asked for.
class Teller {
 public:
  explicit Teller(bool json)
      : json_(json), terminal_(Terminal::of_standard_output()), screen_(terminal_.colour) {}

  double period() const { return redraws() ? kRedraw : kLinePeriod; }
  void tell(const Monitored& unit) {
    if (redraws()) return screen_.draw(unit);
    const std::string text = json_ ? monitor_json(unit) : monitor_line(unit) + "\n";
    std::fputs(text.c_str(), stdout);
    std::fflush(stdout);
  }

 private:
  bool redraws() const { return terminal_.interactive && !json_; }

  bool json_;
  Terminal terminal_;
  Screen screen_;
};

int watch(const MonitorArguments& arguments) {
  UnitOnLine unit(arguments.address, UnitOnLine::Talk::kQuestions);
  UnitView view;
  unit.listen([&view](const hil_bridge::Arrival& arrival) { view.take(arrival); });
  Teller teller(arguments.json);
  const hil_bridge::Time began = unit.now();
  const auto state = [&] {
    return Monitored{unit.fcu(), view, unit.name(), unit.line_up(), unit.now(), began};
  };
  for (int k = 1; !interrupt_requested(); ++k) {
    const bool endless = arguments.seconds == 0.0;
    const double next = endless ? k * teller.period() : std::min(k * teller.period(), arguments.seconds);
    unit.until(next - to_seconds(unit.now() - began), [] { return false; });
    teller.tell(state());
    if (!endless && next >= arguments.seconds) break;
  }
  if (silence_of(state()).empty()) return kExitPass;
  std::fprintf(stderr, "%s: %s\n", unit.name().c_str(), silence_of(state()).c_str());
  return kExitHardware;
}

int monitor(const MonitorArguments& arguments, const autopilot::Modules& modules) {
  note_interrupts();
  if (!arguments.latency && !arguments.self.empty())
    throw ConfigError("--self: only together with --latency");
  if (!arguments.latency) return watch(arguments);
  const double seconds = arguments.seconds > 0.0 ? arguments.seconds : kMeasured;
  const LatencyReport report = arguments.self.empty() ? latency_of_line(arguments.address, seconds)
                                                      : latency_of_self(arguments.self, seconds, modules);
  if (interrupt_requested()) return kExitInterrupted;
  std::fputs((arguments.json ? latency_json(report) : latency_text(report)).c_str(), stdout);
  return kExitPass;
}

}  // namespace

FcuWork declare_fcu_monitor(VerbOptions& options) {
  auto arguments = std::make_shared<MonitorArguments>();
  add_unit_address(options, arguments->address);
  options.option("--seconds", arguments->seconds, "end after so many seconds; of --latency 60 by default")
      .within(0.1, 86400.0);
  options.flag("--json", arguments->json, "one line of JSON a second, for programs");
  options.flag("--latency", arguments->latency, "measure round trips, beside the machine's own jitter");
  options
      .option("--self", arguments->self,
              "with --latency: no unit, but the scenario's virtual one on a pseudo-terminal made for it")
      .called("SCENARIO");
  options.footer(
      "Sends nothing but questions. On a terminal the view is redrawn in place, elsewhere a line is written "
      "each second.\n"
      "Exit code 3 when the unit is silent at the end. NO_COLOR and CI are heeded.\n"
      "Examples:\n"
      "  ironbird fcu monitor --port /dev/ttyACM0\n"
      "  ironbird fcu monitor --port /dev/ttyACM0 --seconds 10 --json\n"
      "  ironbird fcu monitor --latency --self scenarios/library/paper/three_waypoints.toml");
  return [arguments](const autopilot::Modules& modules) { return monitor(*arguments, modules); };
}

}  // namespace ironbird::scenarios
