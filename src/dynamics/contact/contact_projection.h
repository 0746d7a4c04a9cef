// Contact by projection: detects the contacts of a step, solves them for positions and velocities, and truncates the step.
#pragma once

#include "collision/obstacles/obstacle_frame.h"
#include "collision/truncation/step_truncation.h"
#include "dynamics/contact/contact_solver.h"
#include "dynamics/integrators/integrator.h"
#include "network/model/spring_network.h"

#include <set>
#include <vector>

namespace sprung {

/// Contact passes that a step makes if no stretch limit needs more: a particle in a corner between obstacles settles in them.
inline constexpr int kContactPasses = 8;

/// Contact is settled when a pass changes no push by more than this fraction of the gap.
inline constexpr double kContactTolerance = 1.0e-3;

/// Calls `pass(k)` for k = 0, 1, ... until it returns true (settled), at most `max_passes` times. Returns the number of calls.
template <class Pass>
int repeat_until_settled(int max_passes, const Pass& pass) {
  int passes = 0;
  bool settled = false;
  while (passes < max_passes && !settled) settled = pass(passes++);
  return passes;
}

class ContactProjection {
 public:
  /// Result of push_out().
  struct PushOut {
    int passes = 0;
    double largest = 0.0;  ///< largest change of a push in a pass relative to the gap
    [[nodiscard]] bool moved() const { return largest > 0.0; }
  };

  /// Keeps references to the network and the obstacles. Frames in later calls must be theirs.
  ContactProjection(const SpringNetwork& network, const ObstacleSet& obstacles);

  /// Whether the network can collide with anything: an obstacle, another body, or itself.
  [[nodiscard]] bool can_collide() const { return truncation_.can_collide(); }

  // `frame` has the obstacles in the interval of the step.

  /// Detects the contacts of a step that has one part, and begins it.
  void find(const ObstacleFrame& frame, const StepMotion& motion) {
    detect(frame, motion);
    begin_part(frame, frame, motion, 1.0, 1.0);
  }

  /// Detects the contacts of a step. Call begin_part() next.
  void detect(const ObstacleFrame& frame, const StepMotion& motion);

  /// Begins a part of the step of detect(): `motion` and `part` are those of the part, which ends when `ended` of the step has
  /// passed and takes `share` of it.
  void begin_part(const ObstacleFrame& frame, const ObstacleFrame& part, const StepMotion& motion, double ended, double share);

  /// Detects the contacts near truncated particles again, at the present positions [m]. Call it during the relaxation of
  /// truncate(); requires that the positions lie in their safe regions. Accumulated pushes are kept. `part` is the motion of the
  /// last part, which takes `share` of the step.
  void find_again(const ObstacleFrame& frame, const StepMotion& motion, const StepMotion& part, double share,
                  const Points& positions);

  /// See StepTruncation. The inverse masses of the network have to match.
  void set_motions(ParticleMotions motions) { truncation_.set_motions(std::move(motions)); }

  /// See StepTruncation.
  [[nodiscard]] const PermittedCrossings& permitted_crossings() const { return truncation_.permitted_crossings(); }
  void roll_back(const PermittedCrossings& permitted) { truncation_.roll_back(permitted); }
  void save(ByteWriter& to) const { truncation_.save(to); }
  void load(BinaryReader& from) { truncation_.load(from); }

  /// One pass; see ContactSolver.
  double project(Points& positions) { return solver_.project(positions); }

  /// Makes passes over the contacts until they are settled, at most `max_passes`.
  PushOut push_out(Points& positions, int max_passes = kContactPasses);

  /// See ContactSolver.
  void settle_velocities(const StepMotion& motion, SimulationState& state, const Integrator& integrator) {
    solver_.settle_velocities(motion, state, integrator);
  }
  void note_slip(const StepMotion& motion, SimulationState& state) const { solver_.note_slip(motion, state); }
  void constrain_pushed(const StepMotion& motion, ConstrainedDirections& constrained) const {
    solver_.constrain_pushed(motion, constrained);
  }
  void record(const StepMotion& motion, const ImpulseRecorder& recorder) const { solver_.record(motion, recorder); }
  void add_pushes(const StepMotion& motion, Points& impulses) const { solver_.add_pushes(motion, impulses); }
  void add_settled(Points& impulses) const { solver_.add_settled(impulses); }
  [[nodiscard]] std::vector<Index> pushed() const { return solver_.pushed(); }
  [[nodiscard]] std::vector<ContactNormal> normals() const { return solver_.normals(); }

  /// Clips positions [m] so that no element crosses a surface that it did not cross at the beginning of the step. If two bodies
  /// block each other, the contacts between them are solved first, which conserves momentum. `relax` may then move truncated
  /// particles and their neighbours (see StepTruncation::truncate). `part` is the motion of the last part.
  void truncate(const ObstacleFrame& frame, const StepMotion& motion, const StepMotion& part, Points& positions,
                const StepTruncation::Relax& relax);
  /// The same for a step that has one part.
  void truncate(const ObstacleFrame& frame, const StepMotion& motion, Points& positions, const StepTruncation::Relax& relax = {}) {
    truncate(frame, motion, motion, positions, relax);
  }

  /// Limits the speed of particles that truncation moved with obstacles to the speed that forces gave them: a lever would
  /// otherwise throw a particle far from the axis of a rotating obstacle. Contact accelerates the particles that touch it. Requires
  /// velocities recovered from positions.
  void limit_speed_of_moved(const StepMotion& motion, SimulationState& state, const Integrator& integrator) const;

  /// Particles that the last truncate() stopped, and those for which it found no admissible position.
  [[nodiscard]] Index truncated_count() const { return truncated_; }
  [[nodiscard]] Index infeasible_count() const { return infeasible_; }

 private:
  [[nodiscard]] TruncationResult truncate_bodies(const ObstacleFrame& frame, const StepMotion& motion, const StepMotion& part,
                                                 Points& positions, const StepTruncation::Relax& relax);
  [[nodiscard]] bool add_body_contacts(const std::vector<Contact>& contacts, const StepMotion& motion);

  ContactSolver solver_;
  StepTruncation truncation_;
  const std::vector<Contact>* contacts_ = nullptr;  ///< of the step
  std::set<decltype(Contact::particles)> added_;    ///< stencils of the body contacts that truncation found in this step
  std::vector<Index> moved_with_obstacles_;
  Index truncated_ = 0;
  Index infeasible_ = 0;
};

}  // namespace sprung
