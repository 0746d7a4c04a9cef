#include "collision/pairs/element_contacts.h"

#include "collision/core/block_bounds.h"
#include "collision/core/contact.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace sprung {
namespace {

constexpr Index kCandidatesPerTask = 1024;

// A direction that leans over a face by up to this sine still counts as pointing away from it: flat neighbours lean by rounding.
constexpr double kLean = 0x1p-10;

// Between nearly flat neighbours of an edge, hardly any direction leans over neither of them.
constexpr double kEdgeLean = 0.1;

// If a particle moves farther in the step than this fraction of the gap, contacts between bodies use the closest points at the
// step's end. The closest points of the begin would be askew by then, and would lift and stop a sliding body. All faces around a
// point need the same time, so that one of them claims the contact. Contacts within a body keep the begin: with the end, cloths
// that fell on their edge came to lie crumpled instead of folding evenly.
constexpr double kSlidingDisplacement = 0.05;

// A contact that ends deeper in its gap than this fraction is measured where it enters the gap.
constexpr double kDeepEntry = 0.1;

// A candidate that is far apart is checked again after at most this many steps.
constexpr int kMaxSkipSteps = 4;

class ElementContacts {
 public:
  ElementContacts(const CollisionSurface& surface, const SurfaceTopology& features, const Points& before, const Points& after)
      : surface_(surface),
        features_(features),
        before_(before),
        after_(after),
        clearance_(kClearance * before.cwiseAbs().maxCoeff()),
        largest_displacement_(std::sqrt((after - before).colwise().squaredNorm().maxCoeff())) {}

  void append(ContactCandidate& candidate, std::vector<Contact>& contacts) const {
    if (candidate.skip_steps > 0) {
      --candidate.skip_steps;
      return;
    }
    ContactStencil& stencil = candidate.stencil;
    const double displacement = largest_displacement(stencil);
    const double max_margin = candidate.reach - candidate.gap;
    const double reach = candidate.gap + std::min(max_margin, margin_of_step(candidate.gap, displacement));
    if (stays_apart(candidate, reach, displacement)) return;
    const Configuration first = configuration_at(stencil, before_);
    const double begin = first.separation.norm();
    if (!(begin > 0.0)) return;
    stencil.normal = first.separation / begin;
    if (stays_apart(candidate, reach, displacement)) return;
    const Configuration contact_time = configuration_of_contact(candidate, first);
    const double distance = contact_time.separation.norm();
    if (!(distance > 0.0) || !is_representative(candidate, contact_time)) return;
    Contact contact;
    contact.count = Contact::kMostParticles;
    contact.normal = contact_time.separation / distance;
    for (std::size_t k = 0; k < Contact::kMostParticles; ++k) {
      contact.particles[k] = stencil.particles[k];
      contact.weights[k] = contact_time.weights[k];
      contact.distance += contact.weights[k] * contact.normal.dot(after_.col(contact.particles[k]));
    }
    if (!(contact.distance < reach)) return;
    contact.most_gap = candidate.gap;
    contact.clearance = clearance_;
    contacts.push_back(contact);
  }

 private:
  using Corners = ContactStencil::PerParticle<Vector3>;

  /// A candidate's sides at one time of the step.
  struct Configuration {
    Configuration(const ContactStencil& stencil, const Corners& corners, const Points& neighbours)
        : x(corners), around(neighbours) {
      const ClosestFeatures closest = closest_points(stencil, x);
      weights = closest.weights;
      separation = closest.separation();
    }

    Corners x;             ///< positions of the candidate's particles [m]
    const Points& around;  ///< positions of their neighbours [m]
    ContactStencil::PerParticle<double> weights{};
    Vector3 separation = Vector3::Zero();
  };

  [[nodiscard]] static Configuration configuration_at(const ContactStencil& stencil, const Points& positions) {
    return {stencil, corners_at(stencil, positions), positions};
  }

