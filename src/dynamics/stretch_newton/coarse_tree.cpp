#include "dynamics/stretch_newton/coarse_tree.h"

#include <algorithm>
#include <cmath>

namespace sprung {
namespace {

constexpr Index kForked = -2;

/// By point: the one child of a point, kNone of an end, kForked of others.
std::vector<Index> children(const StretchComponent& tree) {
  std::vector<Index> child(tree.points.size(), kNone);
  for (const StretchComponent::Link& link : tree.links) child[link.second] = child[link.second] == kNone ? link.first : kForked;
  return child;
}

/// The one link of a point to a free point, if it has no other.
const StretchComponent::Link* only_link(const StretchComponent& tree, Index point) {
  if (tree.begin[point + 1] - tree.begin[point] != 1) return nullptr;
  const StretchComponent::Link& link = tree.links[tree.begin[point]];
  return tree.is_free(link.second) ? &link : nullptr;
}

/// The point of the intersection of two balls that is nearest to a point; between balls that do not meet, the point of the line
/// through their centres that divides it as the radii do.
Vector3 nearest_in_both(const Vector3& to, const std::array<Vector3, 2>& centres, const std::array<double, 2>& radii) {
  const auto is_in = [&](const Vector3& point, std::size_t k) { return (point - centres[k]).squaredNorm() <= radii[k] * radii[k]; };
  const auto onto = [&](std::size_t k) { return Vector3(centres[k] + radii[k] * (to - centres[k]).normalized()); };
  const std::array<bool, 2> in = {is_in(to, 0), is_in(to, 1)};
  if (in[0] && in[1]) return to;
  for (const std::size_t k : {0U, 1U}) {
    if (in[k]) continue;
    if (const Vector3 on = onto(k); is_in(on, 1 - k)) return on;
  }
  const Vector3 axis = centres[1] - centres[0];
  const double distance = axis.norm();
  if (distance == 0.0) return centres[0];
  const double sum = radii[0] + radii[1];
  const double along = distance >= sum ? distance * radii[0] / sum : 0.5 * (distance + (radii[0] - radii[1]) * sum / distance);
  const Vector3 middle = centres[0] + along / distance * axis;
  const double across = std::sqrt(std::max(0.0, radii[0] * radii[0] - along * along));
  const Vector3 away = to - middle;
  const Vector3 outwards = away - away.dot(axis) / (distance * distance) * axis;
  if (distance >= sum || outwards.squaredNorm() == 0.0) return middle;
  return middle + across * outwards.normalized();
}

}  // namespace

void CoarseTree::place_others(const Points& target, double max_stretch, Points& x) const {
  for (const Between& b : between) {
    const std::array<double, 2> longest = {(1.0 + max_stretch) * b.lengths[0], (1.0 + max_stretch) * b.lengths[1]};
    x.col(b.point) = nearest_in_both(target.col(b.point), {x.col(b.ends[0]), x.col(b.ends[1])}, longest);
  }
}

CoarseTree coarsen(const StretchComponent& tree) {
  const std::vector<Index> child = children(tree);
  std::vector<bool> stays(tree.points.size(), true);
  std::vector<double> masses = tree.masses;
  CoarseTree coarse;
  for (Index i = tree.free_count - 1; i >= 0; --i) {
    const StretchComponent::Link* up = only_link(tree, i);
    if (up == nullptr || !stays[up->second] || child[i] < 0) continue;
    const StretchComponent::Link* down = only_link(tree, child[i]);
    if (down == nullptr) continue;
    stays[i] = false;
    coarse.between.push_back({i, {child[i], up->second}, {down->rest_length, up->rest_length}});
    const double to_parent = down->rest_length / (down->rest_length + up->rest_length);
    masses[up->second] += to_parent * tree.masses[i];
    masses[child[i]] += (1.0 - to_parent) * tree.masses[i];
  }

  StretchComponent& component = coarse.component;
  component.is_tree = true;
  component.is_elastic = tree.is_elastic;
  std::vector<Index> number(tree.points.size(), kNone);
  for (Index i = 0; i < static_cast<Index>(tree.points.size()); ++i) {
    if (!stays[i]) continue;
    number[i] = static_cast<Index>(component.points.size());
    component.points.push_back(i);
    if (tree.is_free(i)) component.masses.push_back(masses[i]);
  }
  component.free_count = static_cast<Index>(component.masses.size());
  for (Index i = 0; i < component.free_count; ++i) {
    const Index fine = component.points[i];
    for (Index k = tree.begin[fine]; k < tree.begin[fine + 1]; ++k) {
      StretchComponent::Link link = tree.links[k];
      double length = link.rest_length;
      if (!stays[link.second]) {
        link = *only_link(tree, link.second);
        length += link.rest_length;
      }
      component.links.push_back({.first = i, .second = number[link.second], .rest_length = length, .spring = kNone});
    }
    component.begin.push_back(static_cast<Index>(component.links.size()));
  }
  return coarse;
}

}  // namespace sprung
