#include "network/network_check.h"

#include "base/format.h"
#include "geometry/motion/motion_check.h"
#include "network/model/activity.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

namespace sprung {
namespace {

bool is_quantity(double value) { return value >= 0.0 && std::isfinite(value); }

void require_quantities(const std::vector<double>& values, const EntryRule& rule, ProblemList& problems) {
  problems.require_each(
      values.size(), [&](std::size_t i) { return is_quantity(values[i]); }, [&](std::size_t i) { return format_number(values[i]); },
      rule);
}

void require_finite(const std::vector<Vector3>& vectors, const EntryRule& rule, ProblemList& problems) {
  problems.require_each(
      vectors.size(), [&](std::size_t i) { return vectors[i].allFinite(); }, [&](std::size_t i) { return vector_text(vectors[i]); },
      rule);
}

void check_particles(const std::string& key, const BodyShape& shape, ProblemList& problems) {
  require_finite(shape.positions, {key + ".positions", "must be finite", "give three numbers in m"}, problems);
  require_finite(shape.velocities, {key + ".velocities", "must be finite", "give three numbers in m/s"}, problems);
  problems.require_each(
      shape.masses.size(), [&](std::size_t i) { return shape.masses[i] > 0.0 && std::isfinite(shape.masses[i]); },
      [&](std::size_t i) { return format_number(shape.masses[i]); },
      EntryRule{key + ".masses", "must be a finite number greater than 0",
                "give a mass in kg, and pin particles that must not move"});
  require_quantities(shape.drag_areas, {key + ".drag_areas", "must be a finite number not less than 0", "use 0 for no air drag"},
                     problems);
}

void check_springs(const std::string& key, const BodyShape& shape, ProblemList& problems) {
  const Springs& springs = shape.springs;
  const auto count = static_cast<std::size_t>(springs.count());
  const auto text = [&](std::size_t s) {
    return "joins " + std::to_string(springs.first[s]) + " and " + std::to_string(springs.second[s]);
  };
  const auto exists = [&](Index particle) { return particle >= 0 && static_cast<std::size_t>(particle) < shape.positions.size(); };
  problems.require_each(
      count, [&](std::size_t s) { return exists(springs.first[s]) && exists(springs.second[s]); }, text,
      EntryRule{key + ".springs", "must join particles of the body, which has " + std::to_string(shape.positions.size()),
                "use the numbers of the body's particles, counted from 0"});
  problems.require_each(
      count, [&](std::size_t s) { return springs.first[s] != springs.second[s]; }, text,
      EntryRule{key + ".springs", "must join two different particles", "leave the spring out"});
  const std::string rule = "must be a finite number not less than 0";
  require_quantities(springs.rest_length, {key + ".springs.rest_length", rule, "give a length in m"}, problems);
  require_quantities(springs.stiffness, {key + ".springs.stiffness", rule, "give k_s in N/m"}, problems);
  require_quantities(springs.damping, {key + ".springs.damping", rule, "give k_d in N s/m"}, problems);
  problems.require_each(
      springs.laws.size(), [&](std::size_t s) { return springs.laws[s].yield > 0.0; },
      [&](std::size_t s) { return format_number(springs.laws[s].yield); },
      EntryRule{key + ".springs.yield", "must be greater than 0", "leave it out for springs that do not yield"});
  problems.require_each(
      springs.laws.size(), [&](std::size_t s) { return springs.laws[s].break_length > 0.0; },
      [&](std::size_t s) { return format_number(springs.laws[s].break_length); },
      EntryRule{key + ".springs.break", "must be greater than 0", "leave it out for springs that do not break"});
}

/// Tearing makes no new faces inside a solid, and a torn mesh encloses no volume.
void check_breaks(const std::string& key, const BodyShape& shape, ProblemList& problems) {
  if (std::ranges::none_of(shape.springs.laws, &SpringLaw::breaks)) return;
  if (!shape.cells.empty()) {
    problems.add(key + ".springs.break", "", "needs a body without cells: a torn solid would need new faces inside",
                 "leave it out, or use a rope, a cloth or a mesh");
  }
  if (shape.volume_factor != 0.0 || shape.pressure != 0.0) {
    problems.add(key + ".springs.break", "", "needs a body without pressure and volume_factor, as a torn one encloses no volume",
                 "leave one of them out");
  }
}

/// A program may have filled the shape itself.
void check_face_bends(const std::string& key, const BodyShape& shape, ProblemList& problems) {
  const Hinges& hinges = shape.hinges;
  problems.require_each(
      hinges.particles.size(),
      [&](std::size_t h) {
        return std::ranges::all_of(hinges.particles[h], [&](Index particle) {
          return particle >= 0 && static_cast<std::size_t>(particle) < shape.positions.size();
        });
      },
      [&](std::size_t h) { return counts_text(hinges.particles[h]); },
      EntryRule{key + ".hinges", "must join particles of the body, which has " + std::to_string(shape.positions.size()),
                "use the numbers of the body's particles, counted from 0"});
  problems.require_each(
      hinges.particles.size(),
      [&](std::size_t h) {
        std::array<Index, 4> particles = hinges.particles[h];
        std::ranges::sort(particles);
        return std::ranges::adjacent_find(particles) == particles.end();
      },
      [&](std::size_t h) { return counts_text(hinges.particles[h]); },
      EntryRule{key + ".hinges", "must join four different particles", "leave the hinge out"});
  problems.require_each(
      hinges.rest_area.size(), [&](std::size_t h) { return std::ranges::min(hinges.rest_area[h]) > 0.0; },
      [&](std::size_t h) { return format_number(std::ranges::min(hinges.rest_area[h])); },
      EntryRule{key + ".hinges.rest_area", "must be greater than 0", "leave out hinges of triangles without an area"});
  const FaceBends& bends = shape.face_bends;
  problems.require_each(
      bends.hinges.size(),
      [&](std::size_t f) { return std::ranges::any_of(bends.hinges[f], [](Index hinge) { return hinge != kNone; }); },
      [&](std::size_t f) { return counts_text(bends.hinges[f]); },
      EntryRule{key + ".face_bends.hinges", "must name at least one hinge", "leave the element out"});
  problems.require_each(
      bends.hinges.size(),
      [&](std::size_t f) {
        return std::ranges::all_of(bends.hinges[f],
                                   [&](Index hinge) { return hinge == kNone || (hinge >= 0 && hinge < hinges.count()); });
      },
      [&](std::size_t f) { return counts_text(bends.hinges[f]); },
      EntryRule{key + ".face_bends.hinges", "must name hinges of the body, which has " + std::to_string(hinges.count()),
                "use the numbers of its hinges, counted from 0"});
  std::vector<int> elements_of(hinges.particles.size(), 0);
  for (const std::array<Index, 3>& sides : bends.hinges) {
    for (const Index hinge : sides) {
      if (hinge >= 0 && hinge < hinges.count()) ++elements_of[hinge];
    }
  }
  problems.require_each(
      elements_of.size(), [&](std::size_t h) { return elements_of[h] <= 2; },
      [&](std::size_t h) { return std::to_string(elements_of[h]) + " elements"; },
      EntryRule{key + ".hinges", "must belong to at most two elements", "add a hinge for each pair of triangles"});
  const std::string rule = "must be a finite number not less than 0";
  require_quantities(bends.stiffness, {key + ".face_bends.stiffness", rule, "give k in N m"}, problems);
  require_quantities(bends.damping, {key + ".face_bends.damping", rule, "give a damping in N m s"}, problems);
}

void check_angle_bends(const std::string& key, const BodyShape& shape, ProblemList& problems) {
  const AngleBends& bends = shape.angle_bends;
  const auto ends = [&](std::size_t a) { return std::array<Index, 3>{bends.before[a], bends.middle[a], bends.after[a]}; };
  const auto text = [&](std::size_t a) { return "joins " + counts_text(ends(a)); };
  const auto exists = [&](Index particle) { return particle >= 0 && static_cast<std::size_t>(particle) < shape.positions.size(); };
  problems.require_each(
      bends.middle.size(),
      [&](std::size_t a) {
        const auto [before, middle, after] = ends(a);
        return exists(before) && exists(middle) && exists(after) && before != middle && middle != after && after != before;
      },
      text,
      EntryRule{key + ".angle_bends", "must join three particles of the body, which has " + std::to_string(shape.positions.size()),
                "use the numbers of the body's particles, counted from 0"});
  const auto has_length = [](double length) { return length > 0.0 && std::isfinite(length); };
  problems.require_each(
      bends.middle.size(), [&](std::size_t a) { return has_length(bends.length_before[a]) && has_length(bends.length_after[a]); },
      text,
      EntryRule{key + ".angle_bends.length", "must be a finite number greater than 0, because an angle needs bonds with a length",
                "move the particles apart"});
  const std::string rule = "must be a finite number not less than 0";
  require_quantities(bends.stiffness, {key + ".angle_bends.stiffness", rule, "give k in N m"}, problems);
  require_quantities(bends.damping, {key + ".angle_bends.damping", rule, "give a damping in N m s"}, problems);
}

template <class Cell>
void check_cells(const std::string& key, const std::vector<Cell>& cells, const Points& positions, ProblemList& problems) {
  const auto exist = [&](const Cell& cell) {
    return std::ranges::all_of(cell, [&](Index particle) { return particle >= 0 && particle < positions.cols(); });
  };
  const auto text = [&](std::size_t c) { return counts_text(cells[c]); };
  problems.require_each(
      cells.size(), [&](std::size_t c) { return exist(cells[c]); }, text,
      EntryRule{key, "must join particles of the body, which has " + std::to_string(positions.cols()),
                "use the numbers of the body's particles, counted from 0"});
  problems.require_each(
      cells.size(), [&](std::size_t c) { return !exist(cells[c]) || !is_inverted(cells[c], positions); }, text,
      EntryRule{key, "must have a positive volume", "order its corners as network/model/cells.h says, and repair the mesh"});
}

void check_drag(const std::string& key, const BodyDrag& drag, ProblemList& problems) {
  const auto require = [&](const char* name, double value) {
    if (is_quantity(value)) return;
    problems.add(key + ".drag." + name, format_number(value), "must be a finite number not less than 0", "use 0 for no air drag");
  };
  require("normal", drag.normal);
  require("tangential", drag.tangential);
  require("line_diameter", drag.line_diameter);
}

template <class Elements>
bool names_particles(const Elements& elements, std::size_t particles) {
  return elements.size() == 0 || (elements.minCoeff() >= 0 && static_cast<std::size_t>(elements.maxCoeff()) < particles);
}

void check_surface(const std::string& key, const BodyShape& shape, ProblemList& problems) {
  const std::size_t particles = shape.positions.size();
  if (names_particles(shape.surface.triangles, particles) && names_particles(shape.surface.segments, particles)) return;
  problems.add(key + ".surface", "", "must name particles of the body, which has " + std::to_string(particles),
               "use the numbers of the body's particles, counted from 0");
}

bool same_sizes(const AngleBends& bends) {
  const std::size_t count = bends.middle.size();
  return bends.before.size() == count && bends.after.size() == count && bends.length_before.size() == count &&
         bends.length_after.size() == count && bends.stiffness.size() == count && bends.damping.size() == count;
}

bool same_sizes(const Hinges& hinges, const FaceBends& bends) {
  const std::size_t hinge_count = hinges.particles.size();
  const std::size_t count = bends.hinges.size();
  return hinges.rest_angle.size() == hinge_count && hinges.rest_area.size() == hinge_count &&
         hinges.weights.size() == hinge_count && bends.curvature.size() == count && bends.stiffness.size() == count &&
         bends.damping.size() == count;
}

bool same_sizes(const BodyShape& shape) {
  const Springs& springs = shape.springs;
  const std::size_t particles = shape.positions.size();
  const auto count = static_cast<std::size_t>(springs.count());
  return shape.velocities.size() == particles && shape.masses.size() == particles && shape.drag_areas.size() == particles &&
         springs.second.size() == count && springs.rest_length.size() == count && springs.stiffness.size() == count &&
         springs.damping.size() == count && springs.kind.size() == count &&
         (springs.laws.empty() || springs.laws.size() == count) && same_sizes(shape.angle_bends) &&
         same_sizes(shape.hinges, shape.face_bends);
}

/// Of a pin or an attachment.
void check_times(const std::string& key, double from, double until, ProblemList& problems) {
  if (!std::isfinite(from) || from < 0.0)
    problems.add(key + ".from", format_number(from), "must be finite and not negative", "give a time in s");
  if (!(until > from))
    problems.add(key + ".until", format_number(until), "must be later than from, " + format_number(from) + " s",
                 "from is when it begins, until when it ends");
}

/// The rules of the ends of one attachment.
class EndCheck {
 public:
  EndCheck(std::string key, const Attachment& attachment, Index particle_count, const std::vector<Index>& body_begins,
           ProblemList& problems)
      : key_(std::move(key)),
        attachment_(attachment),
        particle_count_(particle_count),
        body_begins_(body_begins),
        problems_(problems) {}

