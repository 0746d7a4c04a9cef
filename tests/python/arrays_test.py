"""Laws of the arrays of a simulator."""
import gc
import os
import tempfile
import unittest

import numpy

import sprung
from common import SOURCE, cloth, example, rope, simulator


class Views(unittest.TestCase):
    def test_are_writable_float64_without_copies(self):
        body = simulator(cloth(12)).bodies["cloth"]
        for name in ("particles", "velocities"):
            view = getattr(body, name)
            self.assertEqual((view.shape, view.dtype, view.flags.writeable), ((144, 3), numpy.float64, True))
            self.assertTrue(view.flags.c_contiguous)
            self.assertTrue(numpy.shares_memory(view, getattr(body, name)))

    def test_show_each_step(self):
        one = simulator(cloth())
        view = one.bodies["cloth"].particles
        for _ in range(5):
            one.step(3)
            numpy.testing.assert_array_equal(view, one.state().positions)

    def test_keep_their_simulator_alive(self):
        view = simulator(cloth()).bodies["cloth"].particles
        before = view.copy()
        gc.collect()
        filler = [numpy.ones((144, 3)) for _ in range(100)]
        numpy.testing.assert_array_equal(view, before)
        del filler

    def test_change_no_bits_of_the_simulation(self):
        with_view, without = simulator(cloth()), simulator(cloth())
        view = with_view.bodies["cloth"].particles
        with_view.step(50)
        without.step(50)
        self.assertEqual(with_view.state(), without.state())
        self.assertEqual(len(view), 144)

    def test_last_through_tears(self):
        one = simulator(example("torn_cloth"))
        name = next(iter(one.bodies))
        view, count = one.bodies[name].particles, len(one.bodies[name].springs)
        for _ in range(one.steps_per_frame * 60):
            one.step(20)
            if len(one.bodies[name].springs) < count:
                break
        self.assertLess(len(one.bodies[name].springs), count)
        numpy.testing.assert_array_equal(view, one.state().positions[one.bodies[name].slice])

    def test_last_through_sleep(self):
        scene = cloth(6, obstacles={"floor": {"shape": {"type": "half_space"}, "friction": 0.5}})
        scene["bodies"]["cloth"].pop("pins")
        scene["bodies"]["cloth"]["friction"] = 0.5
        scene["bodies"]["cloth"]["place"]["position"] = [0, 0.01, 0]
        one = simulator(scene)
        view = one.bodies["cloth"].particles
        for _ in range(90):
            one.frame()
        self.assertEqual(one.kinetic_energy, 0.0)  # all sleep
        one.bodies["cloth"].velocities[:, 1] = 1.0  # and wake
        one.step(20)
        numpy.testing.assert_array_equal(view, one.state().positions)
        self.assertGreater(one.kinetic_energy, 0.0)

    def test_last_through_new_models_and_forces(self):
        one = simulator(cloth())
        view = one.bodies["cloth"].particles
        one.bodies["cloth"].set_springs(stiffness=50.0, kind="structural")
        one.add_force(lambda x, v, t: -0.01 * v)
        one.pin("cloth", 5, "finger")
        one.step(10)
        numpy.testing.assert_array_equal(view, one.state().positions)


