#include "simulation/settings/settings_check.h"

#include "base/format.h"
#include "base/grouped_warnings.h"
#include "base/problem_list.h"
#include "network/model/spring_network.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <utility>

namespace sprung {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

void require_between(const std::string& key, double value, double least, double most, ProblemList& problems) {
  if (std::isfinite(value) && value >= least && value <= most) return;
  problems.add(key, format_number(value),
               most == kInfinity ? "must be a finite number, at least " + format_number(least)
                                 : "must be from " + format_number(least) + " to " + format_number(most),
               "");
}

void require_finite(const std::string& key, const Vector3& value, ProblemList& problems) {
  if (!value.allFinite()) problems.add(key, "", "must have three finite components", "");
}

}  // namespace

void check_wind(const Wind& wind, ProblemList& problems) {
  const std::vector<WindKeyframe>& keys = wind.keyframes();
  for (std::size_t k = 0; k < keys.size(); ++k) {
    const std::string key = keys.size() == 1 ? "wind" : entry_key("wind.keyframes", k);
    require_finite(key, keys[k].velocity, problems);
    if (k == 0 || keys[k].time > keys[k - 1].time) continue;
    problems.add(key + ".time", format_number(keys[k].time), "must be later than the keyframe before it", "");
  }
  if (!wind.gusts()) return;
  require_between("wind.gusts.speed", wind.gusts()->speed, 0.0, kInfinity, problems);
  require_between("wind.gusts.length", wind.gusts()->length, std::numeric_limits<double>::min(), kInfinity, problems);
}

SimulatorSettings checked_settings(SimulatorSettings settings) {
  ProblemList problems;
  const auto require_within = [&](const std::string& key, double value, double least, double most) {
    require_between(key, value, least, most, problems);
  };
  require_finite("gravity", settings.gravity, problems);
  require_within("air_drag", settings.air_drag, 0.0, kInfinity);
  require_within("air_surface.normal", settings.air_surface.normal, 0.0, kInfinity);
  require_within("air_surface.tangential", settings.air_surface.tangential, 0.0, kInfinity);
  check_wind(settings.wind, problems);
  if (const auto* verlet = std::get_if<VerletSettings>(&settings.integrator)) {
    require_within("integrator.damping", verlet->damping, 0.0, 1.0);
    require_within("integrator.damping_rate", verlet->damping_rate, 0.0, kInfinity);
  }
  if (const auto& limit = settings.stretch_limit) {
    require_within("stretch_limit.max_stretch", limit->max_stretch, 0.0, kInfinity);
    require_within("stretch_limit.max_compression", limit->max_compression, 0.0, 1.0);
    require_within("stretch_limit.iterations", limit->iterations, 1.0, kInfinity);
    require_within("stretch_limit.tolerance", limit->tolerance, 0.0, kInfinity);
  }
  require_within("steps_per_frame", settings.steps_per_frame, 1.0, kInfinity);
  require_within("max_substeps", settings.max_substeps, 1.0, kMaxSubsteps);
  require_within("inner_substeps", settings.inner_substeps, 1.0, kMaxInnerSubsteps);
  if (settings.inner_substeps > 1 && !may_have_inner_substeps(settings)) {
    problems.add("inner_substeps", std::to_string(settings.inner_substeps),
                 "must be 1 with penalty contact and with implicit Euler", "leave it out");
  }
  require_within("contact.stiffness", settings.contact.stiffness, 0.0, kInfinity);
  require_within("contact.damping", settings.contact.damping, 0.0, kInfinity);
  problems.throw_if_any();
  return settings;
}

bool may_have_inner_substeps(const SimulatorSettings& settings) {
  return settings.contact.response == ContactSettings::Response::projection &&
         !std::holds_alternative<ImplicitEulerSettings>(settings.integrator);
}

std::vector<std::string> weak_springs(const SimulatorSettings& settings, const SpringNetwork& network) {
  const AngleBends& bends = network.angle_bends;
  if (bends.count() == 0 || (settings.stretch_limit && settings.stretch_limit->max_compression <= 0.5)) return {};
  const auto bond = [](Index a, Index b) { return std::minmax({a, b}); };
  std::map<std::pair<Index, Index>, double> stiffness;
  const Springs& springs = network.springs;
  for (std::size_t s = 0; s < springs.first.size(); ++s)
    stiffness[bond(springs.first[s], springs.second[s])] += springs.stiffness[s];
  std::map<std::string, double> needed;  // by body [N/m]
  for (std::size_t b = 0; b < bends.middle.size(); ++b) {
    for (const auto& [end, length] :
         {std::pair(bends.before[b], bends.length_before[b]), {bends.after[b], bends.length_after[b]}}) {
      const auto found = stiffness.find(bond(end, bends.middle[b]));
      const double least = std::numbers::pi * bends.stiffness[b] / (length * length);
      if (found == stiffness.end() || found->second >= least) continue;
      double& most = needed[network.body_of(bends.middle[b]).name];
      most = std::max(most, least);
    }
  }
  GroupedWarnings warnings("body", "bodies");
  for (const auto& [body, least] : needed) {
    warnings.add(
        body,
        "the springs are too weak for the angle bends. A bend shortens them, and its force grows as they shorten, so the body "
        "is likely to gain energy. Use a structural stiffness of at least " +
            format_lower_bound(least, 3) + " N/m, less bend stiffness, or \"stretch_limit\": {\"max_compression\": 0}.");
  }
  return warnings.lines();
}

std::vector<std::string> unlikely_lengths(const SpringNetwork& network, const std::vector<Link>& links) {
  constexpr double kLikely = 100.0;
  std::vector<std::string> warnings;
  std::size_t next = 0;  // attachment, of which one line is enough
  for (const Link& link : links) {
    if (link.attachment < next || link.length <= kLikely * link.distance) continue;
    next = link.attachment + 1;
    warnings.push_back(network.attachments[link.attachment].name + ": rest_length = " + format_number(link.length, 6) +
                       " is more than 100 times the distance of " + format_number(link.distance, 6) +
                       " m at which its ends are now. Give it in metres, or leave it out to keep the distance.");
  }
  return warnings;
}

}  // namespace sprung
