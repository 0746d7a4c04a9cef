#include "network/model/spring_failure.h"

#include "base/sort_unique.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <span>
#include <utility>

namespace sprung {
namespace {

using Pair = std::pair<Index, Index>;

Pair pair_of(Index a, Index b) { return std::minmax(a, b); }

template <class Entry>
std::vector<Entry> sorted_set(std::vector<Entry> entries) {
  sort_unique(entries);
  return entries;
}

/// A few pairs of the particles of a body or network.
class Pairs {
 public:
  explicit Pairs(std::vector<Pair> pairs) : pairs_(sorted_set(std::move(pairs))) {
    for (const auto& [a, b] : pairs_) {
      in_pair_.resize(std::max(in_pair_.size(), static_cast<std::size_t>(b) + 1));
      in_pair_[a] = in_pair_[b] = 1;
    }
  }

  [[nodiscard]] bool contains(const Pair& pair) const {
    return static_cast<std::size_t>(pair.second) < in_pair_.size() && in_pair_[pair.first] != 0 && in_pair_[pair.second] != 0 &&
           std::binary_search(pairs_.begin(), pairs_.end(), pair);
  }

 private:
  std::vector<Pair> pairs_;
  std::vector<char> in_pair_;  ///< whether a particle is in any
};

Pair ends_of(const Springs& springs, Index s) { return {springs.first[s], springs.second[s]}; }

double length_of(const Springs& springs, Index s, const Points& positions) {
  return (positions.col(springs.first[s]) - positions.col(springs.second[s])).norm();
}

/// The particles that structural springs join to an end of a broken structural spring.
std::map<Index, std::vector<Index>> neighbours(const Springs& springs, const std::vector<Index>& broken) {
  std::map<Index, std::vector<Index>> result;
  for (const Index s : broken) {
    if (springs.kind[s] != SpringKind::structural) continue;
    result[springs.first[s]];
    result[springs.second[s]];
  }
  for (Index s = 0; s < springs.count(); ++s) {
    if (springs.kind[s] != SpringKind::structural) continue;
    const auto [a, b] = ends_of(springs, s);
    if (const auto at = result.find(a); at != result.end()) at->second.push_back(b);
    if (const auto at = result.find(b); at != result.end()) at->second.push_back(a);
  }
  return result;
}

/// The pairs of particles that shear and bend springs join over broken structural springs.
Pairs spanned(const Springs& springs, const std::vector<Index>& broken) {
  const auto near = neighbours(springs, broken);
  std::vector<Pair> pairs;
  for (const Index s : broken) {
    if (springs.kind[s] != SpringKind::structural) continue;
    const auto [a, b] = ends_of(springs, s);
    const std::vector<Index>& near_a = near.at(a);
    const std::vector<Index>& near_b = near.at(b);
    for (const Index i : near_b) pairs.push_back(pair_of(a, i));
    for (const Index i : near_a) pairs.push_back(pair_of(b, i));
    std::vector<Index> apexes;
    std::ranges::copy_if(near_a, std::back_inserter(apexes), [&](Index i) { return std::ranges::find(near_b, i) != near_b.end(); });
    for (const Index i : apexes) {
      for (const Index j : apexes) pairs.push_back(pair_of(i, j));
    }
  }
  return Pairs(std::move(pairs));
}

/// Erases the same entries of several arrays.
template <class... Arrays>
void erase_gone(const std::vector<char>& gone, Arrays&... arrays) {
  const auto erase = [&](auto& values) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (gone[i] == 0) values[kept++] = values[i];
    }
    values.resize(kept);
  };
  (erase(arrays), ...);
}

/// Moves the range [first, first + count) to where its entries are once those that are gone are erased.
void shift_range(const std::vector<char>& gone, Index& first, Index& count) {
  const auto begin = gone.begin() + first;
  const auto lost = static_cast<Index>(std::count(begin, begin + count, char{1}));
  first -= static_cast<Index>(std::count(gone.begin(), begin, char{1}));
  count -= lost;
}

void remove_springs(SpringNetwork& network, const std::vector<char>& gone) {
  for (Body& body : network.bodies) {
    const Index before = body.spring_count;
    shift_range(gone, body.first_spring, body.spring_count);
    if (body.spring_count < before) body.resolution = {};  // it is no whole grid any more
  }
  Springs& springs = network.springs;
  erase_gone(gone, springs.first, springs.second, springs.rest_length, springs.stiffness, springs.damping, springs.kind,
             springs.laws);
}

void remove_angle_bends(SpringNetwork& network, const Pairs& gone_pairs) {
  AngleBends& bends = network.angle_bends;
  std::vector<char> gone(static_cast<std::size_t>(bends.count()), 0);
  for (Index a = 0; a < bends.count(); ++a) {
    const Index middle = bends.middle[a];
    gone[a] = gone_pairs.contains(pair_of(bends.before[a], middle)) || gone_pairs.contains(pair_of(middle, bends.after[a])) ? 1 : 0;
  }
  for (Body& body : network.bodies) shift_range(gone, body.first_angle_bend, body.angle_bend_count);
  erase_gone(gone, bends.before, bends.middle, bends.after, bends.length_before, bends.length_after, bends.stiffness,
             bends.damping);
}

