// The combined materials of two bodies, or of a body and an obstacle.
#pragma once

#include "base/contact_material.h"
#include "collision/core/contact.h"
#include "collision/shapes/obstacle.h"
#include "network/model/spring_network.h"

#include <vector>

namespace sprung {

/// Gap, frictions and restitution of a body and an obstacle (see ContactMaterial).
[[nodiscard]] ContactMaterial combine(const ContactMaterial& body, const ContactMaterial& obstacle);

/// The combined material of two bodies, or of a body with itself: the gap is the mean of their thicknesses.
[[nodiscard]] ContactMaterial combine_bodies(const ContactMaterial& first, const ContactMaterial& second);

/// Each particle's contribution to the gap [m]: the thickness of its body.
[[nodiscard]] Scalars particle_thickness(const SpringNetwork& network);

/// Combined materials by contact.
class ContactMaterials {
 public:
  /// Keeps references to both.
  ContactMaterials(const SpringNetwork& network, const std::vector<Obstacle>& obstacles);

  /// A body and an obstacle, or two bodies.
  struct Pair {
    Index body = kNone;
    Index obstacle = kNone;
    Index other_body = kNone;
    bool operator==(const Pair&) const = default;
  };
  /// The pair of the last query: consecutive contacts mostly share their pair.
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
