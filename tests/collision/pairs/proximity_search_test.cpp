// Compares the candidates of the proximity search with brute force over all vertex-face and edge-edge pairs.
#include "collision/pairs/proximity_search.h"
#include "collision/self_networks.h"
#include "geometry/queries/closest_pair.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <tuple>

namespace sprung {
namespace {

using test::SelfNetwork;

constexpr double kEdge = 0.01;      // [m]
constexpr double kGap = 0.003;      // [m]
constexpr double kRadius = 0.0005;  // [m]
constexpr double kFar = 1.0;        // [m]
constexpr HorizonTimes kTimes{.now = 2.0, .end = 7.0};

using Key = std::tuple<bool, Index, Index, Index, Index>;

/// The key of an edge pair does not depend on the order of the edges or of their ends.
Key key(bool edges, std::array<Index, 4> x) {
  if (edges) {
    std::sort(x.begin(), x.begin() + 2);
    std::sort(x.begin() + 2, x.end());
    if (x[2] < x[0] || (x[2] == x[0] && x[3] < x[1])) std::swap_ranges(x.begin(), x.begin() + 2, x.begin() + 2);
  } else {
    std::sort(x.begin() + 1, x.end());
  }
  return {edges, x[0], x[1], x[2], x[3]};
}

/// A sheet and ropes with particles at random positions in a small box, each with its own displacement.
class Crumpled {
 public:
  explicit Crumpled(std::uint64_t seed) : random_(seed) {
    network_.add_cloth(9, Vector3::Zero(), kEdge * Vector3::UnitX(), kEdge * Vector3::UnitZ());
    network_.add_rope(20, {0.0, 0.02, 0.0}, kEdge * Vector3::UnitX());
    network_.add_single_particle({0.0, 0.05, 0.0});
    surface_ = std::make_unique<CollisionSurface>(network_.surface(kGap));
    features_ = std::make_unique<SurfaceTopology>(surface_->elements, network_.count());
    sharp_ = std::make_unique<FeatureEdges>(*surface_, *features_);
    tree_ = std::make_unique<ElementBvh>(*surface_, network_.positions);
    spheres_ = std::make_unique<VertexBounds>(std::vector<double>(static_cast<std::size_t>(network_.count()), kRadius));
    for (Index i = 0; i < network_.count(); ++i) {
      const Vector3 position = network_.positions.col(i) + random_.between(0.0, 2.0 * kEdge) * random_.direction();
      spheres_->reset(i, position, position + random_.between(0.0, 0.03 * kEdge) * random_.direction());
    }
    mark_elements(all());
    tree_->bound(*spheres_, all_of(0), marked_elements_, kTimes);
  }

  [[nodiscard]] std::vector<char> all() const { return all_of(1); }
  [[nodiscard]] std::vector<char> some(int parts) {
    std::vector<char> marked = all_of(0);
    for (char& mark : marked) mark = random_.between(0.0, parts) < 1.0 ? 1 : 0;
    return marked;
  }

  [[nodiscard]] std::vector<ContactCandidate> find(const std::vector<char>& marked) {
    mark_elements(marked);
    tree_->mark(marked_elements_);
    ProximitySearch search(*surface_, *features_, *sharp_, *tree_, network_.positions, 0.5 * kGap);
    return search.find_candidates(*spheres_, marked, kTimes);
  }

  /// Vertices above or below faces, and pairs of edges, that share no particle and whose spheres' centers are at some time nearer
  /// than the gap plus the spheres' radii. Within a body the gap is at most 0.4 of the distance at rest.
  [[nodiscard]] std::set<Key> nearer_than_the_gap() const {
    std::set<Key> found;
    for (const Element& element : surface_->elements) {
      for (const Element& other : surface_->elements) {
        for (const Index corner : corners_of(element)) look_at_corner(corner, element.body, other, found);
        for (int i = 0; i < edges_of(element); ++i) {
          for (int k = 0; k < edges_of(other); ++k) look_at_edges(element, i, other, k, found);
        }
      }
    }
    return found;
  }

 private:
  [[nodiscard]] std::vector<char> all_of(char value) const {
    return std::vector<char>(static_cast<std::size_t>(network_.count()), value);
  }

  void mark_elements(const std::vector<char>& marked) {
    marked_elements_.clear();
    for (std::size_t e = 0; e < surface_->elements.size(); ++e) {
      const auto is_marked = [&](Index i) { return marked[static_cast<std::size_t>(i)] != 0; };
      if (std::ranges::any_of(corners_of(surface_->elements[e]), is_marked)) marked_elements_.push_back(static_cast<Index>(e));
    }
  }