  void check() {
    check_particles(attachment_.particles, ".first");
    std::visit([&](const auto& second) { check_second(second); }, attachment_.second);
  }

 private:
  void check_particles(const std::vector<Index>& particles, const char* end) {
    if (particles.empty())
      problems_.add(key_ + end, "", "must contain at least one particle", "name a particle or leave the attachment out");
    for (const Index particle : particles) {
      if (particle >= 0 && particle < particle_count_) continue;
      problems_.add(key_ + end, "particle " + std::to_string(particle),
                    "must be a particle of the network, which has " + std::to_string(particle_count_),
                    "use a number that add_particle or add_body returned");
    }
  }

  void check_second(const ParticleEnds& ends) {
    check_particles(ends.particles, ".second");
    for (const Index particle : attachment_.particles) {
      if (std::ranges::find(ends.particles, particle) == ends.particles.end()) continue;
      problems_.add(key_, "particle " + std::to_string(particle), "must have two different ends",
                    "leave the particle out of one of them");
      return;
    }
  }

  void check_second(const SurfaceEnd& end) {
    const std::size_t bodies = body_begins_.size();
    if (end.body < 0 || static_cast<std::size_t>(end.body) >= bodies) {
      problems_.add(key_ + ".second.body", std::to_string(end.body),
                    "must be the number of a body; there are " + std::to_string(bodies), "count bodies from 0");
      return;
    }
    const auto next = body_begins_.begin() + end.body + 1;
    const Index last = next != body_begins_.end() ? *next : particle_count_;
    const auto is_own = [&](Index particle) { return particle >= *(next - 1) && particle < last; };
    if (std::ranges::any_of(attachment_.particles, is_own))
      problems_.add(key_ + ".second.body", std::to_string(end.body), "must be another body than that of the first ends",
                    "name the particles at the second end");
  }

