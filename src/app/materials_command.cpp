#include "app/command_line.h"
#include "app/commands.h"
#include "app/console.h"
#include "scene/json/nearest_name.h"
#include "scene/materials/materials.h"

#include <fmt/format.h>

namespace sprung {

ExitCode print_materials(const MaterialsOptions& options) {
  if (options.name.empty()) {
    print_result(materials_overview());
    return ExitCode::done;
  }
  const Material* const material = find_material(options.name);
  if (material == nullptr) {
    const auto names = material_names({MaterialKind::cloth, MaterialKind::rope, MaterialKind::solid});
    throw UsageError(fmt::format("there is no material {}; {}", options.name, suggestion(options.name, names)));
  }
  print_result(material_description(*material));
  return ExitCode::done;
}

}  // namespace sprung
