// Ctrl-C and its relatives.
#pragma once

namespace sprung {

/// From now on the first SIGINT and the first SIGTERM only make `interrupted` true; the second one ends the program at once. A file
/// that grows too large becomes an error instead of a signal.
void catch_signals();

[[nodiscard]] bool interrupted();

}  // namespace sprung
