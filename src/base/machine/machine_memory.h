// Size of the main memory.
#pragma once

namespace sprung {

/// The memory of this machine [bytes]; infinity if unknown.
[[nodiscard]] double machine_memory();

}  // namespace sprung
