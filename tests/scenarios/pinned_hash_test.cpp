// Pins the hash of one run, to show that a change which should not alter results does not.
#include "base/parallel.h"
#include "scenarios/position_hash.h"
#include "scenarios/scenario.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace sprung::testing {
namespace {

constexpr std::uint64_t kHash = 0xc49e34f1d32cd3e9;

/// The hash of all positions of all frames of a cloth that falls on a ball, a floor and itself.
std::uint64_t hash_of_run(int threads, const std::vector<std::string>& overrides = {}) {
  const ThreadLimit limit(threads);
  PositionHash hash;
  const Watch add = [&](const Simulator& simulator, const FrameDiagnostics&) { hash.add(simulator.positions()); };
  run_scenario(load_scenario("pinned_hash", overrides), add, Judge::nothing);
  return hash.value();
}

// When this fails, the code computes other positions than before. The scene writes out every setting, so no default is the cause.
// If the change is not intended, tests/compare_frames.sh names the first frame and particle that differ. If it is intended and all
// scenarios pass, write the new hash above and say in the commit's body why results change. A new setting enters the scene with the
// value that keeps the hash.
TEST(PinnedHash, OneRunHasThePinnedBitsWithOneThreadAndWithTwo) {
  EXPECT_EQ(hash_of_run(1), kHash);
  EXPECT_EQ(hash_of_run(2), kHash);
}

// Without this the hash would not cover contact.
TEST(PinnedHash, TheRunDependsOnSelfContactAndObstacles) {
  EXPECT_NE(hash_of_run(2, {"bodies.cloth.self_contact=false"}), kHash);
  EXPECT_NE(hash_of_run(2, {"obstacles.ball.shape.radius=0.07"}), kHash);
}

}  // namespace
}  // namespace sprung::testing
