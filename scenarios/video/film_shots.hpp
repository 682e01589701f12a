#pragma once

#include <string>
#include <vector>

#include "scenarios/video/film.hpp"
#include "scenarios/video/film_script.hpp"

// What every film needs, whatever it shows.

namespace ironbird::scenarios {

/// rad/s that the streaks of a faster rotor seem to turn with.
inline constexpr double kApparentSpeed = 9.0;
/// s over which the speed in the text is taken.
inline constexpr double kSpeedWindow = 0.1;

/// When a picture is taken, s: the time between `begin` and `end` that the options want, both ends included.
/// @param of  whose times they are, in messages
/// @throws UserError when a film would last longer than a day
std::vector<double> frame_times(const std::string& of, double begin, double end, const FilmOptions& options);

/// Gives every frame its camera, by the cuts. @throws std::invalid_argument when there is no such camera
void aim_cameras(FilmScript& script, const FilmOptions& options);

}  // namespace ironbird::scenarios
