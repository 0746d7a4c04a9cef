#include "app/command_line.h"
#include "app/commands.h"
#include "app/console.h"
#include "scene/json/nearest_name.h"
#include "scene/materials/materials.h"

#include <fmt/format.h>

#include <array>
#include <optional>
#include <vector>

namespace sprung {
namespace {

constexpr std::array kKinds{MaterialKind::cloth, MaterialKind::rope, MaterialKind::solid};

/// The kind that is named, as "rope" or "ropes".
std::optional<MaterialKind> kind_of(const std::string& name) {
  for (const MaterialKind kind : kKinds) {
    const std::string kind_name(material_kind_name(kind));
    if (name == kind_name || name == kind_name + "s") return kind;
  }
  return std::nullopt;
}

}  // namespace

ExitCode print_materials(const MaterialsOptions& options) {
  if (options.name.empty()) {
    print_result(materials_overview());
    return ExitCode::done;
  }
  if (const auto kind = kind_of(options.name)) {
    print_result(materials_overview(*kind));
    return ExitCode::done;
  }
  const Material* const material = find_material(options.name);
  if (material == nullptr) {
    const auto names = material_names({kKinds.begin(), kKinds.end()});
    throw UsageError(fmt::format("there is no material {}; {}", options.name, suggestion(options.name, names)));
  }
  print_result(material_description(*material));
  return ExitCode::done;
}

}  // namespace sprung