std::array<Index, 3> sorted(std::array<Index, 3> corners) {
  std::ranges::sort(corners);
  return corners;
}

/// Removes the face bends with a hinge at a triangle that tore.
void remove_face_bends(SpringNetwork& network) {
  FaceBends& bends = network.face_bends;
  std::vector<char> gone(static_cast<std::size_t>(bends.count()), 0);
  for (const Body& body : network.bodies) {
    if (body.face_bend_count == 0 || body.surface.torn.empty()) continue;
    std::vector<std::array<Index, 3>> triangles;
    for (const auto& corners : body.surface.triangles.colwise()) triangles.push_back(sorted({corners[0], corners[1], corners[2]}));
    const std::vector<std::array<Index, 3>> left = sorted_set(std::move(triangles));
    const auto is_torn = [&](Index a, Index b, Index c) {
      return !std::binary_search(left.begin(), left.end(),
                                 sorted({a - body.first_particle, b - body.first_particle, c - body.first_particle}));
    };
    for (Index f = body.first_face_bend; f < body.first_face_bend + body.face_bend_count; ++f) {
      for (const Index hinge : bends.hinges[f]) {
        if (hinge == kNone) continue;
        const auto [a, b, c, d] = network.hinges.particles[hinge];
        if (is_torn(a, b, c) || is_torn(a, b, d)) gone[f] = 1;
      }
    }
  }
  for (Body& body : network.bodies) shift_range(gone, body.first_face_bend, body.face_bend_count);
  erase_gone(gone, bends.hinges, bends.curvature, bends.stiffness, bends.damping);
}

/// Tears the surface of a body, in the numbering of the body. `gone` are the pairs of particles whose structural or shear spring is
/// gone, `structural` those that a structural one joins, in any order.
class SurfaceTearing {
 public:
  SurfaceTearing(Surface& surface, const Pairs& gone, const std::vector<Pair>& structural)
      : surface_(surface), gone_(gone), structural_(structural) {}

  void tear() {
    remove_segments();
    const std::vector<Index> before = surface_.torn;
    for (Index face = 0; face < surface_.faces.face_count(); ++face) {
      if (!std::ranges::binary_search(before, face) && has_gone_pair(corners(face))) surface_.torn.push_back(face);
    }
    if (surface_.torn.size() == before.size()) return;
    std::ranges::sort(surface_.torn);
    surface_.triangles = triangulate(without_faces(surface_.faces, surface_.torn));
    add_threads();
  }

 private:
  [[nodiscard]] std::span<const Index> corners(Index face) const {
    const PolygonFaces& faces = surface_.faces;
    return std::span(faces.vertex)
        .subspan(static_cast<std::size_t>(faces.corner_begin[face]),
                 static_cast<std::size_t>(faces.corner_begin[face + 1] - faces.corner_begin[face]));
  }

  [[nodiscard]] bool has_gone_pair(std::span<const Index> corners) const {
    for (std::size_t i = 0; i < corners.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        if (gone_.contains(pair_of(corners[i], corners[j]))) return true;
      }
    }
    return false;
  }

  void remove_segments() {
    std::vector<Index> kept;
    for (Index s = 0; s < surface_.segments.cols(); ++s) {
      if (!gone_.contains(pair_of(surface_.segments(0, s), surface_.segments(1, s)))) kept.push_back(s);
    }
    if (static_cast<Index>(kept.size()) < surface_.segments.cols()) surface_.segments = Edges(surface_.segments(Eigen::all, kept));
  }

  void add_threads() {
    std::vector<Pair> around_torn;
    for (const Index face : surface_.torn) {
      const std::span<const Index> around = corners(face);
      for (std::size_t i = 0; i < around.size(); ++i) around_torn.push_back(pair_of(around[i], around[(i + 1) % around.size()]));
    }
    const Pairs sides(std::move(around_torn));
    std::vector<Pair> covered;
    const auto cover = [&](const Pair& pair) {
      if (sides.contains(pair)) covered.push_back(pair);
    };
    for (const auto& triangle : surface_.triangles.colwise()) {
      for (Index k = 0; k < 3; ++k) cover(pair_of(triangle[k], triangle[(k + 1) % 3]));
    }
    for (const auto& segment : surface_.segments.colwise()) cover(pair_of(segment[0], segment[1]));
    const Pairs kept(std::move(covered));
    std::vector<Pair> bare;
    std::ranges::copy_if(structural_, std::back_inserter(bare),
                         [&](const Pair& pair) { return sides.contains(pair) && !kept.contains(pair); });
    const std::vector<Pair> threads = sorted_set(std::move(bare));
    Index next = static_cast<Index>(surface_.segments.cols());
    surface_.segments.conservativeResize(2, next + static_cast<Index>(threads.size()));
    for (const auto& [a, b] : threads) surface_.segments.col(next++) << a, b;
  }

  Surface& surface_;
  const Pairs& gone_;
  const std::vector<Pair>& structural_;
};

