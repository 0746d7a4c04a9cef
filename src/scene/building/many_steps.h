// What is said of automatic steps so small that a frame takes very many.
#pragma once

#include "network/spring_network.h"
#include "scene/building/step_choice.h"
#include "scene/format/scene.h"

#include <optional>
#include <string>

namespace sprung {

/// What asks for the steps, and what to change; none while a frame takes no more than a thousand. `by_passes` tells whether passes
/// of the stretch limit ask for them.
[[nodiscard]] std::optional<std::string> many_steps_warning(const Scene& scene, const SpringNetwork& network,
                                                            const StepChoice& choice, bool by_passes);

}  // namespace sprung
