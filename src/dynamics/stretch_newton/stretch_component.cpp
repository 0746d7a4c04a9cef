#include "dynamics/stretch_newton/stretch_component.h"

#include "dynamics/tethers/limited_springs.h"
#include "dynamics/tethers/spring_graph.h"

#include <algorithm>
#include <set>

namespace sprung {
namespace {

class Finder {
 public:
  Finder(const SpringNetwork& network, const std::vector<Index>& limited, std::span<const RodRow> rods)
      : network_(network),
        graph_(network, limited),
        rods_(rods),
        rods_at_(rods.empty() ? 0 : network.particle_count()),
        seen_(network.particle_count(), false),
        elastic_(seen_),
        point_(seen_.size(), kNone) {
    for (std::size_t r = 0; r < rods.size(); ++r) {
      for (const Index i : rods[r].ends()) rods_at_[i].push_back(r);
    }
    const Springs& springs = network.springs;
    for (Index s = 0; s < springs.count(); ++s) {
      if (springs.stiffness[s] == 0.0) continue;
      for (const Index i : {springs.first[s], springs.second[s]}) elastic_[i] = true;
    }
    const AngleBends& bends = network.angle_bends;
    for (Index e = 0; e < bends.count(); ++e) {
      if (bends.stiffness[e] == 0.0) continue;
      for (const Index i : {bends.before[e], bends.middle[e], bends.after[e]}) elastic_[i] = true;
    }
    const FaceBends& faces = network.face_bends;
    for (Index f = 0; f < faces.count(); ++f) {
      if (faces.stiffness[f] == 0.0) continue;
      for (const Index i : stencil_of(faces, network.hinges, f).particles) elastic_[i] = true;
    }
  }

  std::vector<StretchComponent> all() {
    std::vector<StretchComponent> found;
    for (Index i = 0; i < network_.particle_count(); ++i) {
      if (seen_[i] || network_.is_fixed(i)) continue;
      const std::vector<Index> particles = outward_from(i);
      if (std::ranges::none_of(particles, [&](Index p) { return !graph_.at(p).empty(); })) continue;
      found.push_back(component(particles));
    }
    return found;
  }

 private:
  /// Free particles reachable from one, nearest first.
  std::vector<Index> outward_from(Index start) {
    std::vector<Index> queue{start};
    seen_[start] = true;
    const auto add = [&](Index particle) {
      if (seen_[particle] || network_.is_fixed(particle)) return;
      seen_[particle] = true;
      queue.push_back(particle);
    };
    for (std::size_t head = 0; head < queue.size(); ++head) {
      for (const SpringGraph::Edge& edge : graph_.at(queue[head])) add(edge.to);
      for (const std::size_t r : rods_at(queue[head])) std::ranges::for_each(rods_[r].ends(), add);
    }
    return queue;
  }

  [[nodiscard]] std::span<const std::size_t> rods_at(Index particle) const {
    return rods_.empty() ? std::span<const std::size_t>() : rods_at_[particle];
  }

  [[nodiscard]] bool hangs_on_pin(Index particle) const {
    return std::ranges::any_of(graph_.at(particle), [&](const SpringGraph::Edge& edge) { return network_.is_fixed(edge.to); });
  }

  /// The same particles, from the leaves to one that is linked to a pin.
  std::vector<Index> inward(const std::vector<Index>& particles) {
    const auto root = std::ranges::find_if(particles, [&](Index i) { return hangs_on_pin(i); });
    for (const Index i : particles) seen_[i] = false;
    std::vector<Index> order = outward_from(root == particles.end() ? particles.front() : *root);
    std::ranges::reverse(order);
    return order;
  }

  StretchComponent component(const std::vector<Index>& particles) {
    StretchComponent found;
    found.points = inward(particles);
    found.free_count = static_cast<Index>(found.points.size());
    for (Index i = 0; i < found.free_count; ++i) {
      point_[found.points[i]] = i;
      found.masses.push_back(network_.masses[found.points[i]]);
    }
    found.is_elastic = std::ranges::any_of(particles, [&](Index i) { return elastic_[i]; });
    found.is_tree = true;
    for (Index i = 0; i < found.free_count; ++i) add_links(found, i);
    add_rods(found);
    // A pin may belong to several components.
    for (const Index particle : found.points) point_[particle] = kNone;
    return found;
  }

  void add_links(StretchComponent& component, Index i) {
    Index parent = kNone;
    for (const auto& [spring, other] : graph_.at(component.points[i])) {
      const Index second = point_of(other, component);
      if (second < i) continue;
      component.links.push_back({i, second, network_.springs.rest_length[spring], spring});
      if (!component.is_free(second)) continue;
      component.is_tree = component.is_tree && (parent == kNone || parent == second);
      parent = second;
    }
    component.begin.push_back(static_cast<Index>(component.links.size()));
  }

  void add_rods(StretchComponent& component) {
    std::set<std::size_t> numbers;
    for (Index i = 0; i < component.free_count; ++i) {
      const std::span<const std::size_t> at = rods_at(component.points[i]);
      numbers.insert(at.begin(), at.end());
    }
    if (numbers.empty()) return;
    component.is_tree = false;
    for (const std::size_t r : numbers) {
      StretchComponent::Rod rod{.number = r, .points = {}, .count = rods_[r].count};
      for (std::size_t k = 0; k < rod.count; ++k) rod.points[k] = point_of(rods_[r].particles[k], component);
      component.rods.push_back(rod);
    }
    std::set<const Body*> bodies;
    for (Index i = 0; i < component.free_count; ++i) bodies.insert(&network_.body_of(component.points[i]));
    for (const Body* body : bodies)
      component.carried_mass += network_.masses.segment(body->first_particle, body->particle_count).sum();
  }

  Index point_of(Index particle, StretchComponent& component) {
    if (point_[particle] == kNone) {
      point_[particle] = static_cast<Index>(component.points.size());
      component.points.push_back(particle);
    }
    return point_[particle];
  }

  const SpringNetwork& network_;
  SpringGraph graph_;
  std::span<const RodRow> rods_;
  std::vector<std::vector<std::size_t>> rods_at_;  ///< by particle; empty without rods
  std::vector<bool> seen_;
  std::vector<bool> elastic_;
  std::vector<Index> point_;
};

}  // namespace

std::vector<StretchComponent> stretch_components(const SpringNetwork& network, const std::vector<SpringKind>& kinds) {
  return stretch_components(network, limited_springs(network, kinds), {});
}

std::vector<StretchComponent> stretch_components(const SpringNetwork& network, const std::vector<Index>& springs,
                                                 std::span<const RodRow> rods) {
  return Finder(network, springs, rods).all();
}

}  // namespace sprung