/// The pairs of particles that the springs of a body join for which `wanted` is true, in the numbering of the body.
template <class Wanted>
std::vector<Pair> pairs_of(const Body& body, const Springs& springs, const Wanted& wanted) {
  std::vector<Pair> pairs;
  for (Index s = body.first_spring; s < body.first_spring + body.spring_count; ++s) {
    if (wanted(s)) pairs.emplace_back(springs.first[s] - body.first_particle, springs.second[s] - body.first_particle);
  }
  return pairs;
}

}  // namespace

Index SpringState::broken_count() const { return static_cast<Index>(broken.size() - std::ranges::count(broken, 0)); }

SpringState initial_springs(const Springs& springs) {
  SpringState state;
  if (std::ranges::any_of(springs.laws, &SpringLaw::yields)) state.rest_lengths = springs.rest_length;
  if (std::ranges::any_of(springs.laws, &SpringLaw::breaks)) state.broken.assign(static_cast<std::size_t>(springs.count()), 0);
  return state;
}

std::vector<Index> let_yield(Springs& springs, const Points& positions) {
  std::vector<Index> changed;
  for (Index s = 0; s < static_cast<Index>(springs.laws.size()); ++s) {
    const SpringLaw& law = springs.laws[s];
    double& rest = springs.rest_length[s];
    if (!law.yields() || rest == 0.0) continue;
    const double length = length_of(springs, s, positions);
    const double strain = (length - rest) / rest;
    if (strain > law.yield) {
      rest = length / (1.0 + law.yield);
    } else if (strain < -law.yield && !law.tension_only && length > 0.0) {
      rest = length / (1.0 - law.yield);
    } else {
      continue;
    }
    changed.push_back(s);
  }
  return changed;
}

std::vector<char> with_dependents(const Springs& springs, const std::vector<Index>& broken) {
  std::vector<char> gone(static_cast<std::size_t>(springs.count()), 0);
  for (const Index s : broken) gone[s] = 1;
  const Pairs pairs = spanned(springs, broken);
  for (Index s = 0; s < springs.count(); ++s) {
    if (springs.kind[s] != SpringKind::structural && pairs.contains(ends_of(springs, s))) gone[s] = 1;
  }
  return gone;
}

void tear(SpringNetwork& network, const std::vector<char>& gone) {
  if (std::ranges::count(gone, 0) == static_cast<std::ptrdiff_t>(gone.size())) return;
  const Springs& springs = network.springs;
  std::vector<Pair> gone_structural;
  for (Body& body : network.bodies) {
    const bool loses = std::any_of(gone.begin() + body.first_spring, gone.begin() + body.first_spring + body.spring_count,
                                   [](char is_gone) { return is_gone != 0; });
    if (!loses) continue;
    const auto is_structural = [&](Index s) { return springs.kind[s] == SpringKind::structural; };
    const Pairs pairs(pairs_of(body, springs, [&](Index s) { return gone[s] != 0 && springs.kind[s] != SpringKind::bend; }));
    const std::vector<Pair> left = pairs_of(body, springs, [&](Index s) { return gone[s] == 0 && is_structural(s); });
    SurfaceTearing(body.surface, pairs, left).tear();
    for (Index s = body.first_spring; s < body.first_spring + body.spring_count; ++s) {
      if (gone[s] != 0 && is_structural(s)) gone_structural.push_back(ends_of(springs, s));
    }
  }
  remove_angle_bends(network, Pairs(std::move(gone_structural)));
  remove_face_bends(network);
  remove_springs(network, gone);
}

SpringState carried_over(const SpringNetwork& from, const SpringState& state, const SpringNetwork& to) {
  const auto key_of = [](const Springs& of, Index s) { return std::pair(ends_of(of, s), of.kind[s]); };
  std::map<std::pair<Pair, SpringKind>, Index> missing;  // numbers of springs
  for (Index s = 0; s < from.springs.count(); ++s) {
    if (state.is_broken(s)) ++missing[key_of(from.springs, s)];
  }
  std::vector<Index> broken;
  for (Index s = 0; s < to.springs.count(); ++s) {
    const auto found = missing.find(key_of(to.springs, s));
    if (found != missing.end() && found->second-- > 0) broken.push_back(s);
  }
  SpringState carried = initial_springs(to.springs);
  if (!broken.empty()) carried.broken = with_dependents(to.springs, broken);
  carried.unloading = state.unloading;
  const Index common = std::min(from.springs.count(), to.springs.count());
  for (Index s = 0; s < common; ++s) {
    if (from.springs.law(s).yields() && to.springs.law(s).yields() && ends_of(from.springs, s) == ends_of(to.springs, s)) {
      carried.rest_lengths[s] = state.rest_lengths[s];
    }
  }
  return carried;
}

}  // namespace sprung
