#include "dynamics/tethers/lra_paths.h"

#include "dynamics/tethers/limited_springs.h"
#include "dynamics/tethers/spring_graph.h"

#include <algorithm>
#include <map>
#include <queue>
#include <tuple>
#include <utility>

namespace sprung {
namespace {

/// The group of each pinned particle; kNone for free ones.
std::vector<Index> pin_groups(const SpringNetwork& network, const SpringGraph& graph) {
  std::vector<Index> groups(network.particle_count(), kNone);
  Index count = 0;
  for (Index i = 0; i < network.particle_count(); ++i) {
    if (!network.is_fixed(i) || groups[i] != kNone) continue;
    std::vector<Index> reached{i};
    groups[i] = count;
    while (!reached.empty()) {
      const Index pin = reached.back();
      reached.pop_back();
      for (const SpringGraph::Edge& edge : graph.at(pin)) {
        if (!network.is_fixed(edge.to) || groups[edge.to] != kNone) continue;
        groups[edge.to] = count;
        reached.push_back(edge.to);
      }
    }
    ++count;
  }
  return groups;
}

bool is_longer(const Tether& a, const Tether& b) {
  return std::tie(a.length, a.pin, a.particle) > std::tie(b.length, b.pin, b.particle);
}

/// The tethers of each particle, nearest first.
class Search {
 public:
  Search(const SpringNetwork& network, const SpringGraph& graph)
      : network_(network), graph_(graph), found_(network.particle_count()) {
    const std::vector<Index> groups = pin_groups(network, graph);
    for (Index i = 0; i < network.particle_count(); ++i) {
      if (network.is_fixed(i)) extend({i, i, groups[i], 0.0});
    }
  }

  std::vector<Tether> all() {
    for (; !ahead_.empty();) {
      const Tether nearest = ahead_.top();
      ahead_.pop();
      if (!is_wanted(nearest)) continue;
      found_[nearest.particle].push_back(nearest);
      extend(nearest);
    }
    std::vector<Tether> tethers;
    for (const auto& of_particle : found_) tethers.insert(tethers.end(), of_particle.begin(), of_particle.end());
    return tethers;
  }

 private:
  void extend(const Tether& tether) {
    for (const SpringGraph::Edge& edge : graph_.at(tether.particle)) {
      const Tether next{edge.to, tether.pin, tether.group, tether.length + network_.springs.rest_length[edge.spring]};
      if (!network_.is_fixed(edge.to) && is_wanted(next)) ahead_.push(next);
    }
  }

  [[nodiscard]] bool is_wanted(const Tether& tether) const {
    const std::vector<Tether>& nearer = found_[tether.particle];
    return nearer.size() < kMostTethers && std::ranges::find(nearer, tether.group, &Tether::group) == nearer.end();
  }

  const SpringNetwork& network_;
  const SpringGraph& graph_;
  std::vector<std::vector<Tether>> found_;
  std::priority_queue<Tether, std::vector<Tether>, decltype(&is_longer)> ahead_{&is_longer};
};

}  // namespace

std::vector<Tether> find_tethers(const SpringNetwork& network, const std::vector<SpringKind>& kinds) {
  const std::vector<Index>& pin_of = network.activity.pin_of;
  if (std::ranges::count(pin_of, kNone) == static_cast<std::ptrdiff_t>(pin_of.size())) return {};
  const SpringGraph graph(network, measurable_springs(network, kinds));
  std::vector<Tether> tethers = Search(network, graph).all();
  std::ranges::sort(tethers, {}, [](const Tether& tether) { return std::pair(tether.particle, tether.group); });
  return tethers;
}

bool are_pins_taut(const SpringNetwork& network, const Body& body, const std::vector<Tether>& tethers, double max_stretch) {
  constexpr double kRounding = 1.0 + 1.0e-9;  // covers the rounding of sums of lengths
  const auto is_of_body = [&](Index i) { return i >= body.first_particle && i < body.first_particle + body.particle_count; };
  // A pin that began after time 0 may be anywhere.
  for (std::size_t p = 0; p < network.pins.size(); ++p) {
    const bool leaves_place = network.pins[p].moves() || network.pins[p].from > 0.0;
    if (leaves_place && std::ranges::any_of(held_particles(network, p), is_of_body)) return false;
  }

  const auto path_length = [](const Tether& a, const Tether& b) { return a.length + b.length; };
  std::map<std::pair<Index, Index>, std::pair<Tether, Tether>> shortest;
  for (std::size_t a = 0; a < tethers.size(); ++a) {
    if (!is_of_body(tethers[a].particle)) continue;
    for (std::size_t b = a + 1; b < tethers.size() && tethers[b].particle == tethers[a].particle; ++b) {
      const std::pair between(tethers[a], tethers[b]);
      const auto [kept, added] = shortest.try_emplace({tethers[a].group, tethers[b].group}, between);
      auto& nearest = kept->second;
      if (path_length(tethers[a], tethers[b]) < path_length(nearest.first, nearest.second)) nearest = between;
    }
  }
  const auto is_taut = [&](const auto& edge) {
    const auto& [a, b] = edge.second;
    const double straight = (network.positions.col(a.pin) - network.positions.col(b.pin)).norm();
    return (1.0 + max_stretch) * path_length(a, b) <= kRounding * straight;
  };
  return !shortest.empty() && std::ranges::all_of(shortest, is_taut);
}

PinStretch largest_pin_stretch(const std::vector<Tether>& tethers, const Points& positions) {
  PinStretch largest;
  for (std::size_t a = 0; a < tethers.size(); ++a) {
    for (std::size_t b = a + 1; b < tethers.size() && tethers[b].particle == tethers[a].particle; ++b) {
      const double length = tethers[a].length + tethers[b].length;
      const double distance = (positions.col(tethers[a].pin) - positions.col(tethers[b].pin)).norm();
      const double stretch = distance / length - 1.0;
      if (largest.first == kNone || stretch > largest.stretch) largest = {tethers[a].pin, tethers[b].pin, length, stretch};
    }
  }
  return largest;
}

}  // namespace sprung