  void check_second(const ObstacleEnd& /*end*/) {}  // the network does not know the obstacles

  std::string key_;
  const Attachment& attachment_;
  Index particle_count_;
  const std::vector<Index>& body_begins_;
  ProblemList& problems_;
};

}  // namespace

void check_body(const std::string& key, const BodyShape& shape, const ContactMaterial& material, ProblemList& problems) {
  if (shape.positions.empty())
    problems.add(key, "0 particles", "must have at least one particle", "add a particle or leave the body out");
  if (!same_sizes(shape)) {
    problems.add(
        key, "",
        "must have one velocity, mass and drag area per particle, and one entry per spring and angle bend in each of their arrays",
        "make the shape with make_rope, make_cloth, make_solid or make_mesh_body");
    return;
  }
  check_particles(key, shape, problems);
  check_springs(key, shape, problems);
  check_breaks(key, shape, problems);
  check_angle_bends(key, shape, problems);
  check_face_bends(key, shape, problems);
  check_surface(key, shape, problems);
  check_drag(key, shape.drag, problems);
  Points positions(3, static_cast<Index>(shape.positions.size()));
  for (Index i = 0; i < positions.cols(); ++i) positions.col(i) = shape.positions[i];
  check_cells(key + ".cells.hexahedra", shape.cells.hexahedra, positions, problems);
  check_cells(key + ".cells.tetrahedra", shape.cells.tetrahedra, positions, problems);
  check_material(key, material, problems);
}

void check_pins(const std::vector<Pin>& pins, Index particle_count, ProblemList& problems) {
  std::map<Index, std::vector<const Pin*>> pins_of;  // by particle
  for (std::size_t p = 0; p < pins.size(); ++p) {
    const Pin& pin = pins[p];
    const std::string key = entry_key("pins", p);
    if (pin.particles.empty()) problems.add(key, "", "must contain at least one particle", "name a particle or leave the pin out");
    if (!pin.origin.allFinite()) problems.add(key + ".origin", vector_text(pin.origin), "must be finite", "give a point in m");
    check_motion(key + ".motion", pin.motion, problems);
    check_times(key, pin.from, pin.until, problems);
    for (const Index particle : pin.particles) {
      if (particle < 0 || particle >= particle_count) {
        problems.add(key, "particle " + std::to_string(particle),
                     "must be a particle of the network, which has " + std::to_string(particle_count),
                     "use a number that add_particle or add_body returned");
        continue;
      }
      std::vector<const Pin*>& others = pins_of[particle];
      if (std::ranges::any_of(others, [&](const Pin* other) { return hold_together(*other, pin); }))
        problems.add(key, "particle " + std::to_string(particle), "must be pinned only once", "leave it out of one of its pins");
      others.push_back(&pin);
    }
  }
}

void check_attachments(const std::vector<Attachment>& attachments, Index particle_count, const std::vector<Index>& body_begins,
                       ProblemList& problems) {
  for (std::size_t a = 0; a < attachments.size(); ++a) {
    const Attachment& attachment = attachments[a];
    const std::string key = entry_key("attachments", a);
    EndCheck(key, attachment, particle_count, body_begins, problems).check();
    if (attachment.stiffness) problems.require_not_negative(key + ".stiffness", *attachment.stiffness, "give k_s in N/m");
    problems.require_not_negative(key + ".damping", attachment.damping, "give k_d in N s/m");
    if (attachment.rest_length) problems.require_not_negative(key + ".rest_length", *attachment.rest_length, "give a length in m");
    if (!(attachment.break_force > 0.0))
      problems.add(key + ".break_force", format_number(attachment.break_force), "must be greater than 0", "give a force in N");
    check_times(key, attachment.from, attachment.until, problems);
  }
}

void check_names(const std::vector<Pin>& pins, const std::vector<Attachment>& attachments, ProblemList& problems) {
  std::set<std::string> seen;
  const auto check = [&](const std::string& key, const std::string& name) {
    if (seen.insert(name).second) return;
    problems.add(key + ".name", name, "must be the only pin or attachment of this name, under which its force is reported",
                 "give each of them its own name");
  };
  for (std::size_t p = 0; p < pins.size(); ++p) check(entry_key("pins", p), pins[p].name);
  for (std::size_t a = 0; a < attachments.size(); ++a) check(entry_key("attachments", a), attachments[a].name);
}

}  // namespace sprung
