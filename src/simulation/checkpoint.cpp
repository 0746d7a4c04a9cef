#include "simulation/checkpoint.h"

#include "base/error.h"
#include "base/files/file_writer.h"
#include "base/files/fingerprint.h"
#include "base/files/sealed_file.h"
#include "dynamics/state/state_members.h"
#include "network/model/spring_network.h"
#include "simulation/model.h"

#include <algorithm>

namespace sprung {
namespace {

// Raise the number of the format when the members of a state, or of what runs add, change.
constexpr Seal kSeal{.kind = "sprungck", .what = "a checkpoint of sprung", .version = SPRUNG_VERSION " (format 3)"};

std::string text_of(const NamedCount& body) {
  return std::to_string(body.particles) + " particles and " + std::to_string(body.springs) + " springs";
}

}  // namespace

template <Same<NamedCount> S, class Visit>
void visit_members(S& n, const Visit& visit) {
  visit(n.name, n.particles, n.springs, n.spring_ends);
}
template <Same<Checkpoint> S, class Visit>
void visit_members(S& c, const Visit& visit) {
  visit(c.bodies, c.obstacles, c.state, c.caches, c.model, c.run);
}

std::uint64_t fingerprint_of_springs(const std::vector<Index>& ends) { return fingerprint_of(to_bytes(ends)); }

std::vector<NamedCount> bodies_of(const SpringNetwork& network) {
  std::vector<NamedCount> bodies;
  for (const Body& body : network.bodies) {
    std::vector<Index> ends;
    for (Index s = body.first_spring; s < body.first_spring + body.spring_count; ++s) {
      ends.push_back(network.springs.first[s] - body.first_particle);
      ends.push_back(network.springs.second[s] - body.first_particle);
    }
    bodies.push_back({body.name, body.particle_count, body.spring_count, fingerprint_of_springs(ends)});
  }
  return bodies;
}

std::uint64_t fingerprint_of_shape(const Obstacle& obstacle) {
  Fingerprint fingerprint;
  if (const auto* mesh = std::get_if<MeshGeometry>(&obstacle.geometry)) {
    fingerprint.add(to_bytes(mesh->mesh->vertices));
    fingerprint.add(to_bytes(mesh->mesh->triangles));
    return fingerprint.value();
  }
  if (const auto* deforming = std::get_if<SequenceGeometry>(&obstacle.geometry)) {
    fingerprint.add(to_bytes(deforming->sequence->frames));
    fingerprint.add(to_bytes(deforming->sequence->triangles));
    return fingerprint.value();
  }
  return 0;
}

std::uint64_t fingerprint_of(const Model& model) {
  const SpringNetwork& network = model.network();
  Fingerprint fingerprint;
  fingerprint.add(to_bytes(network.positions));
  fingerprint.add(to_bytes(network.masses));
  fingerprint.add(to_bytes(network.springs.first));
  fingerprint.add(to_bytes(network.springs.second));
  fingerprint.add(to_bytes(network.springs.rest_length));
  for (const Body& body : network.bodies) {
    fingerprint.add(to_bytes(body.surface.triangles));
    fingerprint.add(to_bytes(body.surface.segments));
  }
  for (const Obstacle& obstacle : model.obstacles().obstacles()) {
    fingerprint.add(to_bytes(obstacle.geometry.index()));
    fingerprint.add(to_bytes(fingerprint_of_shape(obstacle)));
  }
  return fingerprint.value();
}

void write_checkpoint(const std::filesystem::path& file, const Checkpoint& checkpoint) {
  write_file(file, sealed(kSeal, to_bytes(checkpoint)), Durability::now);
}

Checkpoint read_checkpoint(const std::filesystem::path& file, std::string_view remedy) {
  Seal seal = kSeal;
  seal.remedy = remedy;
  const std::string bytes = read_sealed(file, seal);
  Checkpoint checkpoint;
  try {
    from_bytes(bytes, checkpoint);
  } catch (const BytesError&) {
    throw FileError("read", file.string(), "it is damaged");
  }
  return checkpoint;
}

std::vector<std::string> differences(const std::vector<NamedCount>& bodies, const std::vector<NamedCount>& others) {
  std::vector<std::string> texts;
  for (const NamedCount& body : bodies) {
    const auto other = std::ranges::find(others, body.name, &NamedCount::name);
    if (other == others.end()) {
      texts.push_back("body \"" + body.name + "\" is missing");
    } else if (other->particles != body.particles || other->springs != body.springs) {
      texts.push_back("body \"" + body.name + "\" has " + text_of(*other) + ", not " + text_of(body));
    } else if (other->spring_ends != body.spring_ends && other->spring_ends != 0 && body.spring_ends != 0) {
      texts.push_back("body \"" + body.name + "\" has springs between other particles");
    }
  }
  for (const NamedCount& other : others) {
    if (std::ranges::find(bodies, other.name, &NamedCount::name) == bodies.end())
      texts.push_back("body \"" + other.name + "\" is new");
  }
  return texts;
}

}  // namespace sprung
