// How much memory there is.
#pragma once

namespace sprung {

/// What this machine has [bytes]; infinity where it does not say.
[[nodiscard]] double machine_memory();

}  // namespace sprung
