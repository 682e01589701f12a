#include "scenarios/report/report.hpp"

#include <cmath>
#include <optional>

#include "scenarios/config/write_file.hpp"
#include "scenarios/report/figures.hpp"
#include "scenarios/report/flight_data.hpp"
#include "scenarios/report/page_style.hpp"
#include "scenarios/report/plot/svg.hpp"
#include "scenarios/report/replay_figures.hpp"
#include "scenarios/report/timing_html.hpp"
#include "scenarios/report/verdict_html.hpp"
#include "scenarios/requirements/number_text.hpp"

namespace ironbird::scenarios {

namespace {

std::string figure(const std::string& title, const std::string& legend, const std::string& drawing) {
  return "<figure><figcaption>" + plot::escaped(title) + "</figcaption>" + legend + drawing + "</figure>";
}

/// A drawing that is too wide for a narrow page comes in two widths, of which the page shows one: shrunk, its
/// letters could not be read.
std::string figure(const plot::TimeStack& stack, const plot::TimeFrame& frame) {
  constexpr double kNarrowPage = 580.0;  // px
  const std::string drawing = plot::draw(stack, frame);
  if (stack.width <= kNarrowPage) return figure(stack.title, plot::legend(stack), drawing);
  plot::TimeStack narrow = stack;
  narrow.width = kNarrowPage;
  return figure(stack.title, plot::legend(stack),
                "<div class=\"wide\">" + drawing + "</div><div class=\"narrow\">" +
                    plot::draw(narrow, frame) + "</div>");
}

/// Where the error down comes from that is there before the vehicle moves.
std::string about_heights(const std::vector<ReportRun>& runs) {
  constexpr double kWorthAWord = 0.005;  // m
  for (const ReportRun& run : runs) {
    const std::optional<double> apart = height_apart(run);
    if (!apart || std::abs(*apart) < kWorthAWord) continue;
    return "<p class=\"hint\">The estimate counts heights from where the centre of mass stood, the truth "
           "from "
           "the ground: the position error down begins with " +
           plot::escaped(with_unit(std::round(*apart * 1000.0) / 1000.0, "m")) + ".</p>";
  }
  return "";
}

std::string figures(const std::vector<ReportRun>& runs) {
  const plot::TimeFrame frame = time_frame(runs);
  plot::Plane path = path_from_above(runs);
  const plot::TimeStack position = position_and_heading(runs);
  constexpr double kLower = 13.0;  // px that the axis of a stack ends lower than that of a plane
  path.width = 480.0;
  path.height = plot::height(position, frame) - kLower;  // as tall as the stack beside it
  std::string out =
      "<section id=\"figures\"><h2>Flight</h2><p class=\"hint\">Move over a figure to read all of them at "
      "one time; "
      "drag to zoom in time, double click to see everything. A command is drawn where it is followed: the "
      "trajectory's, or what an operator's setpoint says of it.</p>";
  out += "<div class=\"pair\">" + figure(path.title, plot::legend(path), plot::draw(path)) +
         figure(position, frame) + "</div></section>";
  out += "<section>" + figure(path_errors(runs), frame) + "</section>";
  out += "<section><h2>Estimate less truth</h2>" + about_heights(runs) + "<div class=\"triple\">" +
         figure(position_errors(runs), frame) + figure(velocity_errors(runs), frame) +
         figure(attitude_errors(runs), frame) + "</div></section>";
  out += "<section><h2>Vehicle</h2>" + figure(attitude_and_speed(runs), frame) +
         figure(motors_and_battery(runs), frame) + "</section>";
  return out;
}

/// The figures of a recorded flight that was fed to other estimators.
std::string replay_figures(const std::vector<ReportRun>& runs) {
  const plot::TimeFrame frame = time_frame(runs);
  plot::Plane path = replayed_path(runs);
  const plot::TimeStack position = replayed_position(runs);
  path.width = 480.0;
  path.height = plot::height(position, frame);
  std::string out =
      "<section id=\"figures\"><h2>Flight</h2><p class=\"hint\">Move over a figure to read all of them at "
      "one time; drag to zoom in time, double click to see everything. Heights are counted from what each "
      "barometer said at its own start: a constant between them says nothing.</p>";
  out += "<div class=\"pair\">" + figure(path.title, plot::legend(path), plot::draw(path)) +
         figure(position, frame) + "</div></section>";
  for (const plot::TimeStack& stack :
       {replayed_velocity(runs), replayed_attitude(runs), replayed_differences(runs),
        replayed_innovations(runs), replayed_biases(runs)}) {
    out += "<section>" + figure(stack, frame) + "</section>";
  }
  return out;
}

std::string page_title(const std::vector<ReportRun>& runs) {
  if (runs.size() != 1) return std::to_string(runs.size()) + " runs";
  const ReportRun& run = runs.front();
  const std::string word = run.verdict() ? std::string(name_of(run.verdict()->outcome)) + ": " : "";
  return word + (run.verdict() ? run.verdict()->run.scenario : run.label());
}

}  // namespace

std::string report_html(const std::vector<ReportRun>& runs) {
  std::string out =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"/>"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/><title>" +
      plot::escaped(page_title(runs)) + "</title><style>" + kPageStyle + "</style></head>\n<body><main>\n";
  for (const ReportRun& run : runs) out += verdict_section(run) + "\n";
  for (const ReportRun& run : runs) out += checks_table(run, runs.size() > 1) + "\n";
  if (!runs.empty()) out += (is_replay(runs.front()) ? replay_figures(runs) : figures(runs)) + "\n";
  out += metrics_table(runs) + "\n";
  for (const ReportRun& run : runs) out += timing_section(run);
  for (const ReportRun& run : runs) out += events_table(run, runs.size() > 1) + "\n";
  for (const ReportRun& run : runs) out += configuration_section(run) + "\n";
  out += "<footer>Ironbird. North-east-down; times since the start of the run.</footer>\n</main>\n<script>";
  return out + kPageScript + "</script></body></html>\n";
}

void write_report(const std::vector<ReportRun>& runs, const std::filesystem::path& file) {
  write_file(file, report_html(runs));
}

}  // namespace ironbird::scenarios
