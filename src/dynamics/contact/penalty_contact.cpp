#include "dynamics/contact/penalty_contact.h"

#include "dynamics/contact/contact_materials.h"
#include "dynamics/forces/force_derivatives.h"

#include <algorithm>
#include <limits>

namespace sprung {
namespace {

// The thickness of particles that carry a surface, which do not collide. The query also returns those that are inside an obstacle.
constexpr double kNoContact = -std::numeric_limits<double>::infinity();

}  // namespace

PenaltyContact::PenaltyContact(const SpringNetwork& network, const ObstacleSet& obstacles, double stiffness, double damping,
                               double dt)
    : network_(network),
      obstacles_(obstacles, 0.0, 0.0),
      stiffness_(stiffness),
      damping_(damping),
      dt_(dt),
      thickness_(particle_thickness(network)) {
  for (const Body& body : network.bodies) {
    const Index inside = body.particle_count - body.contact_vertex_count();
    thickness_.segment(body.first_particle + body.contact_vertex_count(), inside).setConstant(kNoContact);
  }
}

std::vector<Contact> PenaltyContact::contacts(const Points& positions) const {
  std::vector<Contact> found = obstacles_.contacts({positions, positions, thickness_});
  std::erase_if(found, [&](const Contact& contact) { return thickness_[contact.particles[0]] == kNoContact; });
  return found;
}

void PenaltyContact::prepare(double time) {
  if (obstacles_.end() != time) obstacles_ = ObstacleFrame(obstacles_.set(), time, time);
}

/// The force of an obstacle on a particle: push * normal - rub * along.
struct PenaltyContact::Touch {
  double push = 0.0;                ///< [N]
  double rub = 0.0;                 ///< friction coefficient on velocity [N s/m]
  Vector3 along = Vector3::Zero();  ///< velocity along the surface [m/s]
  bool slides = false;              ///< friction cannot stop it within a step
};

ContactMaterial PenaltyContact::pair_of(const Contact& contact) const {
  return combine(network_.body_of(contact.particles[0]).material, obstacles_.obstacle(contact.obstacle).material);
}

PenaltyContact::Touch PenaltyContact::touch(const Contact& contact, const Kinematics& at) const {
  const Index i = contact.particles[0];
  const ContactMaterial pair = pair_of(contact);
  const Vector3 relative = at.v.col(i) - obstacles_.surface_velocity(contact.obstacle, at.x.col(i), at.time, dt_);
  const double speed = contact.normal.dot(relative);
  Touch touch;
  touch.push = std::max(0.0, stiffness_ * (pair.thickness - contact.distance) - damping_ * speed);
  touch.along = relative - speed * contact.normal;
  const double slip = touch.along.norm();
  if (slip == 0.0) return touch;
  const double stopping = network_.masses[i] * slip / dt_;
  touch.slides = pair.friction * touch.push < stopping;
  touch.rub = std::min(pair.friction * touch.push, stopping) / slip;
  return touch;
}

void PenaltyContact::add(const Kinematics& at, Points& forces) const {
  for (const Contact& contact : contacts(at.x)) {
    const Touch touched = touch(contact, at);
    forces.col(contact.particles[0]) += touched.push * contact.normal;
    forces.col(contact.particles[0]) -= touched.rub * touched.along;
  }
}

void PenaltyContact::add_derivatives(const Kinematics& at, ForceDerivatives& derivatives) const {
  for (const Contact& contact : contacts(at.x)) {
    const Touch touched = touch(contact, at);
    if (touched.push == 0.0) continue;
    const Index i = contact.particles[0];
    const Matrix3 out = contact.normal * contact.normal.transpose();
    derivatives.by_position.add(i, i, -stiffness_ * out);
    Matrix3 tangential = Matrix3::Identity() - out;
    if (touched.slides) tangential -= touched.along * touched.along.transpose() / touched.along.squaredNorm();
    derivatives.by_velocity.add(i, i, -damping_ * out - touched.rub * tangential);
  }
}

void PenaltyContact::append_elements(std::vector<LinearElement>& elements) const {
  append_penalty_elements(network_, stiffness_, damping_, elements);
}

double PenaltyContact::energy(const Points& positions) const {
  double energy = 0.0;
  for (const Contact& contact : contacts(positions)) {
    const double depth = pair_of(contact).thickness - contact.distance;
    if (depth > 0.0) energy += 0.5 * stiffness_ * depth * depth;
  }
  return energy;
}

std::vector<Index> PenaltyContact::touching(const Points& positions) const {
  std::vector<Index> particles;  // contacts are sorted by particle
  for (const Contact& contact : contacts(positions)) {
    if (particles.empty() || contact.particles[0] != particles.back()) particles.push_back(contact.particles[0]);
  }
  return particles;
}

std::vector<ContactNormal> PenaltyContact::normals(const Points& positions) const {
  std::vector<ContactNormal> normals;
  for (const Contact& contact : contacts(positions)) {
    normals.push_back({contact.particles[0], contact.normal});
  }
  return normals;
}

void append_penalty_elements(const SpringNetwork& network, double stiffness, double damping, std::vector<LinearElement>& elements) {
  for (Index i = 0; i < network.particle_count(); ++i) elements.push_back(LinearElement::anchor(i, stiffness, damping));
}

}  // namespace sprung
