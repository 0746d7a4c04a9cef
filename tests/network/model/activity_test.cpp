#include "network/model/activity.h"

#include "network/network_builder.h"
#include "network/set_asleep.h"

#include <gtest/gtest.h>

namespace sprung {
namespace {

TEST(SleepingParticles, HaveNoInverseMassUntilTheyWakeAndPinsStay) {
  NetworkBuilder builder;
  builder.begin_body("first");
  for (int i = 0; i < 3; ++i) builder.add_particle({1.0 * i, 0.0, 0.0}, 0.5);
  builder.begin_body("second");
  builder.add_particle({0.0, 1.0, 0.0}, 0.5);
  builder.pin(1);
  SpringNetwork network = builder.build();
  const Scalars before = network.inverse_masses;
  set_asleep({1, 1, 0, 1}, network);
  EXPECT_EQ(network.inverse_masses, Scalars({{0.0, 0.0, 2.0, 0.0}}).transpose());
  EXPECT_FALSE(is_asleep(network, network.bodies[0])) << "one of its particles is awake";
  EXPECT_TRUE(is_asleep(network, network.bodies[1]));
  set_asleep({0, 1, 1, 0}, network);
  EXPECT_EQ(network.inverse_masses, Scalars({{2.0, 0.0, 0.0, 2.0}}).transpose());
  set_asleep({}, network);
  EXPECT_EQ(network.inverse_masses, before);
  EXPECT_FALSE(network.is_asleep(1));
}

}  // namespace
}  // namespace sprung
