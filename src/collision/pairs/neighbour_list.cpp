#include "collision/pairs/neighbour_list.h"

#include "base/parallel.h"
#include "collision/core/block_bounds.h"
#include "collision/element_bvh/vertex_bounds.h"

#include <algorithm>
#include <cmath>

namespace sprung {
namespace {

// Radius of a sphere, as a fraction of the shortest edge at its particle. Larger spheres last longer, but those of neighbours come
// too close to each other.
constexpr double kRadius = 0.1;

// If edge lengths differ very much, the shortest edge counts as at least this fraction of the mean.
constexpr double kShortestEdge = 0.25;

// A longer horizon renews the list less often, but lists more pairs. The total cost is smallest at about this factor times the
// square root of the number of steps in which particles move an edge's length relative to their body.
constexpr double kHorizonFactor = 1.1;
constexpr double kMaxHorizon = 64.0;

// The list is renewed early if its remaining steps exceed a new horizon by this factor. Otherwise a body that falls and then hits
// something would be searched along its former path. A drape costs 5 % more with 2; with 1, steadily growing motion could renew the
// list in every step.
constexpr double kMuchLonger = 1.5;

constexpr Index kParticlesPerTask = 1024;
constexpr Index kFansPerTask = 128;
constexpr Index kLeafPairsPerTask = 32;

std::vector<double> sphere_radii(const CollisionSurface& surface, const Points& rest) {
  const double largest = *std::max_element(surface.element_size.begin(), surface.element_size.end());
  std::vector<double> radii(static_cast<std::size_t>(rest.cols()), kRadius * largest);
  for (const Element& element : surface.elements) {
    const auto corners = corners_of(element);
    const double mean = surface.element_size[static_cast<std::size_t>(element.body)];
    for (std::size_t k = 0; k < corners.size() && corners.size() > 1; ++k) {
      const Index other = corners[(k + 1) % corners.size()];
      const double edge = (rest.col(other) - rest.col(corners[k])).norm();
      for (const Index i : {corners[k], other}) {
        double& radius = radii[static_cast<std::size_t>(i)];
        radius = std::min(radius, kRadius * std::clamp(edge, kShortestEdge * mean, mean));
      }
    }
  }
  return radii;
}

}  // namespace

NeighbourList::NeighbourList(const CollisionSurface& surface, const Points& rest, double margin)
    : surface_(surface),
      rest_(rest),
      topology_(surface.elements, static_cast<Index>(rest.cols())),
      feature_edges_(surface, topology_),
      tree_(surface, rest),
      corners_(static_cast<std::size_t>(tree_.leaf_count())),
      spheres_(sphere_radii(surface, rest)),
      pair_builder_(surface, topology_),
      proximity_search_(surface, topology_, feature_edges_, tree_, rest_, margin),
      flat_(static_cast<std::size_t>(rest.cols()), 0),
      marked_(static_cast<std::size_t>(rest.cols()), 0),
      is_marked_element_(surface.elements.size(), 0),
      visited_(marked_) {
  std::vector<char> watched(marked_.size(), 0);
  for (const Element& element : surface.elements) {
    const auto body = static_cast<std::size_t>(element.body);
    if (surface.self[body] == 0 && surface.others[body] == 0) continue;
    for (const Index i : corners_of(element)) watched[static_cast<std::size_t>(i)] = 1;
  }
  for (std::size_t i = 0; i < watched.size(); ++i) {
    if (watched[i] == 0) continue;
    watched_.push_back(static_cast<Index>(i));
    const Index element = topology_.elements_at(static_cast<Index>(i)).front();
    watched_bodies_.push_back(surface.elements[static_cast<std::size_t>(element)].body);
  }
}

void NeighbourList::begin_step(const Points& before, const Points& after) {
  age_ += 1.0;
  spheres_.advance();
  const double best = best_horizon(before, after);
  if (age_ >= horizon_ || horizon_ - age_ > kMuchLonger * best) {
    horizon_ = best;
    age_ = 0.0;
    feature_edges_.update(before);
    renew(watched_, before, after);
  } else {
    std::vector<Index> leaving = find_leaving(before, 0.0);
    const std::vector<Index> later = find_leaving(after, 1.0);
    leaving.insert(leaving.end(), later.begin(), later.end());
    renew(leaving, before, after);
  }
  find_candidates();
}

void NeighbourList::begin_substep(const Points& before, const Points& after) {
  age_ = 0.0;
  horizon_ = 1.0;
  renew(watched_, before, after);
}

void NeighbourList::follow(const Points& before, const Points& ends) { renew(find_leaving(ends, 1.0), before, ends); }

std::vector<Index> NeighbourList::find_leaving(const Points& ends, double time) const {
  const auto count = static_cast<Index>(watched_.size());
  return collect_from_chunks<Index>(count, kParticlesPerTask, [&](Index begin, Index end, std::vector<Index>& leaving) {
    for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k) {
      if (!spheres_.contains(watched_[k], ends.col(watched_[k]), time)) leaving.push_back(watched_[k]);
    }
  });
}

