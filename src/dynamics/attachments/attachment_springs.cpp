#include "dynamics/attachments/attachment_springs.h"

#include "dynamics/attachments/engagement.h"
#include "dynamics/attachments/rods.h"
#include "dynamics/forces/force_derivatives.h"
#include "dynamics/numerics/block_matrix.h"

#include <algorithm>

namespace sprung {
namespace {

// The stiffness of a rod in an implicit scheme relative to what it joins. Passes correct the rest of its length; with a stiffer
// rod, rounding would change the sum of the momenta.
constexpr double kRodStiffness = 1 << 12;

Matrix3 along(const Vector3& difference) {
  const double length = difference.norm();
  if (length == 0.0) return Matrix3::Zero();
  return difference * difference.transpose() / (length * length);
}

/// The largest inverse mass at the second ends [1/kg].
double largest_inverse_mass(const SpringNetwork& network, const SecondEnds& second) {
  if (const auto* end = std::get_if<SurfaceEnd>(&second)) {
    const Body& body = network.bodies[static_cast<std::size_t>(end->body)];
    return network.inverse_masses.segment(body.first_particle, body.particle_count).maxCoeff();
  }
  double largest = 0.0;
  if (const auto* ends = std::get_if<ParticleEnds>(&second)) {
    for (const Index particle : ends->particles) largest = std::max(largest, network.inverse_masses[particle]);
  }
  return largest;
}

}  // namespace

AttachmentSprings::AttachmentSprings(const SpringNetwork& network, const std::vector<Obstacle>& obstacles, double step_length,
                                     bool implicit)
    : network_(network), obstacles_(obstacles), step_length_(step_length), implicit_(implicit) {
  if (!implicit) return;
  stiffness_at_.setZero(network.particle_count());
  for (Index s = 0; s < network.springs.count(); ++s) {
    stiffness_at_[network.springs.first[s]] += network.springs.stiffness[s];
    stiffness_at_[network.springs.second[s]] += network.springs.stiffness[s];
  }
}

void AttachmentSprings::load(const std::vector<Link>& links) {
  springs_.clear();
  for (std::size_t k = 0; k < links.size(); ++k) {
    const bool rigid = network_.attachments[links[k].attachment].is_rigid();
    if (!links[k].broken && (implicit_ || !rigid)) springs_.push_back(spring_of(k, links[k]));
  }
}

AttachmentSprings::Spring AttachmentSprings::spring_of(std::size_t number, const Link& link) const {
  const Attachment& attachment = network_.attachments[link.attachment];
  Spring spring{.number = number,
                .ends = LinkEnds(network_, obstacles_, link),
                .link = link,
                .stiffness = attachment.stiffness.value_or(0.0),
                .damping = attachment.damping,
                .rigid = attachment.is_rigid()};
  if (!spring.rigid) return spring;
  const double inverse_mass = spring.ends.inverse_mass(network_.inverse_masses);
  if (inverse_mass == 0.0) return spring;
  double stiffness = 1.0 / (inverse_mass * step_length_ * step_length_);
  for (const Index particle : spring.ends.particles()) stiffness += stiffness_at_[particle];
  spring.stiffness = kRodStiffness * stiffness;
  return spring;
}

Vector3 AttachmentSprings::difference_of(const Spring& spring, const Kinematics& at) const {
  return spring.ends.sum(at.x) - spring.ends.anchor(at.time);
}

double AttachmentSprings::length_of(const Spring& spring, double time) const {
  return spring.rigid ? length_at(spring.link, time) : spring.link.length;
}

/// On the first end.
Vector3 AttachmentSprings::force_of(const Spring& spring, const Kinematics& at) const {
  const Vector3 difference = difference_of(spring, at);
  const double distance = difference.norm();
  if (distance == 0.0) return Vector3::Zero();
  const Vector3 direction = difference / distance;
  double tension = spring.stiffness * (distance - length_of(spring, at.time));
  if (spring.damping > 0.0) {
    const Vector3 moved = spring.ends.anchor(at.time + step_length_) - spring.ends.anchor(at.time);
    tension += spring.damping * direction.dot(spring.ends.sum(at.v) - moved / step_length_);
  }
  return -tension * direction;
}

Vector3 AttachmentSprings::force_of(const Link& link, const Kinematics& at) const { return force_of(spring_of(0, link), at); }

void AttachmentSprings::add(const Kinematics& at, Points& forces) const {
  for (const Spring& spring : springs_) {
    const Vector3 force = force_of(spring, at);
    for (std::size_t k = 0; k < spring.ends.particles().size(); ++k)
      forces.col(spring.ends.particles()[k]) += spring.ends.weight(k) * force;
  }
}

void AttachmentSprings::couple(std::vector<ParticlePair>& pairs) const {
  for (const Spring& spring : springs_) {
    const auto particles = spring.ends.particles();
    for (std::size_t k = 0; k < particles.size(); ++k) {
      for (std::size_t l = 0; l < k; ++l) pairs.push_back({particles[k], particles[l]});
    }
  }
}

/// Minus the derivative of the force by the difference of the ends. A rod of some length turns freely, whatever its length is now.
Matrix3 AttachmentSprings::stiffness_of(const Spring& spring, const Vector3& difference, double length) const {
  if (length == 0.0) return spring.stiffness * Matrix3::Identity();
  const Matrix3 lengthwise = along(difference);
  if (spring.rigid || difference.norm() <= length) return spring.stiffness * lengthwise;
  const double across = 1.0 - length / difference.norm();
  return spring.stiffness * (lengthwise + across * (Matrix3::Identity() - lengthwise));
}

void AttachmentSprings::add_derivatives(const Kinematics& at, ForceDerivatives& derivatives) const {
  for (const Spring& spring : springs_) {
    const Vector3 difference = difference_of(spring, at);
    const Matrix3 stiffness = stiffness_of(spring, difference, length_of(spring, at.time));
    const Matrix3 damping = spring.damping * along(difference);
    const auto particles = spring.ends.particles();
    for (std::size_t k = 0; k < particles.size(); ++k) {
      for (std::size_t l = 0; l <= k; ++l) {
        const double weight = spring.ends.weight(k) * spring.ends.weight(l);
        derivatives.by_position.add(particles[k], particles[l], -weight * stiffness);
        if (spring.damping > 0.0) derivatives.by_velocity.add(particles[k], particles[l], -weight * damping);
      }
    }
    if (!spring.rigid) continue;
    spring.difference = spring.ends.sum(at.x);
    spring.derivative = -stiffness;
    spring.force = force_of(spring, at);
  }
}

void AttachmentSprings::append_elements(std::vector<LinearElement>& elements) const {
  for (std::size_t a = 0; a < network_.attachments.size(); ++a) {
    if (!network_.attachments[a].is_rigid()) append_elements(a, elements);
  }
}

// (u - sum w_i u_i)^2 <= sum w_i (u - u_i)^2, as the weights are not negative and add up to 1.
void AttachmentSprings::append_elements(std::size_t attachment, std::vector<LinearElement>& elements) const {
  const Attachment& of = network_.attachments[attachment];
  const double stiffness = of.stiffness.value_or(0.0);
  const double largest = largest_inverse_mass(network_, of.second);
  for (const Index particle : of.particles) {
    const Link link = link_to_body(network_, network_.positions, attachment, particle);
    if (link.second[0] == kNone) elements.push_back(LinearElement::anchor(particle, stiffness, of.damping));
    for (std::size_t k = 0; k < link.second.size() && link.second[k] != kNone; ++k) {
      const double own = network_.inverse_masses[particle];
      const double there = own + network_.inverse_masses[link.second[k]];
      double weight = link.weights[static_cast<Eigen::Index>(k)];
      if (of.from > 0.0 && there > 0.0) weight *= (own + largest) / there;
      elements.push_back(LinearElement::pair(particle, link.second[k], weight * stiffness, weight * of.damping));
    }
  }
}

void AttachmentSprings::note_solution(const Points& positions) {
  for (Spring& spring : springs_) {
    if (spring.rigid) spring.force += spring.derivative * (spring.ends.sum(positions) - spring.difference);
  }
}

double AttachmentSprings::energy(const Points& positions) const {
  double energy = 0.0;
  for (const Spring& spring : springs_) {
    if (spring.rigid) continue;
    const double stretch = (spring.ends.sum(positions) - spring.ends.anchor(time_)).norm() - spring.link.length;
    energy += 0.5 * spring.stiffness * stretch * stretch;
  }
  return energy;
}

void AttachmentSprings::add_impulses(double dt, std::vector<Link>& links) const {
  for (const Spring& spring : springs_) {
    if (spring.rigid) links[spring.number].impulse += dt * spring.force;
  }
}

}  // namespace sprung
