// What those who meet are to each other.
#pragma once

#include "base/contact_material.h"
#include "collision/core/contact.h"
#include "collision/shapes/obstacle.h"
#include "network/spring_network.h"

#include <vector>

namespace sprung {

/// Gap, frictions and restitution of a body and an obstacle (see ContactMaterial).
[[nodiscard]] ContactMaterial combine(const ContactMaterial& body, const ContactMaterial& obstacle);

/// The same of two bodies, or of a body and itself: their gap is the mean of their thicknesses.
[[nodiscard]] ContactMaterial combine_bodies(const ContactMaterial& first, const ContactMaterial& second);

/// Each particle's share of the gap [m]: the thickness of its body.
[[nodiscard]] Scalars particle_thickness(const SpringNetwork& network);

/// The materials of contacts.
class ContactMaterials {
 public:
  /// Keeps references to both.
  ContactMaterials(const SpringNetwork& network, const std::vector<Obstacle>& obstacles);

  /// A body and what it meets: an obstacle, or else the other body.
  struct Pair {
    Index body = kNone;
    Index obstacle = kNone;
    Index other_body = kNone;
    bool operator==(const Pair&) const = default;
  };
  /// The pair that was asked for last: contacts mostly come one after another of the same.
  struct Last {
    Pair pair{};
    ContactMaterial material{};
  };

  /// Valid until `last` is used again.
  [[nodiscard]] const ContactMaterial& of(const Contact& contact, Last& last) const;

 private:
  [[nodiscard]] Pair pair_of(const Contact& contact) const;

  const SpringNetwork& network_;
  const std::vector<Obstacle>& obstacles_;
  std::vector<Index> body_of_;
};

}  // namespace sprung
