#include "app/step_text.h"

#include "base/format.h"

#include <fmt/format.h>

namespace sprung {
namespace {

constexpr int kDigits = 6;

}  // namespace

std::string describe_steps(const LoadedScene& loaded) {
  return fmt::format("{} of {} s ({})", counted(loaded.simulator.settings().steps_per_frame, "step"),
                     format_number(loaded.simulator.settings().step, kDigits), loaded.scene.step ? "as given" : "automatic");
}

}  // namespace sprung
