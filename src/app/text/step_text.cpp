#include "app/text/step_text.h"

#include "base/format.h"

#include <fmt/format.h>

namespace sprung {
namespace {

constexpr int kDigits = 6;

}  // namespace

std::string describe_steps(const LoadedScene& loaded) {
  const SimulatorSettings& settings = loaded.simulator.settings();
  const std::string inner =
      settings.inner_substeps > 1 ? fmt::format(" with {}", counted(settings.inner_substeps, "inner substep")) : "";
  return fmt::format("{} of {} s{} ({})", counted(settings.steps_per_frame, "step"), format_number(settings.step, kDigits), inner,
                     loaded.scene.step ? "as given" : "automatic");
}

}  // namespace sprung