  /// After this fraction of the step. Neighbours stay at its begin.
  [[nodiscard]] Configuration configuration_within(const ContactStencil& stencil, double fraction) const {
    Corners x;
    for (std::size_t k = 0; k < static_cast<std::size_t>(stencil.count()); ++k) {
      const Index i = stencil.particles[k];
      x[k] = before_.col(i) + fraction * (after_.col(i) - before_.col(i));
    }
    return {stencil, x, before_};
  }

  /// The configuration that the contact is derived from: the step's end if the sides slide past each other; else where they enter
  /// the gap, if they end deep in it; else the step's begin.
  [[nodiscard]] Configuration configuration_of_contact(const ContactCandidate& candidate, const Configuration& first) const {
    const bool may_slide = element(candidate.elements[0]).body != element(candidate.elements[1]).body;
    if (may_slide && largest_displacement_ > kSlidingDisplacement * candidate.gap) {
      const Configuration last = configuration_at(candidate.stencil, after_);
      if (separated_at_begin(candidate.stencil, last)) return last;
    }
    const double begin = first.separation.norm();
    const double end = heights_at(candidate.stencil, after_).gap();
    if (!(begin > candidate.gap && end < (1.0 - kDeepEntry) * candidate.gap)) return first;
    return configuration_within(candidate.stencil, (begin - candidate.gap) / (begin - end));
  }

  /// Whether the plane between the closest points of the step's end has the sides on either side of it at the begin, too. Then they
  /// did not pass through each other.
  [[nodiscard]] bool separated_at_begin(ContactStencil stencil, const Configuration& last) const {
    stencil.normal = last.separation;
    return heights_at(stencil, before_).gap() > 0.0;
  }

  [[nodiscard]] const Element& element(Index number) const { return surface_.elements[static_cast<std::size_t>(number)]; }

  /// Of the stencil's particles in the step [m].
  [[nodiscard]] double largest_displacement(const ContactStencil& stencil) const {
    double largest2 = 0.0;
    for (std::size_t k = 0; k < static_cast<std::size_t>(stencil.count()); ++k) {
      const Index i = stencil.particles[k];
      largest2 = std::max(largest2, (after_.col(i) - before_.col(i)).squaredNorm());
    }
    return std::sqrt(largest2);
  }

  /// Whether the gap along the normal exceeds `reach` throughout the step. Then the candidate rests for as long as its sides stay
  /// apart even if they approach in each step as fast as in this one plus one side's whole displacement: a body that moves
  /// alongside may be stopped.
  [[nodiscard]] bool stays_apart(ContactCandidate& candidate, double reach, double displacement) const {
    const double begin = heights_at(candidate.stencil, before_).gap();
    const double end = heights_at(candidate.stencil, after_).gap();
    const double slack = std::min(begin, end) - reach;
    if (!(slack >= 0.0)) return false;
    const double approach = std::max(begin - end, 0.0) + displacement;
    candidate.skip_steps = slack < kMaxSkipSteps * approach ? static_cast<int>(slack / approach) : kMaxSkipSteps;
    return true;
  }

  /// Whether the sine between `direction` and `toward`, which points into a neighbour, shows that the direction leans over it.
  [[nodiscard]] static bool leans(const Vector3& direction, const Vector3& toward, double max_sine) {
    return direction.dot(toward) > max_sine * direction.norm() * toward.norm();
  }

  /// Several features share a closest point on a vertex or an edge. Exactly one of them makes the contact, and only if the surface
  /// around the point faces the other side.
  [[nodiscard]] bool is_representative(const ContactCandidate& candidate, const Configuration& at) const {
    return candidate.stencil.is_edge_edge() ? edges_are_representative(candidate, at) : face_is_representative(candidate, at);
  }

  /// Whether no edge at a particle, which is at x, leans towards `direction`. Edges to a particle of `excluded` do not count: such
  /// a pair of elements has no stencil, and nothing else would make the contact of a segment that folds back onto the one before.
  [[nodiscard]] bool vertex_faces(Index particle, const Points& around, const Vector3& x, const Vector3& direction,
                                  std::span<const Index> excluded) const {
    for (const Index e : features_.elements_at(particle)) {
      for (const Index other : corners_of(element(e))) {
        if (other == particle || std::ranges::find(excluded, other) != excluded.end()) continue;
        if (leans(direction, around.col(other) - x, kLean)) return false;
      }
    }
    return true;
  }

