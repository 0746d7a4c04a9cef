// The presets of "material": values of bodies, each with its unit and its source. They live in scene, because a preset is a set of
// scene keys that the rules read like keys that a user wrote.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace sprung {

enum class MaterialKind : std::uint8_t { cloth, rope, solid };

/// "cloth", "rope" or "solid".
[[nodiscard]] std::string_view material_kind_name(MaterialKind kind);

/// The value of one scene key.
struct MaterialValue {
  std::string key;     ///< path within the body: `springs.shear.modulus`
  double value = 0.0;  ///< of a rope: at the default diameter
  std::string unit;    ///< "1" for numbers without a unit
  std::string source;  ///< begins with "published" or "chosen"; says where, or why
  int power = 0;       ///< of a rope: the value is proportional to this power of the diameter
};

struct Material {
  std::string name;
  MaterialKind kind = MaterialKind::cloth;
  std::string what;                   ///< the thing that was measured, in a few words
  std::vector<MaterialValue> values;  ///< of a rope, the first one is `diameter` [m]
  /// Whether a stretch limit stands in for a stiffness that would need steps beyond reason.
  bool stretch_limited = false;
  bool preserves_volume = false;  ///< the default of `volume.preserve`

  /// The entry of a key; null if there is none.
  [[nodiscard]] const MaterialValue* find(std::string_view key) const;
};

/// The `damping_time` [s] of structural and shear springs in cloths and ropes with springs that may break. It replaces that of the
/// preset, which lets a torn body recoil so long that it tears again.
inline constexpr double kTearingDampingTime = 1.1e-3;

/// All presets: cloths, then ropes, then solids.
[[nodiscard]] const std::vector<Material>& materials();

/// Null if there is none of this name.
[[nodiscard]] const Material* find_material(std::string_view name);

/// The names of the presets of some kinds.
[[nodiscard]] std::vector<std::string> material_names(const std::vector<MaterialKind>& kinds);

/// Why a stretch limit stands in for the stiffness of some presets; a sentence a line.
[[nodiscard]] std::string stretch_limit_rule();

/// The presets of one kind in aligned columns, with their default values.
[[nodiscard]] std::string materials_overview(MaterialKind kind);

/// A table of all presets in aligned columns: the output of `sprung materials`, and a part of examples/README.md.
[[nodiscard]] std::string materials_overview();

/// All values of a preset, each with its unit and source.
[[nodiscard]] std::string material_description(const Material& material);

}  // namespace sprung
