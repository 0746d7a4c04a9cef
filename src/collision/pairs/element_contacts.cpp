#include "collision/pairs/element_contacts.h"

#include "base/parallel.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace sprung {
namespace {

constexpr Index kCandidatesPerTask = 1024;

// As a part of the largest coordinate: see DivisionPlanes.
constexpr double kClearance = 0x1p-30;

// A direction that leans over a face by no more than this sine still counts as away from it: flat neighbours lean by rounding.
constexpr double kLean = 0x1p-10;

// Edges of nearly flat neighbours hardly have a direction that leans over neither face.
constexpr double kEdgeLean = 0.1;

// In steps with ways of more than this part of the gap, what passes by has its nearest points where forces lead: older ones lie
// askew by then, and lift and hold what slides. All faces around a point are to see it at the same time, to tell whose it is. But
// not within a body: cloths that fell on their edge, and folded evenly, came to lie crumpled.
constexpr double kFreshWay = 0.05;

// What comes nearer than its gap by more than this part of it meets where it passes the gap.
constexpr double kLongWay = 0.1;

// What is far off is looked at again after so many steps at the latest.
constexpr int kMostRest = 4;

class ElementContacts {
 public:
  ElementContacts(const CollisionSurface& surface, const SurfaceTopology& features, const Points& before, const Points& after)
      : surface_(surface),
        features_(features),
        before_(before),
        after_(after),
        clearance_(kClearance * before.cwiseAbs().maxCoeff()),
        longest_way_(std::sqrt((after - before).colwise().squaredNorm().maxCoeff())) {}

  void append(ContactCandidate& candidate, std::vector<Contact>& contacts) const {
    if (candidate.rest > 0) {
      --candidate.rest;
      return;
    }
    const double way = longest_way(candidate);
    const double most_margin = candidate.reach - candidate.gap;
    const double reach = candidate.gap + std::min(most_margin, margin_of_step(candidate.gap, way));
    if (stays_apart(candidate, reach, way)) return;
    Meeting meeting = meeting_at(candidate, before_);
    const double begin = meeting.closest.separation.norm();
    if (!(begin > 0.0)) return;
    candidate.normal = meeting.closest.separation / begin;
    if (stays_apart(candidate, reach, way)) return;
    meeting = later_meeting(candidate, meeting);
    const ClosestFeatures& closest = meeting.closest;
    const double distance = closest.separation.norm();
    if (!(distance > 0.0)) return;
    if (!(candidate.edges ? leads_from_edges(candidate, meeting) : leads_from_face(candidate, meeting))) return;
    Contact contact;
    contact.count = 4;
    contact.particles = candidate.particles;
    contact.weights = closest.weights;
    contact.normal = closest.separation / distance;
    for (std::size_t k = 0; k < 4; ++k)
      contact.distance += closest.weights[k] * contact.normal.dot(after_.col(candidate.particles[k]));
    if (!(contact.distance < reach)) return;
    contact.most_gap = candidate.gap;
    contact.clearance = clearance_;
    contacts.push_back(contact);
  }

 private:
  /// The sides of a candidate at some time.
  struct Meeting {
    const Points* around;      ///< where their neighbours are
    std::array<Vector3, 4> x;  ///< the candidate's particles
    ClosestFeatures closest;
  };

  [[nodiscard]] static Meeting meeting_at(const ContactCandidate& candidate, const Points& positions) {
    std::array<Vector3, 4> x;
    for (std::size_t k = 0; k < 4; ++k) x[k] = positions.col(candidate.particles[k]);
    return {&positions, x, closest_points(candidate, x)};
  }

  /// Where they are after this part of the way. Their neighbours stay.
  [[nodiscard]] Meeting meeting_on_way(const ContactCandidate& candidate, double part) const {
    std::array<Vector3, 4> x;
    for (std::size_t k = 0; k < 4; ++k) {
      const Index i = candidate.particles[k];
      x[k] = before_.col(i) + part * (after_.col(i) - before_.col(i));
    }
    return {&before_, x, closest_points(candidate, x)};
  }

  /// At the end of a step in which they pass by each other; where they pass the gap, if they come much nearer than that; or at
  /// first.
  [[nodiscard]] Meeting later_meeting(const ContactCandidate& candidate, const Meeting& first) const {
    const bool may_slide = element(candidate.elements[0]).body != element(candidate.elements[1]).body;
    if (may_slide && longest_way_ > kFreshWay * candidate.gap) {
      const Meeting last = meeting_at(candidate, after_);
      if (separated(candidate, last)) return last;
    }
    const double begin = first.closest.separation.norm();
    const double end = gap_at(candidate, after_);
    if (!(begin > candidate.gap && end < (1.0 - kLongWay) * candidate.gap)) return first;
    return meeting_on_way(candidate, (begin - candidate.gap) / (begin - end));
  }

  /// Whether the plane across these nearest points, at the step's end, had the sides on either side of it at its begin: then they
  /// did not go through each other in between.
  [[nodiscard]] bool separated(ContactCandidate candidate, const Meeting& last) const {
    candidate.normal = last.closest.separation;
    return gap_at(candidate, before_) > 0.0;
  }

  [[nodiscard]] const Element& element(Index number) const { return surface_.elements[static_cast<std::size_t>(number)]; }

  /// The longest of its particles [m].
  [[nodiscard]] double longest_way(const ContactCandidate& candidate) const {
    double way2 = 0.0;
    for (const Index i : candidate.particles) way2 = std::max(way2, (after_.col(i) - before_.col(i)).squaredNorm());
    return std::sqrt(way2);
  }

