#include "scene/building/memory_check.h"

#include "base/machine/machine_memory.h"

#include <gmock/gmock.h>

namespace sprung {
namespace {

using testing::ElementsAre;
using testing::Field;
using testing::IsEmpty;

std::vector<Problem> problems(const std::vector<BodyScene>& bodies, double memory) {
  std::vector<Problem> found;
  check_memory(bodies, memory, found);
  return found;
}

std::vector<BodyScene> cloth_and_rope(Index cloth_side, Index rope_particles) {
  std::vector<BodyScene> bodies(2);
  bodies[0].name = "cloth";
  bodies[0].shape = ClothShape{.resolution = {cloth_side, cloth_side}};
  RopeShape rope;
  rope.particles = rope_particles;
  bodies[1].name = "rope";
  bodies[1].shape = rope;
  return bodies;
}

TEST(MemoryCheck, NamesTheLargestBodyIfAllBodiesTogetherAreTooLarge) {
  constexpr double kMemory = 1.0e9;
  EXPECT_THAT(problems(cloth_and_rope(1000, 2), kMemory), IsEmpty());
  EXPECT_THAT(problems(cloth_and_rope(1000, 1'000'000), kMemory),
              ElementsAre(Field(&Problem::key, "bodies.cloth.shape.resolution")));
  EXPECT_THAT(problems(cloth_and_rope(2, 100'000'000), kMemory), ElementsAre(Field(&Problem::key, "bodies.rope.shape.particles")));
  EXPECT_THAT(problems({}, kMemory), IsEmpty());
}

TEST(MemoryCheck, ReadsTheMemoryOfTheMachine) {
  EXPECT_GT(machine_memory(), 1.0e8);
  EXPECT_THAT(problems(cloth_and_rope(10, 10), machine_memory()), IsEmpty());
}

}  // namespace
}  // namespace sprung
