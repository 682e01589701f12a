#pragma once

namespace ironbird::scenarios {

/// The style sheet of the page: light and dark, screen and paper. Colours c0…c7 are told apart by
/// colour-blind readers (after Okabe and Ito).
extern const char* const kPageStyle;

/// The script of the page: a cursor shared by all time axes, zoom by dragging, back by double click. Without
/// it the page reads the same.
extern const char* const kPageScript;

}  // namespace ironbird::scenarios
