// Warns of automatic steps that are very small.
#pragma once

#include "network/model/spring_network.h"
#include "scene/format/scene.h"
#include "scene/step_choice/step_choice.h"

#include <optional>
#include <string>

namespace sprung {

/// States the cause of the small step and a remedy; none for up to a thousand steps per frame. `by_passes`: passes of the stretch
/// limit need the small step.
[[nodiscard]] std::optional<std::string> many_steps_warning(const Scene& scene, const SpringNetwork& network,
                                                            const StepChoice& choice, bool by_passes);

}  // namespace sprung
