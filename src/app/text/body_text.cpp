#include "app/text/body_text.h"

#include "app/text/mesh_text.h"
#include "base/format.h"
#include "network/spring_pieces.h"
#include "network/stiffness_estimate.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

namespace sprung {
namespace {

constexpr int kDigits = 6;

/// Smallest and largest of a set of values.
struct Extremes {
  double smallest = std::numeric_limits<double>::infinity();
  double largest = -std::numeric_limits<double>::infinity();

  void add(double value) {
    smallest = std::min(smallest, value);
    largest = std::max(largest, value);
  }

  [[nodiscard]] std::string text(const char* unit) const {
    const std::string from = format_number(smallest, kDigits);
    const std::string to = format_number(largest, kDigits);
    return from == to ? fmt::format("{} {}", from, unit) : fmt::format("{} to {} {}", from, to, unit);
  }
};

struct SpringRanges {
  Index count = 0;
  Extremes stiffness;
  Extremes damping;
  Extremes rest_length;
};

std::array<SpringRanges, 3> kinds_of(const Springs& springs, const Body& body) {
  std::array<SpringRanges, 3> kinds;
  for (Index s = body.first_spring; s < body.first_spring + body.spring_count; ++s) {
    SpringRanges& kind = kinds[static_cast<std::size_t>(springs.kind[s])];
    ++kind.count;
    kind.stiffness.add(springs.stiffness[s]);
    kind.damping.add(springs.damping[s]);
    kind.rest_length.add(springs.rest_length[s]);
  }
  return kinds;
}

/// Range of the parameters of a body's angle bends.
struct AngleRanges {
  Extremes stiffness;
  Extremes damping;
  Extremes bond;
};

std::string angle_row(const AngleBends& bends, const Body& body) {
  AngleRanges angles;
  for (Index a = body.first_angle_bend; a < body.first_angle_bend + body.angle_bend_count; ++a) {
    angles.stiffness.add(bends.stiffness[a]);
    angles.damping.add(bends.damping[a]);
    angles.bond.add(bends.length_before[a]);
    angles.bond.add(bends.length_after[a]);
  }
  return text_row("bend", fmt::format("{}, k {}, damping {}, between segments of {}", counted(body.angle_bend_count, "angle"),
                                      angles.stiffness.text("N m"), angles.damping.text("N m s"), angles.bond.text("m")));
}

std::string face_bend_row(const SpringNetwork& network, const Body& body) {
  Extremes stiffness;
  Extremes damping;
  for (Index f = body.first_face_bend; f < body.first_face_bend + body.face_bend_count; ++f) {
    stiffness.add(network.face_bends.stiffness[f]);
    damping.add(network.face_bends.damping[f]);
  }
  return text_row("bend", fmt::format("{} by the angles to their neighbours, D {}, damping {}",
                                      counted(body.face_bend_count, "triangle"), stiffness.text("N m"), damping.text("N m s")));
}

std::string head_row(const SpringNetwork& network, const Body& body, const std::array<SpringRanges, 3>& kinds) {
  Index pinned = 0;
  for (Index i = body.first_particle; i < body.first_particle + body.particle_count; ++i) pinned += network.is_pinned(i) ? 1 : 0;
  const Box3 box = bounds(network.positions.middleCols(body.first_particle, body.particle_count));
  return text_row("body", fmt::format("{}: {} ({} pinned), {} ({} structural, {} shear, {} bend), {}", body.name,
                                      counted(body.particle_count, "particle"), pinned, counted(body.spring_count, "spring"),
                                      kinds[0].count, kinds[1].count, kinds[2].count, describe_size(box)));
}

std::string contact_row(const Body& body) {
  return text_row("contact", fmt::format("with {} that frames do not have, where edges of the mesh are longer than a cell",
                                         counted(body.contact_only, "vertex", "vertices")));
}

std::string mass_row(const SpringNetwork& network, const Body& body) {
  const auto masses = network.masses.segment(body.first_particle, body.particle_count);
  std::string text = format_number(masses.sum(), kDigits) + " kg";
  if (body.measure > 0.0) {
    constexpr std::array<const char*, 4> kUnits{"", "kg/m", "kg/m^2", "kg/m^3"};
    text += fmt::format(", {} {}", format_number(masses.sum() / body.measure, kDigits),
                        kUnits[static_cast<std::size_t>(body.dimension)]);
  }
  Extremes extremes;
  for (const double mass : masses) extremes.add(mass);
  return text_row("mass", text + ", " + extremes.text("kg") + " per particle");
}

std::string material_row(const ContactMaterial& contact, const std::string& name) {
  std::string text = name.empty() ? "" : name + ", ";
  text += "friction " + format_number(contact.friction, kDigits);
  if (contact.static_friction != contact.friction)
    text += fmt::format(" ({} static)", format_number(contact.static_friction, kDigits));
  text += fmt::format(", thickness {} m", format_number(contact.thickness, kDigits));
  if (contact.restitution > 0.0) text += ", restitution " + format_number(contact.restitution, kDigits);
  return text_row("material", text);
}

std::string spring_row(const char* name, const SpringRanges& kind) {
  return text_row(name, fmt::format("k_s {}, k_d {}, rest length {}", kind.stiffness.text("N/m"), kind.damping.text("N s/m"),
                                    kind.rest_length.text("m")));
}

/// Whether structural springs of the body yield or break: a stretch limit leaves these out.
bool any_fails(const Springs& springs, const Body& body) {
  for (Index s = body.first_spring; s < body.first_spring + body.spring_count; ++s) {
    const SpringLaw law = springs.law(s);
    if (springs.kind[s] == SpringKind::structural && (law.yields() || law.breaks())) return true;
  }
  return false;
}

}  // namespace

std::string body_rows(const SpringNetwork& network, const Body& body, const std::string& material) {
  const std::array<SpringRanges, 3> kinds = kinds_of(network.springs, body);
  std::string text = head_row(network, body, kinds) + mass_row(network, body) + material_row(body.material, material);
  for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
    if (kinds[kind].count > 0) text += spring_row(kSpringKindNames[kind], kinds[kind]);
  }
  if (body.angle_bend_count > 0) text += angle_row(network.angle_bends, body);
  if (body.face_bend_count > 0) text += face_bend_row(network, body);
  if (body.contact_only > 0) text += contact_row(body);
  const SpringPieces pieces = spring_pieces(network, body);
  if (const Index count = pieces.count + pieces.alone; count > 1)
    text += text_row("pieces", std::to_string(count) + " that no spring joins");
  return text;
}

