#pragma once

#include <filesystem>
#include <string>

#include "scenarios/requirements/verdict.hpp"

namespace ironbird::scenarios {

/// The verdict as JSON text: keys scenario, title, seed, digest, verdict, reasons, checks, metrics, events,
/// in this order, `timing` of a run in real time and `flight` of a replay; what is no number is null. The
/// same run gives the same bytes, but for the metric `real_time_factor`.
std::string to_json(const Verdict& verdict);

/// Reads what to_json() wrote. @throws std::invalid_argument naming what is missing or wrong
Verdict verdict_from_json(const std::string& text);

/// Writes `file`. @throws std::runtime_error naming it when it cannot be written
void write_verdict(const Verdict& verdict, const std::filesystem::path& file);

/// Reads `file`. @throws std::runtime_error naming it when it cannot be read or is no verdict
Verdict read_verdict(const std::filesystem::path& file);

}  // namespace ironbird::scenarios