  [[nodiscard]] static double gap_at(const ContactCandidate& candidate, const Points& positions) {
    return gap_along(candidate, [&](std::size_t k) { return candidate.normal.dot(positions.col(candidate.particles[k])); });
  }

  /// Whether they are apart along the normal all the time, by more than they are to be looked at. Then they rest while they could
  /// come no nearer if they came nearer by as much in each step, and one of them by its whole way: what flies beside it may be
  /// stopped.
  [[nodiscard]] bool stays_apart(ContactCandidate& candidate, double reach, double way) const {
    const double begin = gap_at(candidate, before_);
    const double end = gap_at(candidate, after_);
    const double slack = std::min(begin, end) - reach;
    if (!(slack >= 0.0)) return false;
    const double nearer = std::max(begin - end, 0.0) + way;
    candidate.rest = slack < kMostRest * nearer ? static_cast<int>(slack / nearer) : kMostRest;
    return true;
  }

  /// Whether a direction from a point of an element leans over what ends at `other` by no more than `lean`.
  [[nodiscard]] static bool leans(const Vector3& direction, const Vector3& toward, double lean) {
    return direction.dot(toward) > lean * direction.norm() * toward.norm();
  }

  /// Whether all that meets at a particle, which is at x, leads away from the direction in which `met` is. What leads to a particle
  /// of that is not asked: it is no pair with it, and nothing else would speak for a segment that folds back onto the one before.
  [[nodiscard]] bool leads_from_corner(Index particle, const Points& around, const Vector3& x, const Vector3& direction,
                                       std::span<const Index> met) const {
    for (const Index e : features_.elements_at(particle)) {
      for (const Index other : corners_of(element(e))) {
        if (other == particle || std::ranges::find(met, other) != met.end()) continue;
        if (leans(direction, around.col(other) - x, kLean)) return false;
      }
    }
    return true;
  }

  /// Of the faces that share the point, the one that owns it speaks for it.
  [[nodiscard]] bool leads_from_face(const ContactCandidate& candidate, const Meeting& meeting) const {
    const auto& [around, x, closest] = meeting;
    const Index face = candidate.elements[1];
    int used = 0;
    int corner = 0;
    int unused = 0;
    for (int k = 0; k < 3; ++k) {
      const bool is_used = closest.weights[static_cast<std::size_t>(k) + 1] != 0.0;
      used += is_used ? 1 : 0;
      (is_used ? corner : unused) = k;
    }
    if (used == 3) return true;
    if (used == 1) {
      const auto at = static_cast<std::size_t>(corner) + 1;
      return features_.owns_corner(face, corner) &&
             leads_from_corner(candidate.particles[at], *around, x[at], closest.separation, {});
    }
    const int edge = (unused + 1) % 3;
    if (!features_.owns_edge(face, edge)) return false;
    const Index across = features_.across(face, edge);
    return across == kNone || !leans(closest.separation, around->col(across) - (x[0] - closest.separation), kLean);
  }

  /// The nearest points are within both edges, or at a corner that no face speaks for.
  [[nodiscard]] bool leads_from_edges(const ContactCandidate& candidate, const Meeting& meeting) const {
    const auto& [around, x, closest] = meeting;
    for (std::size_t side = 0; side < 2; ++side) {
      const Vector3 direction = side == 0 ? Vector3(-closest.separation) : closest.separation;
      const std::size_t first = 2 * side;
      const Element& own = element(candidate.elements[side]);
      const Element& other = element(candidate.elements[1 - side]);
      if (closest.weights[first] == 0.0 || closest.weights[first + 1] == 0.0) {
        const std::size_t at = closest.weights[first] == 0.0 ? first + 1 : first;
        const int corner = (candidate.edge[side] + (at == first ? 0 : 1)) % own.corners;
        if (other.corners == 3 || !features_.owns_corner(candidate.elements[side], corner)) return false;
        if (!leads_from_corner(candidate.particles[at], *around, x[at], direction, corners_of(other))) return false;
        continue;
      }
      if (own.corners != 3) continue;
      const double sign = side == 0 ? 1.0 : -1.0;
      const Vector3 at = sign * (closest.weights[first] * x[first] + closest.weights[first + 1] * x[first + 1]);
      const Index third = own.particles[static_cast<std::size_t>((candidate.edge[side] + 2) % 3)];
      const Index across = features_.across(candidate.elements[side], candidate.edge[side]);
      if (leans(direction, around->col(third) - at, kEdgeLean)) return false;
      if (across != kNone && leans(direction, around->col(across) - at, kEdgeLean)) return false;
    }
    return true;
  }

  const CollisionSurface& surface_;
  const SurfaceTopology& features_;
  const Points& before_;
  const Points& after_;
  double clearance_;
  double longest_way_;  ///< of any particle in the step [m]
};

}  // namespace

void append_self_contacts(const CollisionSurface& surface, const SurfaceTopology& features,
                          std::vector<ContactCandidate>& candidates, const Points& before, const Points& after,
                          std::vector<Contact>& contacts) {
  const ElementContacts finder(surface, features, before, after);
  const auto count = static_cast<Index>(candidates.size());
  std::vector<std::vector<Contact>> parts(static_cast<std::size_t>((count + kCandidatesPerTask - 1) / kCandidatesPerTask));
  parallel_chunks(count, kCandidatesPerTask, [&](Index begin, Index end) {
    for (Index k = begin; k < end; ++k) {
      finder.append(candidates[static_cast<std::size_t>(k)], parts[static_cast<std::size_t>(begin / kCandidatesPerTask)]);
    }
  });
  for (const std::vector<Contact>& part : parts) contacts.insert(contacts.end(), part.begin(), part.end());
}

}  // namespace sprung