  void look_at_corner(Index corner, Index body, const Element& face, std::set<Key>& found) const {
    const auto& t = face.particles;
    if (face.corners != 3 || corner == t[0] || corner == t[1] || corner == t[2]) return;
    const auto distance = [&](const auto& x) {
      const ClosestPoint closest = closest_point_on_triangle(x(corner), x(t[0]), x(t[1]), x(t[2]));
      return closest.feature == TriangleFeature::face ? (closest.point - x(corner)).norm() : kFar;
    };
    const auto x = [&](Index i) -> Vector3 { return network_.positions.col(i); };
    const double at_rest = (closest_point_on_triangle(x(corner), x(t[0]), x(t[1]), x(t[2])).point - x(corner)).norm();
    if (comes_near(distance, body == face.body ? std::min(kGap, 0.4 * at_rest) : kGap))
      found.insert(key(false, {corner, t[0], t[1], t[2]}));
  }

  void look_at_edges(const Element& element, int i, const Element& other, int k, std::set<Key>& found) const {
    const auto a = ends_of(element, i);
    const auto b = ends_of(other, k);
    if (a[0] == b[0] || a[0] == b[1] || a[1] == b[0] || a[1] == b[1]) return;
    const auto distance = [&](const auto& x) {
      return std::sqrt(closest_points_of_segments(x(a[0]), x(a[1]), x(b[0]), x(b[1])).squared_distance);
    };
    const double at_rest = distance([&](Index p) -> Vector3 { return network_.positions.col(p); });
    if (comes_near(distance, element.body == other.body ? std::min(kGap, 0.4 * at_rest) : kGap))
      found.insert(key(true, {a[0], a[1], b[0], b[1]}));
  }

  template <class Distance>
  [[nodiscard]] bool comes_near(const Distance& distance, double gap) const {
    for (double time = 0.0; time <= kTimes.end - kTimes.now; time += 0.5) {
      const double now = distance([&](Index p) { return spheres_->center(p, time); });
      if (now < gap + 2.0 * kRadius) return true;
    }
    return false;
  }

  test::Random random_;
  SelfNetwork network_;
  std::unique_ptr<CollisionSurface> surface_;
  std::unique_ptr<SurfaceTopology> features_;
  std::unique_ptr<FeatureEdges> sharp_;
  std::unique_ptr<ElementBvh> tree_;
  std::unique_ptr<VertexBounds> spheres_;
  std::vector<Index> marked_elements_;
};

std::set<Key> keys_of(const std::vector<ContactCandidate>& candidates) {
  std::set<Key> keys;
  for (const ContactCandidate& candidate : candidates) {
    const ContactStencil& stencil = candidate.stencil;
    const auto& x = stencil.particles;
    keys.insert(key(stencil.is_edge_edge(), {x[0], x[1], x[2], x[3]}));
  }
  return keys;
}

TEST(ProximitySearch, MissesNothingThatComesNearerThanTheGap) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    Crumpled crumpled(seed);
    const std::set<Key> found = keys_of(crumpled.find(crumpled.all()));
    const std::set<Key> wanted = crumpled.nearer_than_the_gap();
    EXPECT_GT(wanted.size(), 200U);
    EXPECT_TRUE(std::includes(found.begin(), found.end(), wanted.begin(), wanted.end()));
  }
}

TEST(ProximitySearch, NamesEachOnce) {
  Crumpled crumpled(4);
  const std::vector<ContactCandidate> found = crumpled.find(crumpled.all());
  EXPECT_EQ(keys_of(found).size(), found.size());
}

TEST(ProximitySearch, LooksAtLittleElse) {
  Crumpled crumpled(5);
  // The search finds all pairs within gap and margin, by bounds over the whole interval. 1.4 times as many were observed.
  EXPECT_LT(crumpled.find(crumpled.all()).size(), 2 * crumpled.nearer_than_the_gap().size());
}

TEST(ProximitySearch, ASearchAroundMarkedParticlesFindsTheSameAsAWholeSearch) {
  Crumpled crumpled(6);
  const std::vector<ContactCandidate> whole = crumpled.find(crumpled.all());
  for (const int parts : {2, 10, 100}) {
    const std::vector<char> marked = crumpled.some(parts);
    std::vector<ContactCandidate> expected = whole;
    std::erase_if(expected, [&](const ContactCandidate& candidate) {
      return !candidate.stencil.any_of([&](Index i) { return marked[static_cast<std::size_t>(i)] != 0; });
    });
    const std::vector<ContactCandidate> found = crumpled.find(marked);
    EXPECT_EQ(keys_of(found), keys_of(expected)) << "one of " << parts;
    EXPECT_EQ(found.size(), expected.size());
  }
}

}  // namespace
}  // namespace sprung