class Writing(unittest.TestCase):
    def test_moves_particles(self):
        one, twin = simulator(rope()), simulator(rope())
        one.step(10)
        twin.step(10)
        one.bodies["rope"].particles[:] += [1.0, 2.0, 3.0]
        one.step(10)
        twin.step(10)
        numpy.testing.assert_allclose(one.bodies["rope"].particles, twin.bodies["rope"].particles + [1, 2, 3], atol=1e-12)

    def test_in_place_operators_and_assignment_write(self):
        body = simulator(rope()).bodies["rope"]
        body.particles += 1.0
        body.velocities = numpy.ones((8, 3))
        numpy.testing.assert_array_equal(body.velocities, 1.0)
        numpy.testing.assert_array_equal(body.particles[0], 1.0)

    def test_gives_velocities(self):
        one = simulator(rope(), overrides={"gravity": [0, 0, 0]})
        one.bodies["rope"].velocities[:] = [1, 0, 2]
        start = one.bodies["rope"].particles.copy()
        one.step(100)
        numpy.testing.assert_allclose(one.bodies["rope"].particles - start, numpy.tile([0.1, 0, 0.2], (8, 1)), atol=1e-12)

    def refused(self, one, write, *words):
        one.step(20)
        body = next(iter(one.bodies.values()))
        state, view, velocities = one.state(), body.particles, body.velocities
        write(view, velocities)
        with self.assertRaises(sprung.InputError) as caught:
            one.step()
        for word in words:
            self.assertIn(word, str(caught.exception))
        self.assertTrue(caught.exception.problems[0].key.startswith("bodies."))
        self.assertTrue(caught.exception.problems[0].remedy)
        self.assertEqual(one.state(), state)
        numpy.testing.assert_array_equal(view, state.positions)
        numpy.testing.assert_array_equal(velocities, state.velocities)
        twin = one.copy()
        one.step(5)
        twin.step(5)
        self.assertEqual(one.state(), twin.state())

    def test_nan_is_refused(self):
        def write(x, _):
            x[50, 1] = numpy.nan
        self.refused(simulator(cloth()), write, "bodies.cloth.particles[50]", "must be finite")

    def test_infinite_velocities_are_refused(self):
        def write(_, v):
            v[50, 1] = numpy.inf
        self.refused(simulator(cloth()), write, "bodies.cloth.velocities[50]", "must be finite")

    def test_pinned_particles_stay(self):
        def write(x, _):
            x[:, 0] += 0.25
        self.refused(simulator(cloth()), write, "is pinned")

    def test_nothing_passes_through_an_obstacle(self):
        def write(x, _):
            x[:, 1] -= 1.5
        wall = {"wall": {"shape": {"type": "box", "size": [9, 0.01, 9]}, "place": {"position": [0, -0.5, 0]}}}
        self.refused(simulator(rope(obstacles=wall)), write, "\"wall\"", "pass through")

    def test_nothing_is_put_into_an_obstacle(self):
        def write(x, _):
            x[70] = [0, -0.45, 0]
        self.refused(simulator(cloth()), write, "\"ball\"")

    def test_a_copy_has_what_was_written(self):
        one = simulator(rope())
        one.bodies["rope"].velocities[:] = [0, 5, 0]
        numpy.testing.assert_array_equal(one.copy().bodies["rope"].velocities, numpy.tile([0, 5.0, 0], (8, 1)))

    def test_wrong_shapes_are_refused(self):
        body = simulator(rope()).bodies["rope"]
        for value in (numpy.zeros((7, 3)), numpy.zeros(3), "text", numpy.zeros((8, 3), complex)):
            with self.assertRaises(sprung.InputError):
                body.particles = value


