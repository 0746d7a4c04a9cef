// Pushes bodies off the line or plane in which they stand compressed.
//
// Springs and contact have no force across a line or plane that holds a body and its contact normals. A rope that is lowered
// upright, or a cloth that falls on its edge, would stand for ever: an equilibrium, but not a stable one. The push is far below
// anything visible, and the instability makes it grow.
#pragma once

#include "dynamics/integrators/integrator.h"
#include "dynamics/state/simulation_state.h"
#include "network/model/spring_network.h"

#include <array>
#include <cstdint>
#include <vector>

namespace sprung {

class SymmetryBreaker {
 public:
  /// Keeps a reference to the network. The seed determines the directions of all pushes.
  SymmetryBreaker(const SpringNetwork& network, std::uint64_t seed);

  /// Whether any piece may lie in a line or plane. Takes a few operations per piece that does not.
  [[nodiscard]] bool may_push(const Points& positions) const;

  /// Whether a piece stands like a card on its edge: it lies nearly, within a thousandth, in a line or plane together with the
  /// normals of all its contacts. It is slow while it begins to fall over.
  [[nodiscard]] bool has_standing(const std::vector<ContactNormal>& contacts, const Points& positions) const;

  /// Gives a speed to the free particles at compressed springs of each piece that lies in a line or plane together with the normal
  /// of one of its contacts. The speed is across the line or plane, and moves a particle by at most 1e-9 of the piece's mean rest
  /// length in a step of `dt` [s], in which contact acts as on any motion.
  void push(const std::vector<ContactNormal>& contacts, double dt, const Integrator& integrator, SimulationState& state);

 private:
  /// Particles that springs join.
  struct Piece {
    std::vector<Index> particles;
    std::vector<Index> springs;
    std::array<Index, 4> corners;  ///< particles that spanned a volume, if the piece did, when it was last measured
    double mean_length = 0.0;      ///< of its springs at rest [m]
  };

  /// The line or plane that holds a piece.
  struct Flat {
    int dimension = 3;                     ///< 1: a line, 2: a plane; otherwise the piece has none
    Vector3 direction = Vector3::UnitX();  ///< of the line; the plane's normal
    [[nodiscard]] bool contains(const Vector3& unit, double inclination) const;
  };

  [[nodiscard]] static Flat span_of(const std::array<Index, 4>& corners, const Points& positions, double flatness);
  [[nodiscard]] static std::array<Index, 4> spanning_corners(const std::vector<Index>& particles, const Points& positions);
  [[nodiscard]] static Flat measure(Piece& piece, const Points& positions);
  [[nodiscard]] Vector3 direction_across(const Flat& flat, Index particle) const;
  void push(const Piece& piece, const Flat& flat, double dt, const Integrator& integrator, SimulationState& state) const;

  const SpringNetwork& network_;
  std::uint64_t seed_;
  std::vector<Piece> pieces_;
  std::vector<Index> piece_of_;  ///< of each particle; kNone without a spring
};

}  // namespace sprung
