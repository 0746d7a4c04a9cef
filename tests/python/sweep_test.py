"""Laws of sweeps from Python."""
import json
import os
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

import numpy

import sprung
from common import rope

STIFFNESS = "bodies.rope.springs.structural.stiffness"


def hanging(**more):
    """The scene of rope(), held at one end, for 0.1 s."""
    scene = rope(**{"duration": 0.1, **more})
    scene["bodies"]["rope"]["pins"] = [{"indices": [0]}]
    return scene


class Sweep(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.out = Path(folder.name) / "swept"

    def statuses(self):
        return [run["status"] for run in json.loads((self.out / "manifest.json").read_text())["runs"]]

    def test_returns_a_column_for_each_key_and_result(self):
        table = sprung.sweep(hanging(), self.out, vary={"bodies.rope.mass": [0.1, 0.2], "gravity": [[0, -9.81, 0], [0, -1.62, 0]]},
                             overrides={STIFFNESS: numpy.float64(50)}, jobs=2)
        numpy.testing.assert_array_equal(table["number"], [1, 2, 3, 4])
        numpy.testing.assert_array_equal(table["status"], ["done"] * 4)
        numpy.testing.assert_array_equal(table["bodies.rope.mass"], [0.1, 0.1, 0.2, 0.2])
        self.assertEqual(json.loads(table["gravity"][1]), [0, -1.62, 0])
        self.assertEqual({len(column) for column in table.values()}, {4}, "pandas wants equal lengths")
        self.assertEqual({column.ndim for column in table.values()}, {1})
        self.assertEqual((table["exit_code"].dtype, table["largest_stretch"].dtype), (numpy.int64, numpy.float64))
        self.assertTrue(numpy.isnan(table["min_distance"]).all(), "there is no obstacle")
        self.assertGreater(table["largest_stretch"][0], table["largest_stretch"][1], "the moon pulls less")

    def test_a_file_and_its_dict_give_the_same_results(self):
        file = self.out.with_suffix(".json")
        file.write_text(json.dumps(hanging()))
        options = {"sample": {"bodies.rope.mass": "uniform(0.1, 0.2)"}, "count": 2, "seed": 7, "frames": 3}
        of_file = sprung.sweep(file, self.out.with_suffix(".file"), **options)
        of_dict = sprung.sweep(hanging(), self.out, **options)
        numpy.testing.assert_array_equal(of_file["bodies.rope.mass"], of_dict["bodies.rope.mass"])
        numpy.testing.assert_array_equal(of_file["kinetic_energy"], of_dict["kinetic_energy"])
        numpy.testing.assert_array_equal(of_dict["frame"], [3, 3])

    def test_what_is_done_is_not_done_again_and_other_scenes_are_refused(self):
        first = sprung.sweep(hanging(), self.out, vary={"bodies.rope.mass": [0.1]})
        again = sprung.sweep(hanging(), self.out, vary={"bodies.rope.mass": [0.1]})
        numpy.testing.assert_array_equal(first["seconds"], again["seconds"])
        with self.assertRaises(sprung.InputError) as caught:
            sprung.sweep(hanging(frame_rate=25), self.out, vary={"bodies.rope.mass": [0.1]})
        self.assertIn("scene.frame_rate = 25: the sweep in the folder has 50", str(caught.exception))
        self.assertEqual(json.loads((self.out / "scene.json").read_text()), hanging())

    def test_failed_runs_are_warned_of(self):
        with self.assertWarns(sprung.SprungWarning) as caught:
            table = sprung.sweep(hanging(), self.out, vary={STIFFNESS: [100, 1e9]})
        self.assertEqual(caught.filename, __file__)
        self.assertIn("run 0002: ", str(caught.warning))
        self.assertIn("beyond the largest stable step", str(caught.warning))
        numpy.testing.assert_array_equal(table["status"], ["done", "failed"])
        numpy.testing.assert_array_equal(table["exit_code"], [0, 3])
        self.assertEqual(self.statuses(), ["done", "failed"])

    def test_ctrl_c_ends_the_runs_and_the_same_call_goes_on(self):
        slow = hanging(duration=40)  # 40,000 steps
        program = ("import json, sys, sprung\n"
                   "sprung.sweep(json.loads(sys.argv[1]), sys.argv[2], vary={'bodies.rope.mass': [0.1, 0.2]})")
        words = [sys.executable, "-c", program, json.dumps(slow), str(self.out)]
        process = subprocess.Popen(words, stderr=subprocess.PIPE, text=True)
        begun = self.out / "runs" / "0001" / "checkpoint.bin"
        while not begun.exists() and process.poll() is None:
            time.sleep(0.01)
        process.send_signal(signal.SIGINT)
        _, messages = process.communicate()
        self.assertIn("KeyboardInterrupt", messages)
        self.assertEqual(self.statuses(), ["pending", "pending"])
        table = sprung.sweep(slow, self.out, vary={"bodies.rope.mass": [0.1, 0.2]})
        numpy.testing.assert_array_equal(table["frame"], [2001, 2001])

    def test_bad_input_is_told_and_nothing_is_written(self):
        with self.assertRaises(sprung.InputError) as caught:
            sprung.sweep(hanging(), self.out, vary={"bodies.rope.mas": [1], "bodies.rope.mass": [-1]})
        self.assertGreaterEqual(len(caught.exception.problems), 2)
        self.assertIn('did you mean "mass"?', str(caught.exception))
        for options in ({"vary": {"step": []}}, {"vary": {"step": "auto"}}, {"vary": {"step": [float("nan")]}},
                        {"vary": {"step": [0.001]}, "jobs": 0}, {"sample": {"step": "uniform(1,0)"}, "count": 3}):
            with self.assertRaises(sprung.InputError, msg=options):
                sprung.sweep(hanging(), self.out, **options)
        with self.assertRaises(sprung.InputError):
            sprung.sweep_results(self.out)
        self.assertFalse(self.out.exists())
        with self.assertRaises(sprung.FileError):
            sprung.sweep(os.path.join(self.out, "missing.json"), self.out, vary={"step": [0.001]})


if __name__ == "__main__":
    unittest.main()
