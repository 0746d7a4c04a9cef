"""Laws of simulators in files."""
import os
import tempfile
import unittest

import numpy

import sprung
from common import cloth, rope, simulator


class Saved(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = os.path.join(folder.name, "state.bin")

    def test_restore_continues_bit_by_bit(self):
        one = simulator(cloth(), overrides={"bodies.cloth.mass": 0.3})
        one.step(50)
        one.save(self.path)
        twin = sprung.restore(self.path)
        self.assertEqual(twin.state(), one.state())
        self.assertAlmostEqual(twin.bodies["cloth"].masses.sum(), 0.3, 12)
        for each in (one, twin):
            each.step(50)
        self.assertEqual(twin.state(), one.state())

    def test_restore_repeats_changes(self):
        one = simulator(cloth())
        one.step(10)
        one.gravity = [0, -5, 0]
        one.bodies["cloth"].set_springs(stiffness=numpy.linspace(10, 50, len(one.bodies["cloth"].springs)))
        one.pin("cloth", [30, 31], "finger")
        one.step(10)
        one.save(self.path)
        twin = sprung.restore(self.path)
        numpy.testing.assert_array_equal(twin.bodies["cloth"].springs.stiffness, one.bodies["cloth"].springs.stiffness)
        for each in (one, twin):
            each.pins["finger"].move_to(each.pins["finger"].position + [0, 0.01, 0])
            each.step(30)
        self.assertEqual(twin.state(), one.state())

    def test_added_forces_are_given_again(self):
        def force(x, v, t):
            return -0.1 * v
        one = simulator(rope())
        one.add_force(force)
        one.step(10)
        one.save(self.path)
        with self.assertRaises(sprung.InputError):
            sprung.restore(self.path)
        twin = sprung.restore(self.path, forces=[force])
        for each in (one, twin):
            each.step(30)
        self.assertEqual(twin.state(), one.state())

    def test_a_simulator_of_a_network_loads_its_state(self):
        def make():
            builder = sprung.NetworkBuilder()
            builder.add_body("rope", sprung.make_rope([[0, 0, 0], [1, 0, 0]], 6, mass=0.1, structural=(50, 0.1)))
            return sprung.Simulator(builder.build())
        one, twin = make(), make()
        one.step(20)
        one.save(self.path)
        twin.load(self.path)
        self.assertEqual(twin.state(), one.state())
        with self.assertRaises(sprung.InputError) as caught:
            sprung.restore(self.path)
        self.assertIn("load", caught.exception.problems[0].remedy)

    def test_what_is_no_such_file_is_refused(self):
        with self.assertRaises(sprung.FileError):
            sprung.restore(self.path)
        with open(self.path, "wb") as file:
            file.write(b"no checkpoint")
        with self.assertRaises(sprung.FileError):
            sprung.restore(self.path)
        one = simulator(rope())
        with self.assertRaises(sprung.FileError):
            one.load(self.path)
        with self.assertRaises(sprung.FileError):
            one.save(os.path.join(self.path, "below", "a file"))


if __name__ == "__main__":
    unittest.main()
