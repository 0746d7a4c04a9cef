"""Laws of scenes, frames and copies."""
import copy
import json
import os
import re
import unittest
import warnings
from pathlib import Path

import numpy

import sprung
from common import SOURCE, cloth, example, rope, simulator


class Scenes(unittest.TestCase):
    def test_a_file_and_its_dict_give_the_same_bits(self):
        path = Path(example("hanging_cloth"))
        from_file, from_dict = simulator(path), simulator(json.loads(path.read_text()))
        for each in (from_file, from_dict):
            each.step(20)
        self.assertEqual(from_file.state(), from_dict.state())

    def test_overrides_change_keys(self):
        scene = sprung.load(cloth(), overrides={"bodies.cloth.shape.resolution": [5, 7], "gravity": numpy.array([0, -1.5, 0])})
        self.assertEqual(len(scene.simulator().bodies["cloth"]), 35)
        numpy.testing.assert_array_equal(scene.simulator().gravity, [0, -1.5, 0])
        self.assertEqual(scene.dict()["gravity"], [0, -1.5, 0])

    def test_simulators_of_a_scene_are_independent(self):
        scene = sprung.load(cloth())
        first, second = scene.simulator(), scene.simulator()
        first.step(10)
        self.assertEqual(second.time, 0.0)
        second.step(10)
        self.assertEqual(first.state(), second.state())

    def test_frames_have_the_steps_of_the_scene(self):
        scene = sprung.load(cloth())
        self.assertEqual((scene.frames, scene.frame_rate), (31, 30.0))
        by_frames, by_steps = scene.simulator(), scene.simulator()
        row = by_frames.frame()
        by_steps.step(by_steps.steps_per_frame)
        numpy.testing.assert_array_equal(by_frames.bodies["cloth"].particles, by_steps.bodies["cloth"].particles)
        self.assertAlmostEqual(by_frames.time, 1 / 30, 12)
        self.assertEqual(by_frames.frame_number, 2)
        self.assertEqual(row.shape, (1,))
        self.assertEqual(row["frame"][0], 2)
        self.assertGreater(row["kinetic_energy"][0], 0.0)
        self.assertEqual(row["kinetic_energy"][0], by_frames.diagnostics()["kinetic_energy"][0])
        self.assertEqual(row["kinetic_energy"][0], by_frames.kinetic_energy)

    def test_warnings_are_python_warnings_at_the_call(self):
        scene = rope()
        scene["bodies"]["rope"]["friction"] = 0.3  # of one side only
        scene["obstacles"] = {"ball": {"shape": {"type": "sphere", "radius": 0.2}, "place": {"position": [0, -0.5, 0]}}}
        with self.assertWarns(sprung.SprungWarning) as caught:
            loaded = sprung.load(scene)
        self.assertEqual(caught.filename, __file__)
        self.assertIn(str(caught.warning), loaded.warnings)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            with self.assertRaises(sprung.SprungWarning):
                sprung.load(scene)


class WarningsOfSteps(unittest.TestCase):
    """Scenes of tests/app/remedies.json, of which `sprung run` warns."""

    def caught(self, scene, call):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            loaded = sprung.load(scene)
            caught.clear()
            call(loaded)
        for each in caught:
            self.assertIs(each.category, sprung.SprungWarning)
            self.assertEqual(each.filename, __file__)
        return [str(each.message) for each in caught]

    def row(self, name):
        with open(os.path.join(SOURCE, "tests", "app", "remedies.json"), encoding="utf-8") as file:
            table = json.load(file)
        row = next(row for row in table["rows"] if row["name"] == name)

        def merge(base, more):
            for key, value in more.items():
                if isinstance(value, dict) and isinstance(base.get(key), dict):
                    merge(base[key], value)
                elif value is None:
                    base.pop(key)
                else:
                    base[key] = value
            return base
        return merge(table["bases"][row.get("base", "rope")], row["scene"]), row["says"]

    def test_come_once_whether_frames_or_steps(self):
        def by_frames(scene):
            one = scene.simulator()
            for _ in range(scene.frames - 1):
                one.frame()

        def by_steps(scene):
            one = scene.simulator()
            one.step((scene.frames - 1) * one.steps_per_frame)

        def by_batch(scene):
            batch = sprung.Batch([scene.simulator() for _ in range(3)])
            for _ in range(scene.frames - 1):
                batch.frame()

        def by_copies(scene):
            one = scene.simulator()
            state = one.state()
            for each in (one, one.copy(), scene.simulator()):
                each.step((scene.frames - 1) * one.steps_per_frame)
            one.restore(state)
            one.step((scene.frames - 1) * one.steps_per_frame)
        for name in ("Infeasible", "InvertedCells", "LimitMissed", "ThicknessOfZero"):
            scene, says = self.row(name)
            for call in (by_frames, by_steps, by_batch, by_copies):
                texts = self.caught(scene, call)
                self.assertEqual(len([text for text in texts if re.search(says, text)]), 1, f"{name}, {call.__name__}: {texts}")

    def test_as_errors_end_the_call_after_the_steps(self):
        scene, _ = self.row("LimitMissed")
        one = sprung.load(scene).simulator()
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            with self.assertRaises(sprung.SprungWarning):
                one.step(3)
        self.assertAlmostEqual(one.time, 3 * one.step_length, 12)
        one.step(3)


class Copies(unittest.TestCase):
    def test_a_copy_continues_bit_by_bit(self):
        original = simulator(example("cloth_on_bunny"), overrides={"bodies.cloth.shape.resolution": [24, 24]},
                             mesh_paths=[os.environ["SPRUNG_TEST_MESHES"]])
        original.step(60)
        twin = original.copy()
        for each in (original, twin):
            each.step(60)
        self.assertEqual(original.state(), twin.state())

    def test_deep_copies_keep_parts_and_simulators_together(self):
        one = simulator(cloth())
        one.step(5)
        mine = {"simulator": one, "parts": [one.bodies["cloth"], one.pins["hand"], one.obstacles["ball"]], "state": one.state()}
        theirs = copy.deepcopy(mine)
        body, pin, ball = theirs["parts"]
        body.velocities[:] = 0.1
        pin.move_to(pin.position + [0, 0.01, 0])
        theirs["simulator"].step()
        self.assertAlmostEqual(pin.position[1], 0.01, 12)
        self.assertEqual(one.state(), mine["state"])
        self.assertEqual(theirs["state"], mine["state"])
        self.assertEqual(ball.name, "ball")

    def test_a_state_is_restored_bit_by_bit(self):
        one = simulator(cloth())
        one.step(40)
        state = one.state()
        view = one.bodies["cloth"].particles
        one.step(40)
        end = one.state()
        one.restore(state)
        numpy.testing.assert_array_equal(view, state.positions)
        self.assertEqual(one.state(), state)
        one.step(40)
        self.assertEqual(one.state(), end)
        self.assertNotEqual(state, end)
        self.assertEqual(len({state, end, one.state()}), 2)


if __name__ == "__main__":
    unittest.main()
