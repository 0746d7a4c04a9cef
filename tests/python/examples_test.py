"""Runs the examples, which check themselves."""
import os
import subprocess
import sys
import tempfile
import unittest

import numpy

from common import SOURCE


def run(name, *arguments):
    path = os.path.join(SOURCE, "examples", "python", name + ".py")
    return subprocess.run([sys.executable, path, *arguments], check=True, capture_output=True, text=True).stdout


class Examples(unittest.TestCase):
    def test_hello(self):
        words = run("hello").replace("[", " ").replace("]", " ").split()
        x, y, z = map(float, words[-3:])
        # As the program of the library in fifteen lines: it swings as a pendulum that is about as long as the spring at rest.
        self.assertLess(abs(numpy.hypot(x, y) - 1.0), 0.25)
        self.assertEqual(z, 0.0)

    def test_fit_stiffness(self):
        self.assertIn("of 137.0 N/m", run("fit_stiffness"))

    def test_drapes(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "drapes.npz")
            run("drapes", path)
            data = numpy.load(path)
            self.assertEqual(data["positions"].shape, (100, 196, 3))
            self.assertEqual(data["faces"].shape, (338, 3))
            # Each cloth lies on its ball: its highest point is just above the top, unless it slid off.
            heights = data["positions"][:, :, 1].max(axis=1) - data["radius"]
            self.assertGreater((heights > 0).sum(), 90)
            self.assertEqual(len({positions.tobytes() for positions in data["positions"]}), 100)

    def test_lift_cloth(self):
        self.assertIn("lifted", run("lift_cloth"))


if __name__ == "__main__":
    unittest.main()
