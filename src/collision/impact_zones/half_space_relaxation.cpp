#include "collision/impact_zones/half_space_relaxation.h"

namespace sprung {

namespace {

// Each inequality is checked at most this often.
constexpr int kSweeps = 16;

Index particle(const ContactStencil& pair, int k) { return pair.particles[static_cast<std::size_t>(k)]; }

/// The separation of a pair at one Bernstein coefficient.
template <class Height>
struct Inequality {
  Height height;     ///< coefficient of the pair's particle k [m]
  Vector3 gradient;  ///< direction that raises it
  double gain;       ///< change of the coefficient per displacement of an end along the direction
};
template <class Height>
Inequality(Height, Vector3, double) -> Inequality<Height>;

/// Moves the ends of one pair after another.
class Sweep {
 public:
  Sweep(const Points& before, const ParticleMotions& motions, const SeparationTolerance& rule, Points& ends)
      : before_(before), motions_(motions), rule_(rule), ends_(ends), moved_at_(static_cast<std::size_t>(before.cols()), 0) {}

  /// Returns whether the sides were apart already.
  bool push_apart(const ContactStencil& pair, int number) {
    const double own = heights_at(pair, ends_).gap();
    if (own >= rule_.least()) return true;
    const double begun = heights_at(pair, before_).gap();
    if (!(begun > 0.0) || own >= rule_.needed(begun)) return true;
    const RotatingPlane plane = rotating_plane(pair, before_, ends_, motions_);
    const auto at_end = [&](int k) { return plane.end.dot(ends_.col(particle(pair, k))); };
    const auto midway = [&](int k) { return midway_height(plane, before_.col(particle(pair, k)), ends_.col(particle(pair, k))); };
    const bool apart_at_end = push(pair, begun, Inequality{at_end, plane.end, 1.0}, number);
    return push(pair, begun, Inequality{midway, plane.begin, 0.5}, number) && apart_at_end;
  }

  [[nodiscard]] bool has_moved(const ContactStencil& pair, int since) const {
    return pair.any_of([&](Index i) { return moved_at_[static_cast<std::size_t>(i)] >= since; });
  }

  [[nodiscard]] const std::vector<Index>& moved() const { return moved_; }

 private:
  template <class Height>
  bool push(const ContactStencil& pair, double begun, const Inequality<Height>& inequality, int number) {
    int low = 0;
    for (int k = 1; k < pair.first_count; ++k) low = inequality.height(k) < inequality.height(low) ? k : low;
    int high = pair.first_count;
    for (int k = pair.first_count + 1; k < pair.count(); ++k) high = inequality.height(k) > inequality.height(high) ? k : high;
    const double gap = inequality.height(low) - inequality.height(high);
    if (gap >= rule_.needed(begun)) return true;
    const double share = share_of(particle(pair, low)) + share_of(particle(pair, high));
    if (share == 0.0) return false;
    const Vector3 displacement = (rule_.kept(begun) - gap) / (inequality.gain * share) * inequality.gradient;
    move(particle(pair, low), displacement, number);
    move(particle(pair, high), -displacement, number);
    return false;
  }

  [[nodiscard]] double share_of(Index i) const { return is_fixed(motions_, i) ? 0.0 : 1.0; }

  void move(Index i, const Vector3& displacement, int number) {
    if (share_of(i) == 0.0) return;
    int& moved_at = moved_at_[static_cast<std::size_t>(i)];
    if (moved_at == 0) moved_.push_back(i);
    moved_at = number;
    ends_.col(i) += displacement;
  }

  const Points& before_;
  const ParticleMotions& motions_;
  const SeparationTolerance& rule_;
  Points& ends_;
  std::vector<int> moved_at_;  ///< number of the last sweep that moved it, by particle; 0 if none did
  std::vector<Index> moved_;
};

}  // namespace

HalfSpaceRelaxation::HalfSpaceRelaxation(const Points& before, const ParticleMotions& motions, const SeparationTolerance& rule)
    : before_(before), motions_(motions), rule_(rule) {}

std::optional<RotatingPlane> HalfSpaceRelaxation::plane(const ContactStencil& pair, const Points& ends) const {
  const double begun = heights_at(pair, before_).gap();
  if (!(begun > 0.0)) return std::nullopt;
  if (heights_at(pair, ends).gap() >= rule_.needed(begun)) return RotatingPlane{pair.normal, pair.normal};
  return rotating_plane(pair, before_, ends, motions_);
}

bool HalfSpaceRelaxation::passes(const ContactStencil& pair, const Points& ends) const {
  const std::optional<RotatingPlane> rotating = plane(pair, ends);
  if (!rotating) return false;
  const auto at_end = [&](int k) { return rotating->end.dot(ends.col(particle(pair, k))); };
  const auto midway = [&](int k) { return midway_height(*rotating, before_.col(particle(pair, k)), ends.col(particle(pair, k))); };
  const double needed = rule_.needed(heights_at(pair, before_).gap());
  return heights_of(pair, at_end).gap() < needed || heights_of(pair, midway).gap() < needed;
}

std::vector<Index> HalfSpaceRelaxation::move_apart(const std::vector<ContactStencil>& pairs, Points& ends) const {
  Sweep sweep(before_, motions_, rule_, ends);
  bool apart = false;
  for (int number = 1; number <= kSweeps && !apart; ++number) {
    apart = true;
    for (const ContactStencil& pair : pairs) {
      if (number > 1 && !sweep.has_moved(pair, number - 1)) continue;
      apart = sweep.push_apart(pair, number) && apart;
    }
  }
  return sweep.moved();
}

}  // namespace sprung
