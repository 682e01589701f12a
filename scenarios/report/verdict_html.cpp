#include "scenarios/report/verdict_html.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "scenarios/report/plot/svg.hpp"
#include "scenarios/requirements/number_text.hpp"

namespace ironbird::scenarios {

namespace {

using plot::escaped;

std::string element(const std::string& tag, const std::string& css_class, const std::string& inner) {
  const std::string attribute = css_class.empty() ? "" : plot::attribute("class", css_class);
  return "<" + tag + attribute + ">" + inner + "</" + tag + ">";
}

/// The typographic minus sign for numbers that people read.
std::string typeset(std::string number) {
  if (number.starts_with('-') && number.size() > 1) number.replace(0, 1, "\u2212");
  return number == "-" ? "\u2013" : number;
}

std::string margin_text(const CheckResult& check) {
  if (std::isnan(check.margin)) return "\u2013";
  return (check.margin > 0.0 ? "+" : "") + typeset(with_unit(check.margin, check.unit, check.angles));
}

std::string time_cell(double time) {
  if (std::isnan(time)) return element("td", "number", "\u2013");
  return "<td class=\"number\"><a class=\"moment\" href=\"#figures\"" + plot::attribute("data-time", time) +
         ">" + typeset(with_unit(time, "s")) + "</a></td>";
}

std::string summary_line(const Verdict& verdict) {
  const auto count = [&](Outcome outcome) {
    return std::count_if(verdict.checks.begin(), verdict.checks.end(),
                         [=](const CheckResult& check) { return check.outcome == outcome; });
  };
  if (verdict.checks.empty()) return "Nothing was asked of this run.";
  std::string line = std::to_string(count(Outcome::kPass)) + " of " + std::to_string(verdict.checks.size()) +
                     (verdict.checks.size() == 1 ? " check holds" : " checks hold");
  if (const auto failed = count(Outcome::kFail)) line += ", " + std::to_string(failed) + " failed";
  if (const auto open = count(Outcome::kInconclusive)) line += ", " + std::to_string(open) + " inconclusive";
  if (const auto open = count(Outcome::kNotJudged)) line += ", " + std::to_string(open) + " not judged";
  return line + ".";
}

std::string identity(const ReportRun& run) {
  const Verdict none;
  const RunIdentity& id = run.verdict() ? run.verdict()->run : none.run;
  const auto either = [](const std::string& a, const std::string& b) { return a.empty() ? b : a; };
  const std::string digest = either(id.digest, run.about("digest"));
  const std::string seed = run.verdict() ? std::to_string(id.seed) : run.about("seed");
  const std::array<std::pair<const char*, std::string>, 6> facts{
      {{"scenario", either(id.scenario, run.about("scenario"))},
       {"source", run.about("source")},
       {"vehicle", run.about("vehicle")},
       {"seed", seed},
       {"digest", digest.substr(0, 16)},
       {"version", run.about("version")}}};
  std::string out;
  for (const auto& [name, value] : facts) {
    if (!value.empty()) out += "<div><dt>" + std::string(name) + "</dt><dd>" + escaped(value) + "</dd></div>";
  }
  return element("dl", "identity", out);
}

/// What was replayed, and how: a line each.
std::string flight_facts(const ReplayedFlight& flight) {
  // What nobody found, for the flight was told it, is not shown.
  const auto found = [](const std::string& what, const std::string& why) {
    return why.empty() ? "" : what + " (" + why + ")";
  };
  const std::string mag =
      flight.magnetometer ? "instance " + std::to_string(*flight.magnetometer) : std::string("none");
  const std::array<std::pair<const char*, std::string>, 7> facts{
      {{"log", flight.file},
       {"recorded by", flight.recorder + (flight.simulated ? ", a simulation" : "")},
       {"compared with",
        flight.compared_with.empty() ? "nothing: the log has no estimate" : flight.compared_with},
       {"from", found(with_unit(flight.window_begin, "s") + " to " + with_unit(flight.window_end, "s"),
                      flight.window_source)},
       {"magnetometer", found(mag, flight.magnetometer_source)},
       {"declination", found(with_unit(flight.declination, "rad"), flight.declination_source)},
       {"fixes",
        found(with_unit(1e3 * flight.gnss_delay, "ms") + " old on arrival", flight.gnss_delay_source)}}};
  std::string out;
  for (const auto& [name, value] : facts) {
    if (value.empty()) continue;
    out += "<div><dt>" + std::string(name) + "</dt><dd>" + typeset(escaped(value)) + "</dd></div>";
  }
  return element("dl", "identity flight", out);
}

/// The figures that the paper reports, as tiles.
std::string tiles(const Verdict& verdict) {
  constexpr std::array<std::pair<const char*, const char*>, 12> kShown{
      {{"horizontal_difference_rms_m", "horizontal difference, rms"},
       {"down_difference_rms_m", "difference down, rms"},
       {"velocity_difference_rms_mps", "velocity difference, rms"},
       {"roll_difference_rms_deg", "roll difference, rms"},
       {"pitch_difference_rms_deg", "pitch difference, rms"},
       {"heading_difference_rms_deg", "heading difference, rms"},
       {"path_rms_total_m", "path error, rms"},
       {"true_path_rms_total_m", "true path error, rms"},
       {"estimate_position_rms_m", "position estimate, rms"},
       {"estimate_velocity_rms_mps", "velocity estimate, rms"},
       {"estimate_attitude_rms_deg", "attitude estimate, rms"},
       {"flight_s", "time airborne"}}};
  std::string out;
  for (const auto& [name, title] : kShown) {
    const auto metric = std::find_if(verdict.metrics.begin(), verdict.metrics.end(),
                                     [name = name](const Metric& m) { return m.name == name; });
    if (metric == verdict.metrics.end() || std::isnan(metric->value)) continue;
    out += "<div class=\"tile\"><b>" + typeset(short_number(metric->value)) + "<i>" + escaped(metric->unit) +
           "</i></b><span>" + title + "</span></div>";
  }
  return element("div", "tiles", out);
}

std::string titled_section(const std::string& title, const ReportRun& run, bool labelled) {
  return "<section><h2>" + title + (labelled ? " of " + escaped(run.label()) : "") + "</h2>";
}

/// Why it is not a pass, and what to know although it is.
std::string reasons_list(const Verdict& verdict) {
  std::string items;
  for (const std::string& reason : verdict.reasons) items += element("li", "", escaped(reason));
  for (const std::string& warning : verdict.warnings)
    items += element("li", "", "warning: " + escaped(warning));
  return items.empty() ? "" : element("ul", "reasons", items);
}

std::string heading_of_run(const ReportRun& run) {
  const std::string title =
      run.verdict() && !run.verdict()->run.title.empty() ? run.verdict()->run.title : run.about("title");
  return escaped(title.empty() ? run.label() : title);
}

}  // namespace

std::string verdict_section(const ReportRun& run) {
  const bool judged = run.verdict().has_value();
  const std::string word = judged ? std::string(name_of(run.verdict()->outcome)) : "not judged";
  std::string out = "<section class=\"verdict " + (judged ? word : "inconclusive") + "\">";
  out += "<div class=\"stamp\">" + escaped(word) + "</div><div class=\"words\"><h1>" + heading_of_run(run) +
         "</h1>";
  out += element("p", "summary", judged ? summary_line(*run.verdict()) : "There is no verdict of this log.");
  for (const std::string& note : run.notes()) out += element("p", "warning", escaped(note));
  if (judged) out += reasons_list(*run.verdict());
  if (judged && run.verdict()->flight) out += flight_facts(*run.verdict()->flight);
  out += identity(run) + "</div></section>";
  return judged ? out + tiles(*run.verdict()) : out;
}

std::string checks_table(const ReportRun& run, bool labelled) {
  if (!run.verdict() || run.verdict()->checks.empty()) return "";
  std::string rows;
  for (const CheckResult& check : run.verdict()->checks) {
    const std::string word(name_of(check.outcome));
    rows += "<tr><td>" + element("span", "badge " + word, word) + "</td><th scope=\"row\">" +
            escaped(check.name) + "</th>" +
            element("td", "number margin " + word, escaped(margin_text(check))) + time_cell(check.time) +
            element("td", "", escaped(check.explanation)) + "</tr>";
  }
  return titled_section("Checks", run, labelled) +
         "<div "
         "class=\"scroll\"><table><thead><tr><th>verdict</th><th>required</th><th "
         "class=\"number\">margin</th><th class=\"number\">decided "
         "at</th><th>found</th></tr></thead><tbody>" +
         rows + "</tbody></table></div></section>";
}

std::string metrics_table(const std::vector<ReportRun>& runs) {
  std::vector<Metric> names;
  for (const ReportRun& run : runs) {
    if (run.verdict() && names.empty()) names = run.verdict()->metrics;
  }
  if (names.empty()) return "";
  std::string head, rows;
  for (const ReportRun& run : runs) {
    head += element("th", "number", runs.size() == 1 ? "value" : escaped(run.label()));
  }
  for (const Metric& metric : names) {
    std::string cells;
    for (const ReportRun& run : runs) {
      double value = NAN;
      for (const Metric& own : run.verdict() ? run.verdict()->metrics : std::vector<Metric>()) {
        if (own.name == metric.name) value = own.value;
      }
      cells += element("td", "number", typeset(short_number(value)));
    }
    rows += "<tr><th scope=\"row\"><code>" + escaped(metric.name) + "</code></th>" + cells +
            element("td", "", escaped(metric.unit)) + element("td", "meaning", escaped(metric.meaning)) +
            "</tr>";
  }
  return "<section><h2>Metrics</h2><div class=\"scroll\"><table><thead><tr><th>metric</th>" + head +
         "<th>unit</th><th>meaning</th></tr></thead><tbody>" + rows + "</tbody></table></div></section>";
}

std::string events_table(const ReportRun& run, bool labelled) {
  std::string rows;
  for (const RunEvent& event : run.events()) {
    rows += "<tr>" + time_cell(event.time) + element("td", "", escaped(event.kind)) +
            element("td", "", escaped(event.text)) + "</tr>";
  }
  if (rows.empty()) return "";
  return titled_section("Events", run, labelled) +
         "<div class=\"scroll\"><table class=\"short\"><thead><tr><th "
         "class=\"number\">at</th><th>kind</th><th>what</th></tr></thead><tbody>" +
         rows + "</tbody></table></div></section>";
}

std::string configuration_section(const ReportRun& run) {
  const std::string config = run.about("config");
  if (config.empty()) return "";
  return "<details><summary>Configuration of " + escaped(run.label()) + "</summary><pre>" + escaped(config) +
         "</pre></details>";
}

}  // namespace ironbird::scenarios
