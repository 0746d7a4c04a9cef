// Builds a network particle by particle, or from whole bodies (rope, cloth, solid, mesh).
#pragma once

#include "network/bodies/body_shape.h"
#include "network/model/spring_network.h"

#include <string>
#include <vector>

namespace sprung {

class ProblemList;

/// Collects particles, springs, bodies, pins and attachments. Const members may be called from several threads at the same time. To
/// add something takes time in proportion to its size. build() is costly: it copies and checks everything and sorts the springs.
class NetworkBuilder {
 public:
  /// Adds a particle of `mass` [kg] > 0 at `position` [m] and returns its number. Particles and springs added one by one belong
  /// to a body named "network" unless `begin_body` named another.
  Index add_particle(const Vector3& position, double mass, const Vector3& velocity = Vector3::Zero());

  /// Joins two particles of one body by a spring with k_s [N/m], rest length [m] and k_d [N s/m], all >= 0.
  void add_spring(Index i, Index j, double stiffness, double rest_length, double damping = 0.0,
                  SpringKind kind = SpringKind::structural, const SpringLaw& law = {});

  /// Keeps three particles of one body in line, with k [N m/rad] and a damping of the angle's rate [N m s], both >= 0. The rest
  /// lengths are the current distances.
  void add_angle_bend(Index before, Index middle, Index after, double stiffness, double damping = 0.0);

  /// Begins a new body of this name. Particles and springs that are added later belong to it.
  void begin_body(const std::string& name, const ContactMaterial& material = {}, const BodyContact& contact = {});

  /// Adds a whole body at its final pose. Returns the number of its first particle.
  Index add_body(const std::string& name, const BodyShape& shape, const ContactMaterial& material = {},
                 const BodyContact& contact = {});

  /// Fixes a particle, or moves it along `motion`, which turns about `origin` [m]. By default it rests.
  void pin(Index particle, const Motion& motion = {}, const Vector3& origin = Vector3::Zero());
  void pin(std::vector<Index> particles, const Motion& motion = {}, const Vector3& origin = Vector3::Zero());

  /// Adds a pin that follows an obstacle, that begins or ends after time 0, or that has a name.
  void add_pin(Pin pin);

  /// Adds rods or springs between bodies, or between a body and an obstacle.
  void add_attachment(Attachment attachment);

  /// The network. Throws InputError that names every problem: a network or body without particles, bodies of one name, masses that
  /// are not positive, springs and angle bends that join a particle to itself, to another body or to none, negative or non-finite
  /// quantities, springs that break in a body with cells, a volume factor or a pressure, contact materials out of range, pins of
  /// particles that do not exist, particles pinned twice at one time, pins and attachments that end before they begin or share a
  /// name, and attachments without ends, of a particle to itself, or with quantities out of range.
  [[nodiscard]] SpringNetwork build() const;

 private:
  struct Draft {
    std::string name;
    BodyShape shape;
    ContactMaterial material;
    BodyContact contact;
    Index first_particle = 0;
    bool whole = false;  ///< added as a whole body: accepts no further particles
  };
  Draft& open_draft();
  static bool contains(const Draft& draft, Index particle);
  void complete_angle_bends(std::vector<Draft>& drafts, ProblemList& problems) const;
  /// The drafts with the springs and angle bends that were added one by one. Those that join no particles of one body are
  /// problems.
  [[nodiscard]] std::vector<Draft> complete_drafts(ProblemList& problems) const;

  std::vector<Draft> drafts_;
  Springs springs_;         ///< those added one by one, in the network's numbering
  AngleBends angle_bends_;  ///< likewise, without lengths
  std::vector<Pin> pins_;
  std::vector<Attachment> attachments_;
  Index particle_count_ = 0;
};

}  // namespace sprung