class Properties(unittest.TestCase):
    def test_springs_are_those_of_the_scene(self):
        springs = simulator(rope(5)).bodies["rope"].springs
        numpy.testing.assert_array_equal(springs.indices, [[0, 1], [1, 2], [2, 3], [3, 4]])
        numpy.testing.assert_allclose(springs.rest_lengths, 0.25)
        numpy.testing.assert_array_equal(springs.stiffness, 100.0)
        numpy.testing.assert_array_equal(springs.damping, 0.05)
        self.assertEqual(list(springs.kinds), ["structural"] * 4)
        for array in (springs.indices, springs.rest_lengths, springs.stiffness, springs.damping):
            self.assertFalse(array.flags.writeable)

    def test_stretch_and_tension_follow_hookes_law(self):
        one = simulator(cloth())
        one.step(100)
        body = one.bodies["cloth"]
        x, v, s = body.particles, body.velocities, body.springs
        i, j = s.indices.T
        along = x[j] - x[i]
        length = numpy.linalg.norm(along, axis=1)
        rate = numpy.einsum("ij,ij->i", along / length[:, None], v[j] - v[i])
        numpy.testing.assert_allclose(body.stretch, length / s.rest_lengths - 1, atol=1e-14)
        numpy.testing.assert_allclose(body.tension, s.stiffness * (length - s.rest_lengths) + s.damping * rate, atol=1e-12)

    def test_faces_are_those_of_frames(self):
        body = simulator(cloth(4)).bodies["cloth"]
        self.assertEqual(body.faces.shape, (18, 3))
        a, b, c = (body.vertices[body.faces[:, k]] for k in range(3))
        self.assertAlmostEqual(numpy.linalg.norm(numpy.cross(b - a, c - a), axis=1).sum() / 2, 1.0, 12)
        self.assertEqual(simulator(rope()).bodies["rope"].faces.shape, (0, 3))

    def test_masses_add_up(self):
        self.assertAlmostEqual(simulator(cloth()).bodies["cloth"].masses.sum(), 0.2, 12)

    def test_set_springs_gives_the_simulator_a_model_of_its_own(self):
        one = simulator(cloth())
        one.step(10)
        twin = one.copy()
        count = len(one.bodies["cloth"].springs)
        numbers = numpy.linspace(20.0, 100.0, count)
        one.bodies["cloth"].set_springs(stiffness=numbers)
        numpy.testing.assert_array_equal(one.bodies["cloth"].springs.stiffness, numbers)
        self.assertEqual(twin.bodies["cloth"].springs.stiffness.max(), 100.0)
        one.bodies["cloth"].set_springs(damping=0.01, kind="shear")
        springs = one.bodies["cloth"].springs
        numpy.testing.assert_array_equal(springs.damping[springs.kinds == "shear"], 0.01)
        self.assertEqual(springs.damping[springs.kinds == "structural"].max(), 0.02)
        one.step(10)
        for wrong in (dict(stiffness=-1.0), dict(stiffness=numbers[1:]), dict(kind="glue"), dict(stiffness=1e12)):
            with self.assertRaises(sprung.InputError):
                one.bodies["cloth"].set_springs(**wrong)
        numpy.testing.assert_array_equal(one.bodies["cloth"].springs.stiffness, numbers)


class Vertices(unittest.TestCase):
    def test_of_a_lattice_are_those_of_its_mesh(self):
        one = simulator({"duration": 1, "bodies": {"ring": {
            "shape": {"type": "lattice", "file": os.path.join(SOURCE, "meshes", "torus.ply"), "cells": 8}, "mass": 1,
            "springs": {"structural": {"stiffness": 50, "damping": 0.1}, "shear": {"stiffness": 20}}}}})
        one.step(10)
        body = one.bodies["ring"]
        self.assertGreater(len(body), len(body.vertices))
        self.assertEqual(body.faces.max() + 1, len(body.vertices))
        numpy.testing.assert_array_equal(body.vertices, body.particles[:len(body.vertices)])

    def test_of_a_welded_mesh_are_those_of_its_file(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "two.obj")
            with open(path, "w") as file:  # two triangles that share a side, as five vertices and one twice
                file.write("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 4 5 6\n")
            one = simulator({"duration": 1, "frame_rate": 50, "step": 0.001, "bodies": {"sheet": {
                "shape": {"type": "mesh", "file": path, "weld": 1e-6}, "mass": 1,
                "springs": {"structural": {"stiffness": 10}}}}})
            one.step(10)
            body = one.bodies["sheet"]
            self.assertEqual((len(body), body.vertices.shape), (4, (6, 3)))
            numpy.testing.assert_array_equal(body.vertices[1], body.vertices[3])
            numpy.testing.assert_array_equal(body.vertices, body.particles[body.vertex_particles])
            self.assertFalse(body.vertices.flags.writeable)


if __name__ == "__main__":
    unittest.main()
