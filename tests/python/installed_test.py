"""The module that `cmake --install` installed."""
import os
import tempfile
import unittest

import sprung


class Installed(unittest.TestCase):
    def test_is_whole(self):
        folder = os.path.dirname(sprung.__file__)
        self.assertTrue(os.path.realpath(folder).startswith(os.path.realpath(os.environ["SPRUNG_INSTALLED"])), folder)
        for name in ("__init__.pyi", "py.typed"):
            self.assertTrue(os.path.isfile(os.path.join(folder, name)) and not os.path.islink(os.path.join(folder, name)), name)
        one = sprung.load(os.path.join(os.environ["SPRUNG_SOURCE_DIR"], "examples", "hanging_cloth.json")).simulator()
        one.step()
        self.assertGreater(one.time, 0.0)

    def test_finds_the_program_beside_it(self):
        scene = os.path.join(os.environ["SPRUNG_SOURCE_DIR"], "examples", "two_masses.json")
        with tempfile.TemporaryDirectory() as folder:
            table = sprung.sweep(scene, os.path.join(folder, "swept"), vary={"bodies.masses.particle_mass": [1]}, frames=2)
        self.assertEqual(table["status"].tolist(), ["done"])


if __name__ == "__main__":
    unittest.main()
