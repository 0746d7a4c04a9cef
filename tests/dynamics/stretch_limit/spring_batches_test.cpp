#include "dynamics/stretch_limit/spring_batches.h"

#include "base/machine/simd.h"
#include "dynamics/networks.h"
#include "dynamics/stretch_limit/batch_order.h"

#include <gtest/gtest.h>

#include <set>
#include <utility>
#include <vector>

namespace sprung {
namespace {

const std::vector<SpringKind> kAllKinds{SpringKind::structural, SpringKind::shear, SpringKind::bend};

/// The springs of a batch, without the repeated ones that fill its last group.
std::vector<Index> springs_of(const SpringBatches& batches, Index batch) {
  std::vector<Index> springs;
  for (Index s = batches.batch[batch].begin; s < batches.batch[batch].end; ++s) {
    const bool fills = s % kSimdWidth > 0 && batches.first[s] == batches.first[s - 1] && batches.second[s] == batches.second[s - 1];
    if (!fills) springs.push_back(s);
  }
  return springs;
}

/// Calls `body(task, batch)` for all batches of a stage.
template <class Body>
void for_batches_of_stage(const SpringBatches& batches, std::size_t stage, const Body& body) {
  for (Index task = batches.stage_begin[stage]; task < batches.stage_begin[stage + 1]; ++task) {
    for (Index batch = batches.task_begin[task]; batch < batches.task_begin[task + 1]; ++batch) body(task, batch);
  }
}

/// Cloths with rows, a cloth so small that it counts as having none, and springs between arbitrary particles.
std::vector<SpringNetwork> networks() {
  return {make_test_cloth(70, 0.0, 0.0), make_test_cloth(100, 0.0, 0.0, false), make_test_cloth(9, 0.0, 0.0),
          make_random_network(300, 6000)};
}

TEST(SpringBatches, ContainEachSpringOnce) {
  for (const SpringNetwork& network : networks()) {
    const SpringBatches batches(network, kAllKinds);
    std::multiset<std::pair<Index, Index>> expected;
    for (Index s = 0; s < network.springs.count(); ++s) {
      const std::pair ends{network.springs.first[s], network.springs.second[s]};
      if (!network.is_fixed(ends.first) || !network.is_fixed(ends.second)) expected.insert(ends);
    }
    std::multiset<std::pair<Index, Index>> found;
    for (std::size_t stage = 0; stage + 1 < batches.stage_begin.size(); ++stage) {
      for_batches_of_stage(batches, stage, [&](Index, Index batch) {
        for (const Index s : springs_of(batches, batch)) found.emplace(batches.first[s], batches.second[s]);
      });
    }
    EXPECT_EQ(found, expected);
  }
}

TEST(SpringBatches, BatchesAndTasksOfAStageShareNoParticle) {
  for (const SpringNetwork& network : networks()) {
    const SpringBatches batches(network, kAllKinds);
    for (std::size_t stage = 0; stage + 1 < batches.stage_begin.size(); ++stage) {
      std::vector<Index> task_of(network.particle_count(), kNone);
      std::vector<Index> batch_of(network.particle_count(), kNone);
      for_batches_of_stage(batches, stage, [&](Index task, Index batch) {
        for (const Index s : springs_of(batches, batch)) {
          for (const Index particle : {batches.first[s], batches.second[s]}) {
            ASSERT_TRUE(task_of[particle] == kNone || task_of[particle] == task);
            ASSERT_NE(batch_of[particle], batch) << "twice in one batch";
            task_of[particle] = task;
            batch_of[particle] = batch;
          }
        }
      });
    }
  }
}

// Two threads need two tasks. Bend springs reach two rows far and need more colours.
TEST(SpringBatches, ManySpringsMakeTwoTasksAtLeast) {
  EXPECT_GE(SpringBatches(make_test_cloth(100, 0.0, 0.0), {SpringKind::structural, SpringKind::shear}).stage_begin[1], 2);
  EXPECT_GE(SpringBatches(make_test_cloth(64, 0.0, 0.0), kAllKinds).stage_begin[1], 2);
}

/// The springs of each particle, in the order in which a pass projects them.
std::vector<std::vector<std::pair<Index, Index>>> springs_in_order(const SpringBatches& batches, Index particles) {
  std::vector<std::vector<std::pair<Index, Index>>> at(static_cast<std::size_t>(particles));
  for (Index batch = 0; batch < static_cast<Index>(batches.batch.size()); ++batch) {
    for (const Index s : springs_of(batches, batch)) {
      for (const Index particle : {batches.first[s], batches.second[s]}) {
        at[static_cast<std::size_t>(particle)].emplace_back(batches.first[s], batches.second[s]);
      }
    }
  }
  return at;
}

TEST(SpringBatches, OrderByLocalityKeepsTheOrderOfColoursAtEachParticle) {
  const SpringNetwork network = make_test_cloth(70, 0.0, 0.0);
  SpringBatches batches(network, {SpringKind::structural, SpringKind::shear});
  // Each batch has a colour of its own, so no two batches that share a particle may be swapped.
  std::vector<Index> colour_begin;
  for (Index batch = 0; batch <= static_cast<Index>(batches.batch.size()); ++batch) colour_begin.push_back(batch);
  const auto expected = springs_in_order(batches, network.particle_count());
  order_by_locality(colour_begin, 1, network.particle_count(), batches);
  EXPECT_EQ(springs_in_order(batches, network.particle_count()), expected);
}

}  // namespace
}  // namespace sprung