/// The number of steps for which a list made now costs least.
double NeighbourList::best_horizon(const Points& before, const Points& after) const {
  struct Flight {
    Vector3 sum = Vector3::Zero();
    double squares = 0.0;
    double count = 0.0;
  };
  std::vector<Flight> flights(surface_.self.size());
  for (std::size_t k = 0; k < watched_.size(); ++k) {
    const Vector3 motion = after.col(watched_[k]) - before.col(watched_[k]);
    if (!motion.allFinite()) continue;
    Flight& flight = flights[static_cast<std::size_t>(watched_bodies_[k])];
    flight.sum += motion;
    flight.squares += motion.squaredNorm();
    flight.count += 1.0;
  }
  double steps = kMaxHorizon;
  for (std::size_t body = 0; body < flights.size(); ++body) {
    const Flight& flight = flights[body];
    if (flight.count == 0.0 || surface_.element_size[body] == 0.0) continue;
    const double variance = flight.squares / flight.count - (flight.sum / flight.count).squaredNorm();
    const double speed = std::sqrt(std::max(variance, 0.0));
    if (speed > 0.0) steps = std::min(steps, std::floor(kHorizonFactor * std::sqrt(surface_.element_size[body] / speed)));
  }
  return std::max(steps, 1.0);
}

void NeighbourList::renew(const std::vector<Index>& leaving, const Points& before, const Points& ends) {
  if (leaving.empty()) return;
  reset_spheres(leaving, before, ends);
  test_fans();
  mark_elements();
  tree_.bound(spheres_, flat_, marked_elements_, {age_, horizon_});
  std::erase_if(pairs_, [&](const ContactStencil& pair) { return has_marked(pair); });
  find_pairs(before);
  renewed_.insert(renewed_.end(), marked_list_.begin(), marked_list_.end());
  clear_marks();
}

void NeighbourList::find_candidates() {
  if (renewed_.empty()) return;
  for (const Index i : renewed_) marked_[static_cast<std::size_t>(i)] = 1;
  marked_list_.swap(renewed_);
  mark_elements();
  tree_.mark(marked_elements_);
  std::erase_if(candidates_, [&](const ContactCandidate& candidate) { return has_marked(candidate.stencil); });
  const std::vector<ContactCandidate> found = proximity_search_.find_candidates(spheres_, marked_, {age_, horizon_});
  candidates_.insert(candidates_.end(), found.begin(), found.end());
  clear_marks();
}

void NeighbourList::find_pairs(const Points& before) {
  const HorizonTimes times{age_, horizon_};
  const NeighbourListState state{before, spheres_, horizon_ - age_, marked_};
  const std::vector<ElementBvh::LeafPair> leaves = tree_.find_pairs(times, 0.0);
  tree_.for_each_leaf(leaves, [&](std::size_t k) { find_corners(tree_.leaf(static_cast<Index>(k)), times, corners_[k]); });
  const auto leaf = [&](Index number) { return PositionedLeaf{tree_.leaf(number), corners_[static_cast<std::size_t>(number)]}; };
  const auto count = static_cast<Index>(leaves.size());
  const auto search = [&](Index begin, Index end, std::vector<ContactStencil>& batch) {
    std::vector<ElementIndexPair> elements;
    for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k) {
      append_pairs(leaf(leaves[k].first), leaf(leaves[k].second), times, elements);
    }
    for (const ElementIndexPair& pair : elements) pair_builder_.append_pairs(pair, state, batch);
  };
  const auto found = collect_from_chunks<ContactStencil>(count, kLeafPairsPerTask, search);
  pairs_.insert(pairs_.end(), found.begin(), found.end());
}

bool NeighbourList::has_marked(const ContactStencil& stencil) const {
  return stencil.any_of([&](Index i) { return is_marked(i); });
}

void NeighbourList::reset_spheres(const std::vector<Index>& leaving, const Points& before, const Points& ends) {
  for (const Index i : leaving) {
    if (is_marked(i)) continue;
    marked_[static_cast<std::size_t>(i)] = 1;
    spheres_.reset(i, before.col(i), ends.col(i));
    marked_list_.push_back(i);
  }
}

/// A fan that is no longer flat has pairs that were never listed. Those without a marked particle still cannot touch: their
/// particles are in their former spheres, for which the fan was flat.
void NeighbourList::test_fans() {
  std::vector<Index> centers;
  const auto visit = [&](Index i) {
    if (visited_[static_cast<std::size_t>(i)] != 0) return;
    visited_[static_cast<std::size_t>(i)] = 1;
    centers.push_back(i);
  };
  for (const Index i : marked_list_) {
    visit(i);
    for (const Index spoke : topology_.spokes(i)) visit(spoke);
  }
  for (const Index i : centers) visited_[static_cast<std::size_t>(i)] = 0;

  parallel_chunks(static_cast<Index>(centers.size()), kFansPerTask, [&](Index begin, Index end) {
    for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k) {
      const bool stays = fan_stays_flat(topology_, centers[k], spheres_, horizon_ - age_);
      flat_[static_cast<std::size_t>(centers[k])] = stays ? 1 : 0;
    }
  });
}

void NeighbourList::mark_elements() {
  marked_elements_.clear();
  for (const Index i : marked_list_) {
    for (const Index e : topology_.elements_at(i)) {
      char& listed = is_marked_element_[static_cast<std::size_t>(e)];
      if (listed == 0) marked_elements_.push_back(e);
      listed = 1;
    }
  }
  for (const Index e : marked_elements_) is_marked_element_[static_cast<std::size_t>(e)] = 0;
}

void NeighbourList::clear_marks() {
  for (const Index i : marked_list_) marked_[static_cast<std::size_t>(i)] = 0;
  marked_list_.clear();
}

}  // namespace sprung