  /// The face owns its closest point, which faces the vertex.
  [[nodiscard]] bool face_is_representative(const ContactCandidate& candidate, const Configuration& at) const {
    const Index face = candidate.elements[1];
    int used = 0;
    int corner = 0;
    int unused = 0;
    for (int k = 0; k < 3; ++k) {
      const bool is_used = at.weights[static_cast<std::size_t>(k) + 1] != 0.0;
      used += is_used ? 1 : 0;
      (is_used ? corner : unused) = k;
    }
    if (used == 3) return true;
    if (used == 1) {
      const auto slot = static_cast<std::size_t>(corner) + 1;
      return features_.owns_corner(face, corner) &&
             vertex_faces(candidate.stencil.particles[slot], at.around, at.x[slot], at.separation, {});
    }
    const int edge = (unused + 1) % 3;
    if (!features_.owns_edge(face, edge)) return false;
    const Index across = features_.across(face, edge);
    return across == kNone || !leans(at.separation, at.around.col(across) - (at.x[0] - at.separation), kLean);
  }

  /// The closest points are inside both edges, or at a vertex that no face stencil covers.
  [[nodiscard]] bool edges_are_representative(const ContactCandidate& candidate, const Configuration& at) const {
    return edge_is_representative(candidate, at, 0) && edge_is_representative(candidate, at, 1);
  }

  [[nodiscard]] bool edge_is_representative(const ContactCandidate& candidate, const Configuration& at, std::size_t side) const {
    const Vector3 direction = side == 0 ? Vector3(-at.separation) : at.separation;
    const std::size_t first = 2 * side;
    const Element& own = element(candidate.elements[side]);
    const Element& other = element(candidate.elements[1 - side]);
    if (at.weights[first] == 0.0 || at.weights[first + 1] == 0.0) {
      const std::size_t slot = at.weights[first] == 0.0 ? first + 1 : first;
      const int corner = (candidate.edge[side] + (slot == first ? 0 : 1)) % own.corners;
      if (other.corners == 3 || !features_.owns_corner(candidate.elements[side], corner)) return false;
      return vertex_faces(candidate.stencil.particles[slot], at.around, at.x[slot], direction, corners_of(other));
    }
    if (own.corners != 3) return true;
    const double sign = side == 0 ? 1.0 : -1.0;
    const Vector3 point = sign * (at.weights[first] * at.x[first] + at.weights[first + 1] * at.x[first + 1]);
    const Index third = own.particles[static_cast<std::size_t>((candidate.edge[side] + 2) % 3)];
    const Index across = features_.across(candidate.elements[side], candidate.edge[side]);
    if (leans(direction, at.around.col(third) - point, kEdgeLean)) return false;
    return across == kNone || !leans(direction, at.around.col(across) - point, kEdgeLean);
  }

  const CollisionSurface& surface_;
  const SurfaceTopology& features_;
  const Points& before_;
  const Points& after_;
  double clearance_;
  double largest_displacement_;  ///< of any particle in the step [m]
};

}  // namespace

void append_self_contacts(const CollisionSurface& surface, const SurfaceTopology& features,
                          std::vector<ContactCandidate>& candidates, const Points& before, const Points& after,
                          std::vector<Contact>& contacts) {
  const ElementContacts finder(surface, features, before, after);
  const auto count = static_cast<Index>(candidates.size());
  const auto found =
      collect_from_chunks<Contact>(count, kCandidatesPerTask, [&](Index begin, Index end, std::vector<Contact>& batch) {
        for (Index k = begin; k < end; ++k) finder.append(candidates[static_cast<std::size_t>(k)], batch);
      });
  contacts.insert(contacts.end(), found.begin(), found.end());
}

}  // namespace sprung
