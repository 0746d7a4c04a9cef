// A mass on a spring swings for two seconds.
#include "network/network_builder.h"
#include "simulation/simulator.h"

#include <iostream>

int main() {
  sprung::NetworkBuilder builder;
  const auto hook = builder.add_particle({0, 0, 0}, 1.0);  // position [m], mass [kg]
  const auto bob = builder.add_particle({1, 0, 0}, 0.5);
  builder.add_spring(hook, bob, 100.0, 1.0, 0.2);  // stiffness [N/m], rest length [m], damping [N s/m]
  builder.pin(hook);

  sprung::Simulator simulator(builder.build(), {.step = 0.001});  // [s]
  while (simulator.time() < 2.0) simulator.step();
  std::cout << "after 2 s the bob is at " << simulator.positions().col(bob).transpose() << '\n';
}
