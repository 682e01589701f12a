#pragma once

namespace ironbird::scenarios {

/// From now on Ctrl-C and a polite request to end are noted instead of ending the program at once.
void note_interrupts();

/// One came.
bool interrupt_requested();

}  // namespace ironbird::scenarios
