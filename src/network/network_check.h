// The rules for bodies, springs, pins and attachments of a network: of NetworkBuilder, and of one that a simulator takes.
#pragma once

#include "base/problem_list.h"
#include "network/bodies/body_shape.h"
#include "network/model/spring_network.h"

#include <string>
#include <vector>

namespace sprung {

/// Adds the problems of particles, springs and material of a body. `key` is the prefix of the keys, such as `bodies.rope`. If many
/// entries break the same rule, names the first one and counts the others.
void check_body(const std::string& key, const BodyShape& shape, const ContactMaterial& material, ProblemList& problems);

/// Adds the problems of the pins of a network with this number of particles.
void check_pins(const std::vector<Pin>& pins, Index particle_count, ProblemList& problems);

/// Adds the problems of the attachments of a network with this number of particles, whose bodies begin at `body_begins`.
void check_attachments(const std::vector<Attachment>& attachments, Index particle_count, const std::vector<Index>& body_begins,
                       ProblemList& problems);

/// Adds the problem of pins and attachments that share a name. Requires that all have one.
void check_names(const std::vector<Pin>& pins, const std::vector<Attachment>& attachments, ProblemList& problems);

}  // namespace sprung
