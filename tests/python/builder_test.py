"""Laws of networks that a program builds."""
import unittest

import numpy

import sprung


class Builder(unittest.TestCase):
    def test_a_mass_on_a_spring_swings_with_its_frequency(self):
        builder = sprung.NetworkBuilder()
        hook = builder.add_particle([0, 0, 0], 1.0)
        bob = builder.add_particle([1.1, 0, 0], 0.5)
        builder.add_spring(hook, bob, 100.0, 1.0)
        builder.pin(hook, "hook")
        network = builder.build()
        self.assertEqual(len(network), 2)
        numpy.testing.assert_array_equal(network.masses, [1.0, 0.5])
        one = sprung.Simulator(network, step=1e-4, gravity=(0, 0, 0), integrator="runge_kutta_4")
        x = one.bodies["network"].particles
        for _ in range(10):
            one.step(100)
            self.assertAlmostEqual(x[1, 0], 1.0 + 0.1 * numpy.cos(numpy.sqrt(100.0 / 0.5) * one.time), 9)
        self.assertEqual(list(one.pins), ["hook"])

    def test_every_integrator_has_a_name(self):
        for name in ("explicit_euler", "symplectic_euler", "verlet", "velocity_verlet", "runge_kutta_4", "implicit_euler"):
            builder = sprung.NetworkBuilder()
            a, b = builder.add_particle([0, 0, 0], 1.0), builder.add_particle([1, 0, 0], 1.0, velocity=[0, 1, 0])
            builder.add_spring(a, b, 1.0, 1.0, 0.1)
            one = sprung.Simulator(builder.build(), step=1e-3, integrator=name)
            one.step(10)
            self.assertAlmostEqual(one.time, 0.01, 12)
        with self.assertRaises(sprung.InputError):
            sprung.Simulator(builder.build(), integrator="leapfrog")

    def test_whole_bodies_fall_on_obstacles(self):
        builder = sprung.NetworkBuilder()
        springs = dict(structural=(100.0, 0.05), shear=30.0, bend=1.0)
        builder.add_body("cloth", sprung.make_cloth([1, 1], [12, 12], mass=0.2, **springs, rotation=[-90, 0, 0]), thickness=0.005,
                         friction=0.3, self_contact=True)
        builder.add_body("cube", sprung.make_solid([0.2] * 3, [3, 3, 3], mass=0.2, **springs, position=[3, 0, 0]), thickness=0.005)
        builder.add_body("rope", sprung.make_rope([[5, 0, 0], [6, 0, 0]], 10, mass=0.1, structural=(200.0, 0.1)), thickness=0.005)
        one = sprung.Simulator(builder.build(), step=1e-3, record_forces=True, obstacles=[
            sprung.make_sphere("ball", 0.2, position=[0, -0.3, 0], friction=0.3, thickness=0.005),
            sprung.make_box("table", [1, 0.1, 1], position=[3, -0.5, 0]),
            sprung.make_ground("floor", height=-1.0, friction=0.5)])
        self.assertEqual(list(one.bodies), ["cloth", "cube", "rope"])
        self.assertEqual(list(one.obstacles), ["ball", "table", "floor"])
        one.step(800)
        distance = numpy.linalg.norm(one.bodies["cloth"].particles - [0, -0.3, 0], axis=1)
        self.assertGreaterEqual(distance.min(), 0.2)
        self.assertGreaterEqual(one.bodies["cube"].particles[:, 1].min(), -0.45)
        self.assertGreaterEqual(one.bodies["rope"].particles[:, 1].min(), -1.0)

    def test_problems_are_input_errors(self):
        builder = sprung.NetworkBuilder()
        a = builder.add_particle([0, 0, 0], -1.0)
        builder.add_spring(a, a, 1.0, -1.0)
        with self.assertRaises(sprung.InputError) as caught:
            builder.build()
        self.assertGreaterEqual(len(caught.exception.problems), 2)
        with self.assertRaises(sprung.InputError):
            builder.add_particle([0, 0], 1.0)
        with self.assertRaises(sprung.InputError):
            builder.add_spring(0, 1, 1.0, 1.0, kind="glue")
        with self.assertRaises(sprung.InputError):
            sprung.make_rope([[0, 0, 0]], mass=1.0, structural=1.0)

    def test_a_step_that_is_too_large_is_refused(self):
        builder = sprung.NetworkBuilder()
        a, b = builder.add_particle([0, 0, 0], 1.0), builder.add_particle([1, 0, 0], 1.0)
        builder.add_spring(a, b, 1e6, 1.0)
        with self.assertRaises(sprung.InputError) as caught:
            sprung.Simulator(builder.build(), step=0.1)
        self.assertEqual(caught.exception.problems[0].key, "step")


if __name__ == "__main__":
    unittest.main()
