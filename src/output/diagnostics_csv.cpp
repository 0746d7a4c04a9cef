#include "output/diagnostics_csv.h"

#include "base/format.h"

#include <array>

namespace sprung {
namespace {

struct Column {
  const char* name;
  std::string (*field)(const FrameDiagnostics& frame);
};

using Frame = FrameDiagnostics;

std::string name_of(PlanReason reason) {
  constexpr std::array kNames{"first", "excess", "deformation", "rotation", "infeasible", "solver_trial", "wake", "strain"};
  return kNames.at(static_cast<std::size_t>(reason));
}

const std::array<Column, 17> kColumns{{
    {"frame", [](const Frame& frame) { return std::to_string(frame.frame); }},
    {"time", [](const Frame& frame) { return format_number(frame.time); }},
    {"kinetic_energy", [](const Frame& frame) { return format_number(frame.kinetic_energy); }},
    {"elastic_energy", [](const Frame& frame) { return format_number(frame.elastic_energy); }},
    {"gravity_energy", [](const Frame& frame) { return format_number(frame.gravity_energy); }},
    {"max_stretch", [](const Frame& frame) { return format_number(frame.max_stretch); }},
    {"contacts", [](const Frame& frame) { return std::to_string(frame.contacts); }},
    {"min_distance", [](const Frame& frame) { return frame.min_distance ? format_number(*frame.min_distance) : std::string(); }},
    {"frame_ms", [](const Frame& frame) { return format_number(frame.frame_ms); }},
    {"stretch_excess", [](const Frame& frame) { return format_number(frame.stretch_excess); }},
    {"truncated", [](const Frame& frame) { return std::to_string(frame.truncated); }},
    {"infeasible", [](const Frame& frame) { return std::to_string(frame.infeasible); }},
    {"limit_solves", [](const Frame& frame) { return std::to_string(frame.limit_solves); }},
    {"substeps", [](const Frame& frame) { return std::to_string(frame.substeps); }},
    {"reason", [](const Frame& frame) { return name_of(frame.reason); }},
    {"contact_energy", [](const Frame& frame) { return format_number(frame.contact_energy); }},
    {"inverted_cells", [](const Frame& frame) { return std::to_string(frame.inverted_cells); }},
}};

template <class Field>
std::string line(Field&& field) {
  std::string text;
  for (const Column& column : kColumns) {
    if (!text.empty()) text += ',';
    text += field(column);
  }
  return text + '\n';
}

}  // namespace

std::string csv_head() {
  return line([](const Column& column) { return column.name; });
}

std::string csv_row(const FrameDiagnostics& frame) {
  return line([&](const Column& column) { return column.field(frame); });
}

}  // namespace sprung
