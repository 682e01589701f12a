#pragma once

#include "scenarios/app/run_job.hpp"

namespace ironbird::scenarios {

/// Makes what the job asks for from the log of a finished run: report, snapshots, film.
/// @throws std::runtime_error naming the file that could not be made
void make_products(const RunJob& job, const Verdict& verdict, const Terminal& terminal);

}  // namespace ironbird::scenarios
