// Handling of SIGINT (Ctrl-C) and SIGTERM.
#pragma once

namespace sprung {

/// After this call, the first SIGINT and the first SIGTERM only set `interrupted`; a second one ends the program at once. A file
/// beyond the size limit causes an error instead of a signal.
void catch_signals();

/// Whether SIGINT or SIGTERM was received.
[[nodiscard]] bool interrupted();

}  // namespace sprung
