#pragma once

#include "scenarios/record/log.hpp"
#include "scenarios/video/film_script.hpp"

namespace ironbird::scenarios {

/// Is this the log of a recorded flight that was replayed?
bool is_replayed(const Log& log);

/// The film of a replayed flight: the vehicle where our estimate says, the recorded one as its ghost, trails
/// of both, and the receiver's fixes as small marks. It begins when there is an estimate.
///
/// Heights: the ground is where our estimate stands on it; in a flight that was recorded in the air
/// throughout, where the recorded estimate counts from. The constant by which the two count apart is taken
/// off. Rotors turn while the vehicle was armed; how fast is not in the log.
/// @throws UserError when there was no estimate, or when it lasts longer than a day
FilmScript replay_film_script(const Log& log, const FilmOptions& options);

}  // namespace ironbird::scenarios
