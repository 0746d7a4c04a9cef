"""Laws of simulators in files."""
import os
import tempfile
import unittest

import numpy

import sprung
from common import cloth, example, rope, simulator


class Saved(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
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

    def test_restore_repeats_springs_that_were_set_after_others_broke(self):
        one = simulator(example("torn_cloth"))
        body = next(iter(one.bodies.values()))
        count = len(body.springs)
        while len(body.springs) == count:
            one.step(20)
        body.set_springs(stiffness=0.9 * body.springs.stiffness)
        one.save(self.path)
        twin = sprung.restore(self.path)
        numpy.testing.assert_array_equal(next(iter(twin.bodies.values())).springs.stiffness, body.springs.stiffness)
        for each in (one, twin):
            each.step(20)
        self.assertEqual(twin.state(), one.state())

    def test_added_forces_are_given_again(self):
        def force(x, v, t):
            return -0.1 * v
        one = simulator(rope())
        one.add_force(force)
        one.step(10)
        one.save(self.path)
        with self.assertRaises(sprung.InputError) as caught:
            sprung.restore(self.path)
        self.assertIn("restore(path, forces=[...])", caught.exception.problems[0].remedy)
        twin = sprung.restore(self.path, forces=[force])
        for each in (one, twin):
            each.step(30)
        self.assertEqual(twin.state(), one.state())

    def test_a_force_acts_on_its_body_again(self):
        scene = rope()
        scene["bodies"]["other"] = {**scene["bodies"]["rope"], "place": {"position": [0, 5, 0]}}
        one = simulator(scene)

        def lift(x, v, t):
            return numpy.full((8, 3), 0.5)
        one.add_force(lift, body="other")
        one.step(10)
        one.save(self.path)
        twin = sprung.restore(self.path, forces=[lift])
        for each in (one, twin):
            each.step(30)
        self.assertEqual(twin.state(), one.state())

    def sheet(self, height):
        """Of a mesh beside the saved file, by a relative path."""
        with open(os.path.join(self.folder, "sheet.obj"), "w") as file:
            file.write(f"v 0 0 0\nv 1 0 0\nv 0 {height} 0\nv 1 {height} 0\nf 1 2 4 3\n")
        return {"duration": 1, "frame_rate": 50, "step": 0.001, "bodies": {"sheet": {
            "shape": {"type": "mesh", "file": "sheet.obj"}, "mass": 1, "springs": {"structural": {"stiffness": 10}}}}}

    def test_meshes_are_found_from_another_folder(self):
        scene, here = self.sheet(1), os.getcwd()
        os.chdir(self.folder)
        try:
            one = simulator(scene)
        finally:
            os.chdir(here)
        one.step(20)
        one.save(self.path)
        twin = sprung.restore(self.path)
        for each in (one, twin):
            each.step(20)
        self.assertEqual(twin.state(), one.state())
        twin.save(self.path)  # again, as often as one likes
        self.assertEqual(sprung.restore(self.path).state(), one.state())

    def test_a_mesh_that_is_gone_is_named_and_may_be_elsewhere(self):
        one = simulator(self.sheet(1), mesh_paths=[self.folder])
        one.save(self.path)
        elsewhere = os.path.join(self.folder, "elsewhere")
        os.mkdir(elsewhere)
        os.rename(os.path.join(self.folder, "sheet.obj"), os.path.join(elsewhere, "sheet.obj"))
        with self.assertRaises(sprung.InputError) as caught:
            sprung.restore(self.path)
        self.assertEqual(caught.exception.problems[0].key, "bodies.sheet.shape.file")
        self.assertIn("mesh_paths", caught.exception.problems[0].remedy)
        self.assertEqual(sprung.restore(self.path, mesh_paths=[elsewhere]).state(), one.state())

    def test_a_mesh_that_changed_is_named(self):
        one = simulator(self.sheet(1), mesh_paths=[self.folder])
        one.save(self.path)
        self.sheet(2)
        with self.assertRaises(sprung.InputError) as caught:
            sprung.restore(self.path)
        problem = caught.exception.problems[0]
        self.assertEqual(problem.key, 'body "sheet"')
        self.assertIn("another one than when the simulator was saved", problem.rule)

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
