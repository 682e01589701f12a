#pragma once

namespace ironbird::scenarios {

/// Names the elementary functions in use. A program that calls it has the reproducible ones linked in, also
/// for the engines' use: sin, cos, exp, log, pow and their kin then give the same bits on every x86-64
/// processor.
const char* reproducible_math();

}  // namespace ironbird::scenarios
