#include "scene/materials/materials.h"

#include "base/format.h"

#include <algorithm>

namespace sprung {
namespace {

using Row = std::vector<std::string>;

constexpr int kDigits = 4;

struct Column {
  const char* title;
  const char* key;
};
constexpr Column kColumns[] = {{"diameter", "diameter"},
                               {"density", "density"},
                               {"structural", "springs.structural.modulus"},
                               {"shear", "springs.shear.modulus"},
                               {"bend", "springs.bend.modulus"},
                               {"thickness", "thickness"},
                               {"friction", "friction"}};

bool is_replaced(const MaterialValue& value) { return value.source.starts_with("chosen: replaces"); }

std::string title_of(const Column& column, const MaterialValue& value) {
  return value.unit == "1" ? column.title : column.title + (" [" + value.unit + "]");
}

std::vector<Row> rows_of(MaterialKind kind) {
  std::vector<Row> rows;
  for (const Material& material : materials()) {
    if (material.kind != kind) continue;
    Row title{std::string(material_kind_name(kind))};
    Row row{material.name};
    for (const Column& column : kColumns) {
      const MaterialValue* const value = material.find(column.key);
      if (value == nullptr) continue;
      title.push_back(title_of(column, *value));
      row.push_back(format_number(value->value, kDigits) + (is_replaced(*value) ? " *" : ""));
    }
    if (rows.empty()) rows.push_back(title);
    rows.push_back(row);
  }
  return rows;
}

/// The rows in columns that are as wide as their longest entry.
std::string aligned(const std::vector<Row>& rows) {
  std::vector<std::size_t> widths(rows.front().size(), 0);
  for (const Row& row : rows) {
    for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], row[c].size());
  }
  std::string text;
  for (const Row& row : rows) {
    std::string line;
    for (std::size_t c = 0; c < row.size(); ++c) {
      line += row[c];
      if (c + 1 < row.size()) line.append(widths[c] + 2 - row[c].size(), ' ');
    }
    text += line + "\n";
  }
  return text;
}

}  // namespace

std::string_view material_kind_name(MaterialKind kind) {
  constexpr std::string_view kNames[] = {"cloth", "rope", "solid"};
  return kNames[static_cast<std::size_t>(kind)];
}

const MaterialValue* Material::find(std::string_view key) const {
  const auto found = std::ranges::find(values, key, &MaterialValue::key);
  return found == values.end() ? nullptr : &*found;
}

const Material* find_material(std::string_view name) {
  const auto found = std::ranges::find(materials(), name, &Material::name);
  return found == materials().end() ? nullptr : &*found;
}

std::vector<std::string> material_names(const std::vector<MaterialKind>& kinds) {
  std::vector<std::string> names;
  for (const Material& material : materials()) {
    if (std::ranges::find(kinds, material.kind) != kinds.end()) names.push_back(material.name);
  }
  return names;
}

std::string materials_overview(MaterialKind kind) { return aligned(rows_of(kind)) + "\n" + stretch_limit_rule(); }

std::string materials_overview() {
  std::string text;
  for (const MaterialKind kind : {MaterialKind::cloth, MaterialKind::rope, MaterialKind::solid})
    text += aligned(rows_of(kind)) + "\n";
  return text + stretch_limit_rule();
}

std::string material_description(const Material& material) {
  std::string text = material.name + ": " + material.what + "; for a " + std::string(material_kind_name(material.kind)) + "\n";
  for (const MaterialValue& value : material.values) {
    text += value.key + " = " + format_number(value.value, kDigits) + (value.unit == "1" ? "" : " " + value.unit);
    if (is_replaced(value)) text += " *";
    if (value.power == 1) text += ", in proportion to the diameter";
    if (value.power > 1) text += ", in proportion to the diameter to the power of " + std::to_string(value.power);
    text += "\n    " + value.source + "\n";
  }
  if (material.preserves_volume) {
    text += "volume.preserve = true\n    chosen: gels are water, which keeps its volume\n";
  }
  if (std::ranges::any_of(material.values, is_replaced)) text += stretch_limit_rule();
  return text;
}

}  // namespace sprung
