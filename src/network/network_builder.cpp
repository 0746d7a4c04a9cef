#include "network/network_builder.h"

#include "network/damping_ratio.h"
#include "network/model/activity.h"
#include "network/network_check.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>
#include <utility>

namespace sprung {
namespace {

void append_spring(Springs& springs, const Springs& from, std::size_t s, Index offset) {
  springs.append(from.first[s] + offset, from.second[s] + offset, from.rest_length[s], from.stiffness[s], from.damping[s],
                 from.kind[s], from.law(static_cast<Index>(s)));
}

// Appends the springs of a body, sorted by (second - first, first). Springs between the same two particles keep their order.
void append_sorted(Springs& springs, const Springs& body, Index offset) {
  std::vector<std::pair<std::uint64_t, std::size_t>> order;
  order.reserve(body.first.size());
  for (std::size_t s = 0; s < body.first.size(); ++s) {
    const Index lower = std::min(body.first[s], body.second[s]);
    const auto apart = static_cast<std::uint64_t>(std::max(body.first[s], body.second[s]) - lower);
    order.emplace_back(apart << 32U | static_cast<std::uint64_t>(lower), s);
  }
  std::sort(order.begin(), order.end());
  for (const auto& entry : order) append_spring(springs, body, entry.second, offset);
}

void append_angle_bends(AngleBends& bends, const AngleBends& body, Index offset) {
  for (std::size_t a = 0; a < body.middle.size(); ++a) {
    bends.append({body.before[a] + offset, body.middle[a] + offset, body.after[a] + offset},
                 {body.length_before[a], body.length_after[a]}, body.stiffness[a], body.damping[a]);
  }
}

void append_face_bends(SpringNetwork& network, const BodyShape& body, Index offset) {
  const Index first_hinge = network.hinges.count();
  for (std::size_t h = 0; h < body.hinges.particles.size(); ++h) {
    std::array<Index, 4> particles = body.hinges.particles[h];
    for (Index& particle : particles) particle += offset;
    network.hinges.particles.push_back(particles);
    network.hinges.rest_angle.push_back(body.hinges.rest_angle[h]);
    network.hinges.rest_area.push_back(body.hinges.rest_area[h]);
    network.hinges.weights.push_back(body.hinges.weights[h]);
  }
  const FaceBends& bends = body.face_bends;
  for (std::size_t f = 0; f < bends.hinges.size(); ++f) {
    std::array<Index, 3> hinges = bends.hinges[f];
    for (Index& hinge : hinges) hinge = hinge == kNone ? kNone : hinge + first_hinge;
    network.face_bends.hinges.push_back(hinges);
    network.face_bends.curvature.push_back(bends.curvature[f]);
    network.face_bends.stiffness.push_back(bends.stiffness[f]);
    network.face_bends.damping.push_back(bends.damping[f]);
  }
}

void copy_particles(const BodyShape& shape, Index begin, SpringNetwork& network) {
  for (std::size_t i = 0; i < shape.positions.size(); ++i) {
    const Eigen::Index particle = begin + static_cast<Eigen::Index>(i);
    network.positions.col(particle) = shape.positions[i];
    network.velocities.col(particle) = shape.velocities[i];
    network.masses[particle] = shape.masses[i];
    network.drag_areas[particle] = shape.drag_areas[i];
  }
}

SpringNetwork network_of_size(Index particles) {
  SpringNetwork network;
  network.positions.resize(3, particles);
  network.velocities.resize(3, particles);
  network.masses.resize(particles);
  network.drag_areas.resize(particles);
  return network;
}

void require_unique(const std::string& key, const std::string& name, std::map<std::string, int>& seen, ProblemList& problems) {
  if (name.empty()) problems.add(key, "\"\"", "must have a name", "name the body");
  if (++seen[name] != 2) return;
  problems.add(key, "", "must be the only body of this name",
               "give each body its own name; particles added after a whole body begin a new body, which begin_body names");
}

/// Gives a name to entries without one.
template <class T>
std::vector<T> named(std::vector<T> entries, const std::string& key) {
  for (std::size_t k = 0; k < entries.size(); ++k) {
    if (entries[k].name.empty()) entries[k].name = entry_key(key, k);
  }
  return entries;
}

}  // namespace

Index NetworkBuilder::add_particle(const Vector3& position, double mass, const Vector3& velocity) {
  BodyShape& shape = open_draft().shape;
  shape.positions.push_back(position);
  shape.velocities.push_back(velocity);
  shape.masses.push_back(mass);
  shape.drag_areas.push_back(1.0);
  return particle_count_++;
}

void NetworkBuilder::add_spring(Index i, Index j, double stiffness, double rest_length, double damping, SpringKind kind,
                                const SpringLaw& law) {
  springs_.append(i, j, rest_length, stiffness, damping, kind, law);
}

void NetworkBuilder::add_angle_bend(Index before, Index middle, Index after, double stiffness, double damping) {
  angle_bends_.append({before, middle, after}, {0.0, 0.0}, stiffness, damping);
}

void NetworkBuilder::begin_body(const std::string& name, const ContactMaterial& material, const BodyContact& contact) {
  drafts_.push_back({name, {}, material, contact, particle_count_, false});
}

Index NetworkBuilder::add_body(const std::string& name, const BodyShape& shape, const ContactMaterial& material,
                               const BodyContact& contact) {
  drafts_.push_back({name, shape, material, contact, particle_count_, true});
  particle_count_ += static_cast<Index>(shape.positions.size());
  return drafts_.back().first_particle;
}

void NetworkBuilder::pin(Index particle, const Motion& motion, const Vector3& origin) {
  pin(std::vector<Index>{particle}, motion, origin);
}

void NetworkBuilder::pin(std::vector<Index> particles, const Motion& motion, const Vector3& origin) {
  pins_.push_back({std::move(particles), origin, motion});
}

void NetworkBuilder::add_pin(Pin pin) { pins_.push_back(std::move(pin)); }

void NetworkBuilder::add_attachment(Attachment attachment) { attachments_.push_back(std::move(attachment)); }

NetworkBuilder::Draft& NetworkBuilder::open_draft() {
  if (drafts_.empty() || drafts_.back().whole) begin_body("network");
  return drafts_.back();
}

std::vector<NetworkBuilder::Draft> NetworkBuilder::complete_drafts(ProblemList& problems) const {
  std::vector<Draft> drafts = drafts_;
  for (std::size_t s = 0; s < springs_.first.size(); ++s) {
    const Index first = springs_.first[s];
    const Index second = springs_.second[s];
    const auto owner = std::find_if(drafts.begin(), drafts.end(),
                                    [&](const Draft& draft) { return contains(draft, first) && contains(draft, second); });
    if (owner != drafts.end()) {
      append_spring(owner->shape.springs, springs_, s, -owner->first_particle);
    } else {
      problems.add(entry_key("springs", s), "joins " + std::to_string(first) + " and " + std::to_string(second),
                   "must join two particles of one body", "use numbers that add_particle returned for the same body");
    }
  }
  complete_angle_bends(drafts, problems);
  return drafts;
}

void NetworkBuilder::complete_angle_bends(std::vector<Draft>& drafts, ProblemList& problems) const {
  for (std::size_t a = 0; a < angle_bends_.middle.size(); ++a) {
    const std::array<Index, 3> ends{angle_bends_.before[a], angle_bends_.middle[a], angle_bends_.after[a]};
    const auto owner = std::find_if(drafts.begin(), drafts.end(), [&](const Draft& draft) {
      return std::all_of(ends.begin(), ends.end(), [&](Index particle) { return contains(draft, particle); });
    });
    if (owner == drafts.end()) {
      problems.add(entry_key("angle_bends", a), counts_text(ends), "must join three particles of one body",
                   "use numbers that add_particle returned for the same body");
      continue;
    }
    const Index offset = owner->first_particle;
    const auto at = [&](Index particle) -> const Vector3& { return owner->shape.positions[particle - offset]; };
    owner->shape.angle_bends.append({ends[0] - offset, ends[1] - offset, ends[2] - offset},
                                    {(at(ends[1]) - at(ends[0])).norm(), (at(ends[2]) - at(ends[1])).norm()},
                                    angle_bends_.stiffness[a], angle_bends_.damping[a]);
  }
}

bool NetworkBuilder::contains(const Draft& draft, Index particle) {
  return particle >= draft.first_particle && particle - draft.first_particle < static_cast<Index>(draft.shape.positions.size());
}

SpringNetwork NetworkBuilder::build() const {
  ProblemList problems;
  if (particle_count_ == 0) problems.add("particles", "0", "must be at least 1", "add a particle or a body");
  const std::vector<Draft> drafts = complete_drafts(problems);
  std::map<std::string, int> names;
  std::vector<Index> begins;
  for (const Draft& draft : drafts) {
    begins.push_back(draft.first_particle);
    require_unique("bodies." + draft.name, draft.name, names, problems);
    check_body("bodies." + draft.name, draft.shape, draft.material, problems);
  }
  check_pins(pins_, particle_count_, problems);
  check_attachments(attachments_, particle_count_, begins, problems);
  std::vector<Pin> pins = named(pins_, "pins");
  std::vector<Attachment> attachments = named(attachments_, "attachments");
  check_names(pins, attachments, problems);
  problems.throw_if_any();

  SpringNetwork network = network_of_size(particle_count_);
  for (const Draft& draft : drafts) {
    copy_particles(draft.shape, draft.first_particle, network);
    const Index first_spring = network.springs.count();
    append_sorted(network.springs, draft.shape.springs, draft.first_particle);
    const Index first_bend = network.angle_bends.count();
    append_angle_bends(network.angle_bends, draft.shape.angle_bends, draft.first_particle);
    const Index first_face_bend = network.face_bends.count();
    append_face_bends(network, draft.shape, draft.first_particle);
    network.bodies.push_back({draft.name,
                              draft.first_particle,
                              static_cast<Index>(draft.shape.positions.size()),
                              first_spring,
                              network.springs.count() - first_spring,
                              first_bend,
                              network.angle_bends.count() - first_bend,
                              first_face_bend,
                              network.face_bends.count() - first_face_bend,
                              draft.shape.dimension,
                              draft.shape.measure,
                              draft.shape.resolution,
                              draft.shape.surface,
                              draft.material,
                              draft.contact,
                              draft.shape.stretch_limited,
                              draft.shape.cells,
                              draft.shape.carried,
                              draft.shape.contact_only,
                              draft.shape.preserve_volume,
                              draft.shape.volume_factor,
                              draft.shape.pressure,
                              draft.shape.has_material_dampers,
                              draft.shape.drag});
  }
  network.inverse_masses = network.masses.cwiseInverse();
  network.pins = std::move(pins);
  set_activity(first_activity(network), network);
  for (Index i = 0; i < network.particle_count(); ++i) {
    if (network.activity.is_pinned(i)) network.velocities.col(i).setZero();
  }
  network.attachments = std::move(attachments);
  for (std::size_t b = 0; b < drafts.size(); ++b) damp_by_ratio(drafts[b].shape.damping_ratios, network.bodies[b], network);
  return network;
}

}  // namespace sprung