std::string stiffness_rows(const Simulator& simulator, const Body& body) {
  constexpr int kEstimateDigits = 2;
  const double gravity = simulator.settings().gravity.norm();
  if (gravity == 0.0 || body.measure == 0.0 || body.particle_count < 2) return {};
  const StiffnessEstimate estimate = estimate_stiffness(simulator.network(), body, gravity);
  const auto number = [](double value) { return format_number(value, kEstimateDigits); };
  const auto& limit = simulator.settings().stretch_limit;
  const bool limited = limit && body.stretch_limited &&
                       std::ranges::find(limit->kinds, SpringKind::structural) != limit->kinds.end() &&
                       !any_fails(simulator.network().springs, body);
  const double most = limited ? limit->max_stretch * estimate.length : std::numeric_limits<double>::infinity();
  std::string sag = "nothing holds its length";
  if (estimate.sag > most) {
    sag = fmt::format("sinks by {} m under its weight, held by the stretch limit", number(most));
  } else if (std::isfinite(estimate.sag)) {
    sag = fmt::format("sinks by {} m under its weight", number(estimate.sag));
  }
  std::string periods = fmt::format("swings in {} s", number(estimate.swing_period));
  if (std::isfinite(estimate.stretch_period)) periods += fmt::format(", bounces in {} s", number(estimate.stretch_period));
  std::string text =
      text_row("stiffness", fmt::format("estimated, hung by one end, {} m long: {}, {}", number(estimate.length), sag, periods));
  if (estimate.overhang > 0.0)
    text += text_row("", fmt::format("an overhang of {} m droops by 41 degrees", number(estimate.overhang)));
  return text;
}

}  // namespace sprung
