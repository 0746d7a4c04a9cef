"""Laws of networks that a program builds."""
import os
import unittest

import numpy

import sprung
from common import SOURCE


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

    def test_a_pin_follows_its_keyframes(self):
        builder = sprung.NetworkBuilder()
        a, b = builder.add_particle([0, 0, 0], 1.0), builder.add_particle([1, 0, 0], 1.0)
        builder.add_spring(a, b, 100.0, 1.0, 1.0)
        builder.pin([a], "hand", keyframes=[(0, [0, 0, 0]), (0.1, [0, 0.2, 0])], until=0.2)
        builder.pin(b, keyframes=[(0, (0, 0, 0)), (0.1, (0, 0, 0), (0, 0, 90))], origin=[0.5, 0, 0])
        one = sprung.Simulator(builder.build())
        x = one.bodies["network"].particles
        one.step(50)
        numpy.testing.assert_allclose(x[0], [0, 0.1, 0], atol=1e-12)
        one.step(50)
        numpy.testing.assert_allclose(x, [[0, 0.2, 0], [0.5, 0.5, 0]], atol=1e-12)
        one.step(150)
        self.assertLess(x[0, 1], 0.19)  # it let go
        numpy.testing.assert_allclose(x[1], [0.5, 0.5, 0], atol=1e-12)

    def test_a_pin_follows_an_obstacle(self):
        builder = sprung.NetworkBuilder()
        a, b = builder.add_particle([0, 1, 0], 1.0), builder.add_particle([0, 2, 0], 1.0)
        builder.add_spring(a, b, 100.0, 1.0)
        builder.pin(a, obstacle=0)
        one = sprung.Simulator(builder.build(), obstacles=[sprung.make_sphere("robot", 0.2)])
        pose = one.obstacles["robot"].pose.copy()
        pose[:3, 3] = [0.01, 0, 0]
        one.obstacles["robot"].pose = pose
        one.step()
        numpy.testing.assert_allclose(one.bodies["network"].particles[0], [0.01, 1, 0], atol=1e-12)
        with self.assertRaises(sprung.InputError):
            sprung.Simulator(builder.build())  # without obstacles

    def test_attachments_join_bodies_and_obstacles(self):
        def rope(builder, name, height):
            shape = sprung.make_rope([[0, height, 0], [1, height, 0]], 5, mass=0.1, structural=(200.0, 0.1))
            return builder.add_body(name, shape)
        builder = sprung.NetworkBuilder()
        upper, lower = rope(builder, "upper", 0), rope(builder, "lower", -0.5)
        builder.add_attachment([upper, upper + 4], obstacle=0)  # rods
        builder.add_attachment(lower + numpy.array([0, 4]), particles=[upper, upper + 4], stiffness=500.0, damping=0.5, name="ties")
        one = sprung.Simulator(builder.build(), record_forces=True, integrator="symplectic_euler",
                               obstacles=[sprung.make_box("ceiling", [4, 1, 4], position=[0, 1.5, 0])])
        one.step(400)
        x = one.bodies["upper"].particles
        rods = x[[0, 4]] - [[0, 1, 0], [1, 1, 0]]  # from the nearest points of the ceiling
        numpy.testing.assert_allclose(numpy.linalg.norm(rods, axis=1), 1.0, atol=1e-6)
        gap = numpy.linalg.norm(one.bodies["lower"].particles[[0, 4]] - x[[0, 4]], axis=1)
        numpy.testing.assert_allclose(gap, 0.5, atol=0.05)
        self.assertIn("ties", one.forces()["name"])
        for wrong in (dict(), dict(particles=upper, body=0), dict(particles=99), dict(body=7), dict(obstacle=0, begin=-1.0)):
            broken = sprung.NetworkBuilder()
            rope(broken, "rope", 0)
            with self.assertRaises(sprung.InputError, msg=str(wrong)):
                broken.add_attachment(0, **wrong)
                broken.build()

    def test_bodies_and_obstacles_of_meshes(self):
        vertices = numpy.array([[0, 0, 0], [1, 0, 0], [1, 0, 1], [0, 0, 1]], float)
        quad = [[0, 3, 2, 1]]
        builder = sprung.NetworkBuilder()
        builder.add_body("sheet", sprung.make_mesh((vertices, quad), mass=1.0, structural=100.0, shear=50.0, position=[0, 0.3, 0]),
                         thickness=0.01)
        builder.add_body("tent", sprung.make_mesh((vertices, numpy.array([[0, 2, 1], [0, 3, 2]])), mass=1.0, structural=100.0,
                                                  position=[3, 0.3, 0]), thickness=0.01)
        ground = (vertices * 8 - [1, 0, 1], [[0, 2, 1], [0, 3, 2]])
        torus = sprung.make_mesh_obstacle("torus", os.path.join(SOURCE, "meshes", "torus.ply"), position=[20, 0, 0])
        one = sprung.Simulator(builder.build(), obstacles=[sprung.make_mesh_obstacle("floor", ground), torus])
        self.assertEqual(len(one.bodies["sheet"].springs), 6)  # four sides and two diagonals
        self.assertEqual(len(one.bodies["tent"].springs), 5)
        one.step(600)
        for body in one.bodies.values():
            numpy.testing.assert_allclose(body.particles[:, 1], 0.01, atol=1e-3)
        for wrong in ((vertices, [[0, 1, 9]]), (vertices, [[0, 1]]), (vertices, 3), (vertices[:, :2], quad), (vertices,), 7,
                      (vertices * numpy.nan, quad)):
            with self.assertRaises(sprung.InputError, msg=str(wrong)):
                sprung.make_mesh(wrong, mass=1.0, structural=1.0)
            with self.assertRaises(sprung.InputError, msg=str(wrong)):
                sprung.make_mesh_obstacle("floor", wrong)

    def test_springs_yield_break_and_go_slack(self):
        builder = sprung.NetworkBuilder()
        a, b, c = (builder.add_particle([k, 0, 0], 1.0) for k in (0, 1, 2))
        builder.add_spring(a, b, 100.0, 1.0, break_length=1.2)
        builder.add_spring(b, c, 100.0, 2.0, tension_only=True)
        builder.pin([a, c])
        one = sprung.Simulator(builder.build())
        numpy.testing.assert_array_equal(one.bodies["network"].tension, 0.0)  # it pushes not
        one.step(1000)
        self.assertEqual(len(one.bodies["network"].springs), 1)

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
