"""Laws of errors: one clear error, and nothing half done."""
import pickle
import unittest

import numpy

import sprung
from common import cloth, rope, simulator


class InputErrors(unittest.TestCase):
    def test_a_wrong_key_is_named_with_the_nearest(self):
        scene = cloth()
        scene["bodies"]["cloth"]["mas"] = scene["bodies"]["cloth"].pop("mass")
        scene["bodies"]["cloth"]["thickness"] = -1
        with self.assertRaises(sprung.InputError) as caught:
            sprung.load(scene)
        problems = caught.exception.problems
        self.assertGreaterEqual(len(problems), 2)
        by_key = {problem.key: problem for problem in problems}
        self.assertIn("mass", by_key["bodies.cloth.mas"].remedy)
        self.assertEqual(by_key["bodies.cloth.thickness"].value, "-1")
        self.assertEqual({problem.file for problem in problems}, {"<dict>"})
        self.assertEqual(str(caught.exception).count("\n") + 1, len(problems))

    def test_is_a_value_error_and_survives_pickling(self):
        with self.assertRaises(ValueError) as caught:
            sprung.load({"duration": -1})
        twin = pickle.loads(pickle.dumps(caught.exception))
        self.assertEqual((str(twin), twin.problems), (str(caught.exception), caught.exception.problems))

    def test_of_what_json_cannot_hold(self):
        for wrong in (float("nan"), object(), {1, 2}):
            with self.assertRaises(sprung.InputError):
                sprung.load({**cloth(), "duration": wrong})
        with self.assertRaises(sprung.InputError):
            sprung.load(cloth(), overrides={"duration": numpy.inf})
        with self.assertRaises(sprung.InputError) as caught:
            sprung.load(cloth(), overrides={"bodies.cloth.colour": 1})
        self.assertEqual(caught.exception.problems[0].file, "<dict>, changed by overrides")

    def test_a_missing_file_is_a_file_error(self):
        with self.assertRaises(sprung.FileError) as caught:
            sprung.load("missing.json")
        self.assertIsInstance(caught.exception, OSError)
        self.assertIn("missing.json", str(caught.exception))

    def test_of_wrong_types(self):
        with self.assertRaisesRegex(TypeError, "overrides must be a dict"):
            sprung.load(cloth(), overrides=["step=0.001"])
        with self.assertRaises(sprung.InputError) as caught:
            sprung.Simulator(cloth())
        self.assertIn("sprung.load(scene).simulator()", caught.exception.problems[0].remedy)
        with self.assertRaisesRegex(TypeError, "__init__"):
            sprung.Simulator.__new__(sprung.Simulator).step()
        with self.assertRaisesRegex(TypeError, "save"):
            pickle.dumps(simulator(rope()))

    def test_of_negative_steps(self):
        with self.assertRaises(sprung.InputError):
            simulator(rope()).step(-1)

    def test_a_state_of_another_scene_is_refused(self):
        one = simulator(cloth(8))
        one.step(5)
        before = one.state()
        with self.assertRaises(sprung.InputError):
            one.restore(simulator(cloth(9)).state())
        self.assertEqual(one.state(), before)


class StepErrors(unittest.TestCase):
    def diverging(self):
        one = simulator(rope())
        one.add_force(lambda x, v, t: -1e6 * x * (t > 0.0095))  # far stiffer than the step allows
        return one

    def test_names_where_and_leaves_the_begin_of_the_step(self):
        one = self.diverging()
        view = one.bodies["rope"].particles
        with self.assertRaises(sprung.StepError) as caught:
            one.step(1000)
        error = caught.exception
        self.assertIsInstance(error, RuntimeError)
        self.assertGreaterEqual(error.step, 10)
        self.assertAlmostEqual(error.time, one.time, delta=2 * one.step_length)
        self.assertEqual(error.body, "rope")
        self.assertTrue(error.remedy and error.cause)
        self.assertTrue(error.particle is not None or error.spring is not None)
        self.assertTrue(numpy.isfinite(view).all())
        state = one.state()
        numpy.testing.assert_array_equal(view, state.positions)
        with self.assertRaises(sprung.StepError):
            one.step()
        self.assertEqual(one.state(), state)
        twin = pickle.loads(pickle.dumps(error))
        self.assertEqual((twin.step, twin.body, twin.remedy), (error.step, error.body, error.remedy))


if __name__ == "__main__":
    unittest.main()
