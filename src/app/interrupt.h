// Handling of SIGINT (Ctrl-C), SIGTERM and SIGHUP (the terminal is closed).
#pragma once

namespace sprung {

/// After this call, the first SIGINT, SIGTERM or SIGHUP only sets `interrupted`; a second one ends the program at once. A file
/// beyond the size limit causes an error instead of a signal.
void catch_signals();

/// Whether one of them was received.
[[nodiscard]] bool interrupted();

}  // namespace sprung
