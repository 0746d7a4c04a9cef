#include "collision/surface/collision_surface.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>

namespace sprung {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// A flat square of 1 m with n x n particles, and the two triangles of each of its cells.
struct Sheet {
  explicit Sheet(Index n) : positions(3, n * n) {
    for (Index i = 0; i < n * n; ++i) positions.col(i) << double(i % n) / (n - 1), 0.0, double(i / n) / (n - 1);
    for (Index i = 0; i + n < n * n; ++i) {
      if (i % n == n - 1) continue;
      elements.push_back({{i, i + 1, i + n}, 3, 0});
      elements.push_back({{i + 1, i + n + 1, i + n}, 3, 0});
    }
  }

  [[nodiscard]] CollisionSurface surface() const {
    const auto count = static_cast<std::size_t>(positions.cols());
    return make_collision_surface(elements, positions, std::vector<Index>(count, 0), Scalars::Zero(positions.cols()),
                                  ParticleMotions(count), {0}, {1});
  }

  Points positions;
  std::vector<Element> elements;
};

using Corners = std::array<Index, 3>;

std::multiset<Corners> corners_of(const std::vector<Element>& elements) {
  std::multiset<Corners> corners;
  for (const Element& element : elements) corners.insert(element.particles);
  return corners;
}

Box3 bounds(const ElementPatch& patch, const Points& positions) {
  Box3 box;
  for (const Index particle : patch.particles) box.extend(positions.col(particle));
  return box;
}

TEST(CollisionSurface, PatchesHoldEachElementOnceAndFollowEachOther) {
  const Sheet sheet(40);
  const CollisionSurface surface = sheet.surface();
  EXPECT_EQ(corners_of(surface.elements), corners_of(sheet.elements));
  Index next = 0;
  for (const ElementPatch& patch : surface.patches) {
    EXPECT_EQ(patch.first_element, next);
    EXPECT_GE(patch.element_count, 1);
    EXPECT_LE(patch.element_count, 32);
    next += patch.element_count;
  }
  EXPECT_EQ(next, static_cast<Index>(surface.elements.size()));
}

TEST(CollisionSurface, PatchesAreFewAndSmall) {
  const Sheet sheet(65);  // 64 x 64 cells of two triangles are 256 patches of 4 x 4 cells
  const CollisionSurface surface = sheet.surface();
  EXPECT_EQ(surface.patches.size(), 256U);
  // A square halved repeatedly gives squares, whose corners protrude by at most a cell on each side.
  for (const ElementPatch& patch : surface.patches)
    EXPECT_LE(bounds(patch, sheet.positions).sizes().maxCoeff(), 6.0 / 64.0 + 1e-12);
}

TEST(CollisionSurface, ParticlesOfAPatchAreItsElementsAscendingAndSlotsFindThem) {
  const Sheet sheet(20);
  const CollisionSurface surface = sheet.surface();
  std::size_t entries = 0;
  for (const ElementPatch& patch : surface.patches) {
    std::set<Index> expected;
    for (Index e = patch.first_element; e < patch.first_element + patch.element_count; ++e) {
      const Element& element = surface.elements[static_cast<std::size_t>(e)];
      expected.insert(element.particles.begin(), element.particles.begin() + element.corners);
    }
    EXPECT_EQ(patch.particles, std::vector<Index>(expected.begin(), expected.end()));
    entries += patch.particles.size();
  }
  ASSERT_EQ(surface.slots.size(), entries);
  ASSERT_EQ(surface.first_slot.size(), 401U);
  for (Index i = 0; i < 400; ++i) {
    Index last = kNone;
    for (Index s = surface.first_slot[i]; s < surface.first_slot[i + 1]; ++s) {
      const PatchSlot& slot = surface.slots[static_cast<std::size_t>(s)];
      EXPECT_EQ(surface.patches[static_cast<std::size_t>(slot.patch)].particles[static_cast<std::size_t>(slot.slot)], i);
      EXPECT_GT(slot.patch, last) << "each patch once";
      last = slot.patch;
    }
    EXPECT_NE(last, kNone) << "particle " << i << " is in no patch";
  }
}

TEST(CollisionSurface, ParticlesWithoutAnElementBecomeOneWithinTheirBody) {
  const Points positions = (Points(3, 6) << 0, 1, 0, 5, 7, 8, 0, 0, 1, 5, 7, 7, 0, 0, 0, 5, 7, 7).finished();
  const CollisionSurface surface = make_collision_surface({{{0, 1, 2}, 3, 0}, {{4, 5, kNone}, 2, 1}}, positions, {0, 0, 0, 0, 1, 1},
                                                          Scalars::Constant(6, 0.01), ParticleMotions(6), {1, 0}, {0, 1});
  ASSERT_EQ(surface.elements.size(), 3U);
  EXPECT_EQ(surface.elements[1].particles[0], 3);
  EXPECT_EQ(surface.elements[1].corners, 1);
  EXPECT_EQ(surface.elements[1].body, 0);
  EXPECT_EQ(surface.elements[2].body, 1);
  ASSERT_EQ(surface.patches.size(), 2U) << "a patch belongs to one body";
  EXPECT_THAT(surface.patches[0].particles, ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(surface.patches[1].particles, ElementsAre(4, 5));
  // Edges of 1, 1 and sqrt(2) m; a segment of 1 m.
  EXPECT_DOUBLE_EQ(surface.element_size[0], (2.0 + std::sqrt(2.0)) / 3.0);
  EXPECT_DOUBLE_EQ(surface.element_size[1], 1.0);
  EXPECT_THAT(surface.self, ElementsAre(1, 0));
  EXPECT_THAT(surface.others, ElementsAre(0, 1));
}

TEST(CollisionSurface, ParticlesAtOnePlaceAreCutToo) {
  const Index count = 1000;
  const CollisionSurface surface = make_collision_surface({}, Points::Ones(3, count), std::vector<Index>(1000, 0),
                                                          Scalars::Zero(count), ParticleMotions(1000), {0}, {1});
  EXPECT_EQ(surface.patches.size(), 32U);
  EXPECT_EQ(surface.element_size[0], 0.0);
  const CollisionSurface nothing = make_collision_surface({}, Points(3, 0), {}, {}, {}, {}, {});
  EXPECT_THAT(nothing.patches, IsEmpty());
}

TEST(CollisionSurface, ScalingByAPowerOfTwoChangesNoPatch) {
  Sheet sheet(33);
  const CollisionSurface plain = sheet.surface();
  sheet.positions *= 1.0 / 128.0;
  const CollisionSurface scaled = sheet.surface();
  ASSERT_EQ(plain.elements.size(), scaled.elements.size());
  for (std::size_t e = 0; e < plain.elements.size(); ++e) EXPECT_EQ(plain.elements[e].particles, scaled.elements[e].particles);
  EXPECT_EQ(plain.element_size[0], 128.0 * scaled.element_size[0]);
}

}  // namespace
}  // namespace sprung
