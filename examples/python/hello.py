"""A mass on a spring swings for two seconds: the equations 5 to 12 of the manual, in Python."""
import sprung

builder = sprung.NetworkBuilder()
hook = builder.add_particle([0, 0, 0], 1.0)  # position [m], mass [kg]
bob = builder.add_particle([1, 0, 0], 0.5)
builder.add_spring(hook, bob, 100.0, 1.0, 0.2)  # stiffness [N/m], rest length [m], damping [N s/m]
builder.pin(hook)

simulator = sprung.Simulator(builder.build(), step=0.001)  # [s]
position = simulator.bodies["network"].particles[bob]  # a view: it follows the simulation
while simulator.time < 2.0:
    simulator.step()
print("after 2 s the bob is at", position)
