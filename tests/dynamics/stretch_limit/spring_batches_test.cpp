#include "dynamics/stretch_limit/spring_batches.h"

#include "base/simd.h"
#include "dynamics/networks.h"
#include "dynamics/stretch_limit/batch_order.h"

#include <gtest/gtest.h>

#include <set>
#include <utility>
#include <vector>

namespace sprung {
namespace {

const std::vector<SpringKind> kAllKinds{SpringKind::structural, SpringKind::shear, SpringKind::bend};

/// Springs of a part, those that fill it but once.
std::vector<Index> springs_of(const SpringBatches& batches, Index part) {
  std::vector<Index> springs;
  for (Index s = batches.batch[part].begin; s < batches.batch[part].end; ++s) {
    const bool fills = s % kSimdWidth > 0 && batches.first[s] == batches.first[s - 1] && batches.second[s] == batches.second[s - 1];
    if (!fills) springs.push_back(s);
  }
  return springs;
}

/// Calls `body(task, part)` for all parts of a stage.
template <class Body>
void for_parts_of_stage(const SpringBatches& batches, std::size_t stage, const Body& body) {
  for (Index task = batches.stage_begin[stage]; task < batches.stage_begin[stage + 1]; ++task) {
    for (Index part = batches.task_begin[task]; part < batches.task_begin[task + 1]; ++part) body(task, part);
  }
}

/// A cloth with rows, one that is so small that it counts as having none, and springs between any particles.
std::vector<SpringNetwork> networks() {
  return {make_test_cloth(70, 0.0, 0.0), make_test_cloth(100, 0.0, 0.0, false), make_test_cloth(9, 0.0, 0.0),
          make_random_network(300, 6000)};
}

TEST(SpringBatches, HoldEachSpringOnce) {
  for (const SpringNetwork& network : networks()) {
    const SpringBatches batches(network, kAllKinds);
    std::multiset<std::pair<Index, Index>> expected;
    for (Index s = 0; s < network.springs.count(); ++s) {
      const std::pair ends{network.springs.first[s], network.springs.second[s]};
      if (!network.is_pinned(ends.first) || !network.is_pinned(ends.second)) expected.insert(ends);
    }
    std::multiset<std::pair<Index, Index>> held;
    for (std::size_t stage = 0; stage + 1 < batches.stage_begin.size(); ++stage) {
      for_parts_of_stage(batches, stage, [&](Index, Index part) {
        for (const Index s : springs_of(batches, part)) held.emplace(batches.first[s], batches.second[s]);
      });
    }
    EXPECT_EQ(held, expected);
  }
}

TEST(SpringBatches, PartsAndTasksOfAStageShareNoParticle) {
  for (const SpringNetwork& network : networks()) {
    const SpringBatches batches(network, kAllKinds);
    for (std::size_t stage = 0; stage + 1 < batches.stage_begin.size(); ++stage) {
      std::vector<Index> task_of(network.particle_count(), kNone);
      std::vector<Index> part_of(network.particle_count(), kNone);
      for_parts_of_stage(batches, stage, [&](Index task, Index part) {
        for (const Index s : springs_of(batches, part)) {
          for (const Index particle : {batches.first[s], batches.second[s]}) {
            ASSERT_TRUE(task_of[particle] == kNone || task_of[particle] == task);
            ASSERT_NE(part_of[particle], part) << "twice in one part";
            task_of[particle] = task;
            part_of[particle] = part;
          }
        }
      });
    }
  }
}

// So that two threads have something to do. Bend springs reach two rows far, and make more colours.
TEST(SpringBatches, ManySpringsMakeTwoTasksAtLeast) {
  EXPECT_GE(SpringBatches(make_test_cloth(100, 0.0, 0.0), {SpringKind::structural, SpringKind::shear}).stage_begin[1], 2);
  EXPECT_GE(SpringBatches(make_test_cloth(64, 0.0, 0.0), kAllKinds).stage_begin[1], 2);
}

/// Springs that share a particle, in the order in which a pass comes to them.
std::vector<std::vector<std::pair<Index, Index>>> springs_in_order(const SpringBatches& batches, Index particles) {
  std::vector<std::vector<std::pair<Index, Index>>> at(static_cast<std::size_t>(particles));
  for (Index part = 0; part < static_cast<Index>(batches.batch.size()); ++part) {
    for (const Index s : springs_of(batches, part)) {
      for (const Index particle : {batches.first[s], batches.second[s]}) {
        at[static_cast<std::size_t>(particle)].emplace_back(batches.first[s], batches.second[s]);
      }
    }
  }
  return at;
}

TEST(SpringBatches, OrderByPlaceKeepsTheOrderOfColoursAtEachParticle) {
  const SpringNetwork network = make_test_cloth(70, 0.0, 0.0);
  SpringBatches batches(network, {SpringKind::structural, SpringKind::shear});
  // Each part a colour of its own: then no two parts that share a particle may change places.
  std::vector<Index> colour_begin;
  for (Index part = 0; part <= static_cast<Index>(batches.batch.size()); ++part) colour_begin.push_back(part);
  const auto expected = springs_in_order(batches, network.particle_count());
  order_by_locality(colour_begin, 1, network.particle_count(), batches);
  EXPECT_EQ(springs_in_order(batches, network.particle_count()), expected);
}

}  // namespace
}  // namespace sprung
